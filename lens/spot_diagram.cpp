#include "lens/spot_diagram.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace etendue {

std::vector<AperturePoint> sunflower(double radiusMm, int count) {
    const double goldenAngle = std::numbers::pi * (3.0 - std::sqrt(5.0));
    std::vector<AperturePoint> points;
    for (int i = 0; i < count; ++i) {
        const double radius = radiusMm * std::sqrt((i + 0.5) / count);
        points.push_back(
            {{radius * std::cos(goldenAngle * i), radius * std::sin(goldenAngle * i)}});
    }
    return points;
}

std::vector<Eigen::Vector2d> spotDiagram(const LensModel& lens, const Eigen::Vector3d& targetMm,
                                         double wavelengthNm,
                                         std::span<const AperturePoint> apertures) {
    std::vector<Eigen::Vector2d> points;
    const Eigen::Vector2d none =
        Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    for (const AperturePoint& aperture : apertures) {
        const auto sensor = lens.connect(targetMm, aperture, wavelengthNm);
        points.push_back(sensor ? sensor->mm : none);
    }
    return points;
}

SpotSize spotSize(std::span<const Eigen::Vector2d> pointsMm) {
    SpotSize size;
    for (const Eigen::Vector2d& point : pointsMm)
        if (point.allFinite()) {
            size.centroidMm += point;
            ++size.points;
        }
    if (size.points == 0) return size;
    size.centroidMm /= size.points;
    double squares = 0.0;
    for (const Eigen::Vector2d& point : pointsMm)
        if (point.allFinite()) squares += (point - size.centroidMm).squaredNorm();
    size.rmsRadiusMm = std::sqrt(squares / size.points);
    return size;
}

}  // namespace etendue
