// The map from the unit square to the unit disc that round apertures are drawn with.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace etendue {

/// Uniform on the unit disc; concentric, so that neighbours stay neighbours (Shirley and Chiu
/// 1997, "A Low Distortion Map Between Disk and Square"). `u` in [0, 1)². Squares around the
/// centre of the unit square become circles; rounding may leave the disc by a few ulps.
inline Eigen::Vector2d sampleUnitDisc(Eigen::Vector2d u) {
    const double x = 2.0 * u.x() - 1.0, y = 2.0 * u.y() - 1.0;
    if (x == 0.0 && y == 0.0) return {0.0, 0.0};
    constexpr double quarter = 0.25 * std::numbers::pi;
    const bool xLeads = std::abs(x) > std::abs(y);
    const double radius = xLeads ? x : y;
    const double angle = xLeads ? quarter * (y / x) : quarter * (2.0 - x / y);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace etendue
