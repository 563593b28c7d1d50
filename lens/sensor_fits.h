// Small fits about the sensor that go with a lens fit: where connect() starts its search, and the
// slope at the sensor, by which a lens is refocused.
#pragma once

#include <cmath>
#include <span>

#include "lens/fit_rays.h"
#include "lens/polynomial_basis.h"

namespace etendue {

/// A direction as a point in the plane, by Lambert's equal-area projection about +z: at the radius
/// 2 sin(θ/2), smooth up to 180° off the axis.
inline Eigen::Vector2d fieldCoordinates(const Eigen::Vector3d& direction) {
    return direction.head<2>() * std::sqrt(2.0 / (1.0 + direction.z()));
}

/// The sensor point from the direction in which the target is seen and from the aperture point.
struct ConnectStart {
    SparsePolynomial sensor;   // (field coordinates of the exit direction, a, λ) → s, mm
    double widestField = 0.0;  // no |field coordinates| in the domain are larger
    double errorMm = 0.0;      // rms over the training rays
};

/// `isAxial`: whether the lens turns about its axis unchanged.
ConnectStart fitConnectStart(std::span<const FitRay> training, bool isAxial);

/// (s, a, λ) → slope at the sensor.
SparsePolynomial fitSensorSlope(std::span<const FitRay> training, bool isAxial);

}  // namespace etendue
