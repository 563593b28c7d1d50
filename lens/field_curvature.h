// Field curvature and astigmatism: how far from the sensor the picture is sharp, over the field.
#pragma once

#include "lens/traced_lens.h"

namespace etendue {

/// Where a thin pencil about the chief ray is sharp: in front of the sensor, toward the scene,
/// along the axis, mm. Tangential is the focus of rays that differ along the unit vector `along`,
/// sagittal that of rays that differ across it. Infinite where they leave parallel.
struct PencilFocus {
    double tangentialMm, sagittalMm;
};

/// Of the scene point that the d line's chief ray from `heightMm` along `along` sees in the focus
/// distance. `along` lies in a mirror plane of the lens. Not a number where a rim blocks the chief
/// ray. On the axis both are the paraxial focus.
///
/// By the exact derivatives of one ray: its neighbours meet it where the derivative of its point
/// vanishes. That is what Coddington's equations give surface by surface (Welford 1986,
/// "Aberrations of Optical Systems").
PencilFocus pencilFocus(const TracedLens& lens, const Eigen::Vector2d& along, double heightMm,
                        double focusDistanceMm);

}  // namespace etendue
