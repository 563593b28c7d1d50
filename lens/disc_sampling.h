// The map from the unit square to the unit disc that round apertures are drawn with.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace etendue {

/// The point of the unit circle at `angle` from +x, for |angle| ≤ π/4, within two roundings: Taylor
/// series to where they are exact. Inline and without a branch, a fraction of the library's time.
inline Eigen::Vector2d nearUnitX(double angle) {
    const double x = angle * angle, x2 = x * x, x4 = x2 * x2;
    // 1/n!, in pairs (Estrin): half of the steps that follow one another.
    const double sine =
        ((-1.0 / 6.0 + x * (1.0 / 120.0)) + x2 * (-1.0 / 5040.0 + x * (1.0 / 362880.0))) +
        x4 * ((-1.0 / 39916800.0 + x * (1.0 / 6227020800.0)) +
              x2 * (-1.0 / 1307674368000.0 + x * (1.0 / 355687428096000.0)));
    const double cosine =
        ((1.0 / 24.0 - x * (1.0 / 720.0)) + x2 * (1.0 / 40320.0 - x * (1.0 / 3628800.0))) +
        x4 * ((1.0 / 479001600.0 - x * (1.0 / 87178291200.0)) + x2 * (1.0 / 20922789888000.0));
    return {1.0 + x * (x * cosine - 0.5), angle + angle * x * sine};
}

/// Uniform on the unit disc; concentric, so that neighbours stay neighbours (Shirley and Chiu
/// 1997, "A Low Distortion Map Between Disk and Square"). `u` in [0, 1)². Squares around the
/// centre of the unit square become circles; rounding may leave the disc by a few ulps.
inline Eigen::Vector2d sampleUnitDisc(Eigen::Vector2d u) {
    const double x = 2.0 * u.x() - 1.0, y = 2.0 * u.y() - 1.0;
    if (x == 0.0 && y == 0.0) return {0.0, 0.0};
    constexpr double quarter = 0.25 * std::numbers::pi;
    const bool xLeads = std::abs(x) > std::abs(y);
    const double radius = xLeads ? x : y, side = xLeads ? y : x;
    const Eigen::Vector2d d = radius * nearUnitX(quarter * (side / radius));
    return {xLeads ? d.x() : d.y(), xLeads ? d.y() : d.x()};
}

}  // namespace etendue
