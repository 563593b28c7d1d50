#include "lens/field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {

namespace {

/// Mean throughput over the aperture.
double meanThroughput(const TracedLens& lens, const MonochromaticLens& atLine, SensorPoint sensor,
                      int grid) {
    double sum = 0.0;
    for (int i = 0; i < grid; ++i)
        for (int j = 0; j < grid; ++j) {
            const AperturePoint aperture =
                lens.sampleAperture({(i + 0.5) / grid, (j + 0.5) / grid});
            if (const auto ray = atLine.trace(sensor, aperture)) sum += ray->throughput;
        }
    return sum / (grid * grid);
}

/// Whether the mean is `least` at least, for which a bright sensor point takes few rays.
bool isBright(const TracedLens& lens, const MonochromaticLens& atLine, SensorPoint sensor, int grid,
              double least) {
    double missing = least * (grid * grid);
    for (int i = 0; i < grid; ++i)
        for (int j = 0; j < grid; ++j) {
            const AperturePoint aperture =
                lens.sampleAperture({(i + 0.5) / grid, (j + 0.5) / grid});
            if (const auto ray = atLine.trace(sensor, aperture)) missing -= ray->throughput;
            if (missing <= 0.0) return true;
        }
    return false;
}

double fullAngleDegrees(const MonochromaticLens& lens, const Eigen::Vector2d& edge) {
    const std::optional<ExitRay> ray = lens.chiefRay({edge});
    if (!ray) return std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector3d& d = ray->direction;
    return 2.0 * std::atan2(std::hypot(d.x(), d.y()), d.z()) * (180.0 / std::numbers::pi);
}

}  // namespace

double relativeIllumination(const TracedLens& lens, SensorPoint sensor, double wavelengthNm,
                            int grid) {
    const MonochromaticLens atLine(lens, wavelengthNm);
    const double onAxis = meanThroughput(lens, atLine, {{0.0, 0.0}}, grid);
    return onAxis > 0.0 ? meanThroughput(lens, atLine, sensor, grid) / onAxis : 0.0;
}

double imageHeightMm(const TracedLens& lens, const Eigen::Vector2d& along, double share) {
    constexpr int coarse = 12, halvings = 12, mostSteps = 3200;
    const MonochromaticLens atLine(lens, dLineNm);
    const double least = share * meanThroughput(lens, atLine, {{0.0, 0.0}}, coarse);
    if (!(least > 0.0)) return 0.0;
    const double step = std::abs(lens.focalLengthMm()) / 32.0;
    double low = 0.0;
    int steps = 0;
    // J falls as the height's fourth power.
    const auto walk = [&](int grid) {
        while (steps < mostSteps && isBright(lens, atLine, {(low + step) * along}, grid, least)) {
            low += step;
            ++steps;
        }
    };
    // A grid that has four points where such a share of the aperture is open would be slow all the
    // way; the coarse one stops too early where a share below one of its points is left.
    walk(coarse);
    const int fine = std::max(coarse, static_cast<int>(std::ceil(2.0 / std::sqrt(share))));
    walk(fine);
    double high = low + step;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (isBright(lens, atLine, {middle * along}, fine, least) ? low : high) = middle;
    }
    return low;
}

double imageCircleRadiusMm(const TracedLens& lens, double share) {
    return std::min(imageHeightMm(lens, Eigen::Vector2d::UnitX(), share),
                    imageHeightMm(lens, Eigen::Vector2d::UnitY(), share));
}

FieldOfView fieldOfView(const TracedLens& lens, double sensorWidthMm, double sensorHeightMm) {
    const MonochromaticLens atLine(lens, dLineNm);
    const double x = 0.5 * sensorWidthMm, y = 0.5 * sensorHeightMm;
    return {fullAngleDegrees(atLine, {x, 0.0}), fullAngleDegrees(atLine, {0.0, y}),
            fullAngleDegrees(atLine, {x, y})};
}

}  // namespace etendue
