#include "lens/chromatic.h"

#include "lens/ray_path.h"

namespace etendue {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double lateralColourMm(const TracedLens& lens, const Eigen::Vector2d& along, double heightMm,
                       double wavelengthNm, double focusDistanceMm) {
    const SensorPoint sensor{heightMm * along};
    const AperturePoint middle{{0.0, 0.0}};
    const std::optional<Eigen::Vector3d> target = objectPoint(lens, sensor, focusDistanceMm);
    if (!target || !lens.trace(sensor, middle, dLineNm)) return none;
    const auto found = lens.connect(*target, middle, wavelengthNm);
    return found ? found->mm.dot(along) - heightMm : none;
}

double focusShiftMm(const TracedLens& lens, const Eigen::Vector2d& along, double share,
                    double wavelengthNm, double focusDistanceMm) {
    const std::optional<Eigen::Vector3d> target = objectPoint(lens, {{0.0, 0.0}}, focusDistanceMm);
    if (!target) return none;
    const MonochromaticLens atLine(lens, wavelengthNm);
    const AperturePoint aperture{share * lens.system().aperture.radiusMm() * along};
    const auto sensor = atLine.connect(*target, aperture);
    if (!sensor) return none;
    const auto slope = atLine.slopeThrough(*sensor, aperture);
    return slope ? -sensor->mm.dot(along) / slope->dot(along) : none;
}

}  // namespace etendue
