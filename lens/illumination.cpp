#include "lens/illumination.h"

#include "lens/spot_diagram.h"

namespace etendue {

namespace {

struct Passing {
    double throughput = 0.0;  // mean over the aperture
    double share = 0.0;       // of the aperture
};

Passing passingLight(const MonochromaticLens& atLine, SensorPoint sensor,
                     std::span<const AperturePoint> apertures) {
    Passing passing;
    const double weight = 1.0 / static_cast<double>(apertures.size());
    for (const AperturePoint& aperture : apertures)
        if (const auto ray = atLine.trace(sensor, aperture)) {
            passing.throughput += weight * ray->throughput;
            passing.share += weight;
        }
    return passing;
}

}  // namespace

std::vector<Illumination> illuminationCurve(const TracedLens& lens, const Eigen::Vector2d& along,
                                            double highestMm, int count, int apertures) {
    const MonochromaticLens atLine(lens, dLineNm);
    // No rings and no rows that a rim could cut all at once.
    std::vector<AperturePoint> points = sunflower(lens.system().aperture.radiusMm(), apertures);
    std::erase_if(points, [&](const AperturePoint& point) {
        return !lens.system().aperture.contains(point.mm);
    });
    const Passing axis = passingLight(atLine, {{0.0, 0.0}}, points);
    std::vector<Illumination> curve;
    for (int i = 0; i < count; ++i) {
        const double height = highestMm * i / (count - 1);
        const SensorPoint sensor{height * along};
        const Passing passing = passingLight(atLine, sensor, points);
        Illumination at{height, passing.throughput / axis.throughput,
                        std::numeric_limits<double>::quiet_NaN(), passing.share / axis.share, 0.0};
        if (const auto slope = atLine.slopeThrough(sensor, {{0.0, 0.0}})) {
            const double cosSquared = 1.0 / (1.0 + slope->squaredNorm());
            at.cosFourth = cosSquared * cosSquared;
        }
        at.rest = at.total / (at.cosFourth * at.vignetting);
        curve.push_back(at);
    }
    return curve;
}

}  // namespace etendue
