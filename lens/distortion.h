// Distortion: how a lens maps the scene's directions to the sensor, and that map in the two forms
// that camera calibrations use.
//
// In both, x right, y down and z forward are the axes of an upright picture, so that a point of the
// scene in the direction (X, Y, Z) has x = X/Z, y = Y/Z, and is seen at (u, v), mm from the centre.
// Divide u, v and both focal lengths by the pixel pitch to have OpenCV's units.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lens/traced_lens.h"

namespace etendue {

/// A chief ray at the d line, one that no rim blocks: where it meets the sensor, and its direction
/// in the scene, lens space.
struct FieldRay {
    Eigen::Vector2d sensorMm;
    Eigen::Vector3d direction;
};

/// From `grid`² points over the sensor, those left out that are farther than `imageRadiusMm` from
/// the axis or have no chief ray.
std::vector<FieldRay> chiefRays(const TracedLens& lens, const Eigen::Vector2d& sensorHalfSizeMm,
                                double imageRadiusMm, int grid = 17);

/// How far a fitted model puts the chief rays' points off, mm.
struct DistortionResidual {
    double rmsMm = 0.0, mostMm = 0.0;
};

/// OpenCV's calibrateCamera with five coefficients, r² = x² + y²:
///     u = fx (x (1 + k₁ r² + k₂ r⁴ + k₃ r⁶) + 2 p₁ x y + p₂ (r² + 2 x²)),
///     v = fy (y (1 + k₁ r² + k₂ r⁴ + k₃ r⁶) + p₁ (r² + 2 y²) + 2 p₂ x y)
struct PinholeDistortion {
    Eigen::Vector2d focalLengthMm;
    double k1, k2, p1, p2, k3;
    DistortionResidual residual;
};

/// OpenCV's fisheye::calibrate, after Kannala and Brandt, θ the angle from the axis:
///     (u, v) = (fx x/r, fy y/r) θ (1 + k₁ θ² + k₂ θ⁴ + k₃ θ⁶ + k₄ θ⁸)
struct FisheyeDistortion {
    Eigen::Vector2d focalLengthMm;
    std::array<double, 4> k;
    DistortionResidual residual;
};

/// By least squares of the distances on the sensor, focal lengths too. The pinhole's is empty when
/// a ray is 85° or more from the axis, where tangents end; both when there are too few rays.
std::optional<PinholeDistortion> fitPinhole(std::span<const FieldRay> rays);
std::optional<FisheyeDistortion> fitFisheye(std::span<const FieldRay> rays);

/// Of the chief ray from the sensor point at a height.
struct DistortionPoint {
    double heightMm;
    double fieldDegrees;
    double rectilinearPercent;  // r/(f tan θ) − 1; not a number beyond 89°
    double equidistantPercent;  // r/(f θ) − 1
};
/// At `count` heights up to `highestMm` along the unit vector `along`; those without chief ray left
/// out. f is r/θ close to the axis.
std::vector<DistortionPoint> distortionCurve(const TracedLens& lens, const Eigen::Vector2d& along,
                                             double highestMm, int count);

}  // namespace etendue
