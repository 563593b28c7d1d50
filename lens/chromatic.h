// Colour: how the place and the sharpness of an image change with wavelength.
#pragma once

#include <vector>

#include "lens/traced_lens.h"

namespace etendue {

/// Lateral colour: how much farther from the axis than at the d line the ray of `wavelengthNm`
/// from the same scene point through the middle of the stop meets the sensor, mm. The scene point
/// is that which the d line's chief ray from `heightMm` along `along` sees. Not a number where a
/// rim blocks one of them.
double lateralColourMm(const TracedLens& lens, const Eigen::Vector2d& along, double heightMm,
                       double wavelengthNm, double focusDistanceMm);

/// Longitudinal aberration: how far in front of the sensor, toward the scene, the ray from the
/// axial scene point through the stop at `share` of its radius crosses the axis, mm, in the plane
/// of `along`. Close to share 0 it is the paraxial focus, and its change with wavelength axial
/// colour. Not a number where a rim blocks it.
double focusShiftMm(const TracedLens& lens, const Eigen::Vector2d& along, double share,
                    double wavelengthNm, double focusDistanceMm);

}  // namespace etendue
