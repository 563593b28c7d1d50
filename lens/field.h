// The field of a lens, by exact tracing: how bright the picture is and how far it reaches.
#pragma once

#include "lens/traced_lens.h"

namespace etendue {

/// Irradiance at `sensor` over that on the axis, under uniform radiance: vignetting, cos⁴ and
/// transmittance together. By `grid`² aperture points, stratified.
double relativeIllumination(const TracedLens& lens, SensorPoint sensor,
                            double wavelengthNm = dLineNm, int grid = 12);

/// How far from the axis, along the unit vector `along`, the picture reaches: where the relative
/// illumination first falls below `share`, mm.
double imageHeightMm(const TracedLens& lens, const Eigen::Vector2d& along, double share = 0.05);
/// The lesser of that along x and along y, which differ in anamorphic lenses alone.
double imageCircleRadiusMm(const TracedLens& lens, double share = 0.05);

/// Full angles between the chief rays of opposite edges, and of opposite corners; through the
/// centre of the stop, at the d line, whether or not a rim blocks them. May exceed 180. Not a
/// number where there is no such ray.
struct FieldOfView {
    double horizontalDegrees, verticalDegrees, diagonalDegrees;
};
FieldOfView fieldOfView(const TracedLens& lens, double sensorWidthMm, double sensorHeightMm);

}  // namespace etendue
