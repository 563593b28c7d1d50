#include "lens/spot_diagram.h"

#include <cmath>
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
    for (const AperturePoint& aperture : apertures)
        if (const auto sensor = lens.connect(targetMm, aperture, wavelengthNm))
            points.push_back(sensor->mm);
    return points;
}

SpotSize spotSize(std::span<const Eigen::Vector2d> pointsMm) {
    SpotSize size;
    if (pointsMm.empty()) return size;
    const double count = static_cast<double>(pointsMm.size());
    for (const Eigen::Vector2d& point : pointsMm) size.centroidMm += point / count;
    double squares = 0.0;
    for (const Eigen::Vector2d& point : pointsMm)
        squares += (point - size.centroidMm).squaredNorm();
    size.rmsRadiusMm = std::sqrt(squares / count);
    return size;
}

}  // namespace etendue
