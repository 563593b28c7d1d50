// The Jacobians by which a lens changes densities, each once. Equation numbers are those of
// docs/camera.md and docs/fitting.md.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "lens/lens_model.h"

namespace etendue {

/// J of equation (1), 1/mm²: cos⁴θ / |det ∂A/∂q|, the étendue per area of the sensor and area of
/// the aperture. `slope` q at the sensor, `apertureBySlope` ∂A/∂q, mm, at a fixed sensor point.
inline double exchangeJacobian(const Eigen::Vector2d& slope,
                               const Eigen::Matrix2d& apertureBySlope) {
    const double cosSquared = 1.0 / (1.0 + slope.squaredNorm());
    return cosSquared * cosSquared / std::abs(apertureBySlope.determinant());
}

/// K = −(∂A/∂q)⁻¹ ∂A/∂s of equation (8), 1/mm: how the slope turns with the sensor point while the
/// aperture point stays.
inline Eigen::Matrix2d slopeBySensor(const Eigen::Matrix2d& apertureBySlope,
                                     const Eigen::Matrix2d& apertureBySensor) {
    return -apertureBySlope.inverse() * apertureBySensor;
}

/// Of two columns as seen along `direction`; negative where the map that they belong to has turned
/// over.
inline double determinantAcross(const Eigen::Vector3d& direction,
                                const Eigen::Matrix<double, 3, 2>& columns) {
    const Eigen::Vector3d first = columns.col(0), second = columns.col(1);
    return direction.dot(first.cross(second));
}

/// F(t) of equation (2), mm per mm: how the ray's point at the distance `t` moves with the sensor
/// point while the aperture point stays.
inline Eigen::Matrix<double, 3, 2> footprint(const ExitRay& ray, double t) {
    return ray.originBySensor + t * ray.directionBySensor;
}

/// Solid angle that the ray's direction sweeps per area of the sensor, 1/mm²: |det F(t)| / t² far
/// away.
inline double turning(const ExitRay& ray) {
    return determinantAcross(ray.direction, ray.directionBySensor);
}

}  // namespace etendue
