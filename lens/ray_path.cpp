#include "lens/ray_path.h"

#include <cmath>

namespace etendue {

std::optional<ExitRay> middleRay(const TracedLens& lens, const MonochromaticLens& atLine,
                                 SensorPoint sensor) {
    if (const std::optional<ExitRay> chief = atLine.trace(sensor, {{0.0, 0.0}})) return chief;
    constexpr int grid = 16;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    int passed = 0;
    for (int i = 0; i < grid; ++i)
        for (int j = 0; j < grid; ++j) {
            const AperturePoint aperture =
                lens.sampleAperture({(i + 0.5) / grid, (j + 0.5) / grid});
            if (!atLine.trace(sensor, aperture)) continue;
            sum += aperture.mm;
            ++passed;
        }
    if (passed == 0) return {};
    return atLine.trace(sensor, {sum / passed});
}

std::optional<Eigen::Vector3d> objectPoint(const TracedLens& lens, SensorPoint sensor,
                                           double focusDistanceMm) {
    constexpr double farAwayMm = 1e9, steepest = 0.5;  // cos 60°
    const std::optional<ExitRay> middle = middleRay(lens, MonochromaticLens(lens, dLineNm), sensor);
    if (!middle) return {};
    if (std::isinf(focusDistanceMm)) return middle->origin + farAwayMm * middle->direction;
    const double depth = focusDistanceMm + lens.sensorZMm();  // from the first vertex
    const double z = middle->direction.z();
    const double distance = z > steepest ? (depth - middle->origin.z()) / z : depth;
    return middle->origin + distance * middle->direction;
}

std::vector<AperturePoint> clearFan(const TracedLens& lens, const MonochromaticLens& atLine,
                                    const Eigen::Vector3d& targetMm, const Eigen::Vector2d& along,
                                    int count) {
    constexpr int steps = 48, halvings = 16;
    const double radius = lens.system().aperture.radiusMm();
    const auto at = [&](double share) { return AperturePoint{share * radius * along}; };
    const auto passes = [&](double share) {
        return atLine.connect(targetMm, at(share)).has_value();
    };
    // Halves the gap between a share that passes and one that does not.
    const auto edge = [&](double inside, double outside) {
        for (int i = 0; i < halvings; ++i) {
            const double middle = 0.5 * (inside + outside);
            (passes(middle) ? inside : outside) = middle;
        }
        return inside;
    };
    int first = 0, last = steps;
    const auto shareOf = [](int step) { return 2.0 * step / steps - 1.0; };
    while (first <= steps && !passes(shareOf(first))) ++first;
    if (first > steps) return {};
    while (!passes(shareOf(last))) --last;
    const double low = first == 0 ? -1.0 : edge(shareOf(first), shareOf(first - 1));
    const double high = last == steps ? 1.0 : edge(shareOf(last), shareOf(last + 1));
    std::vector<AperturePoint> fan;
    for (int i = 0; i < count; ++i)
        fan.push_back(
            at(count == 1 ? 0.5 * (low + high) : std::lerp(low, high, i / (count - 1.0))));
    return fan;
}

std::optional<RayPath> rayPath(const TracedLens& lens, const MonochromaticLens& atLine,
                               const Eigen::Vector3d& targetMm, AperturePoint aperture) {
    const std::optional<SensorPoint> sensor = atLine.connect(targetMm, aperture);
    if (!sensor) return {};
    const std::optional<Eigen::Vector2d> slope = atLine.slopeThrough(*sensor, aperture);
    if (!slope) return {};
    LensRay<double> ray =
        rayOf<double>({sensor->mm.x(), sensor->mm.y(), slope->x(), slope->y()}, lens.sensorZMm());
    RayPath path{{toEigen(ray.origin)}, {}};
    // Rims ignored: connect() has found that the ray passes them, and rounding must not end it.
    const Passage passage =
        carryToScene<TraceMode::geometry>(atLine.system(), 0, lens.system().surfaces.size(), ray,
                                          [&](std::size_t, const Vector3<double>& point) {
                                              path.pointsMm.push_back(toEigen(point));
                                          });
    if (passage.status != TraceStatus::passed) return {};
    path.direction = toEigen(ray.direction);
    return path;
}

}  // namespace etendue
