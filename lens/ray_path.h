// Whole rays from one point of the scene, surface by surface: for drawings and spot diagrams.
#pragma once

#include <vector>

#include "lens/traced_lens.h"

namespace etendue {

/// The chief ray from `sensor`; where no light crosses the middle of the stop, the ray through the
/// middle of what passes. Empty where nothing passes.
std::optional<ExitRay> middleRay(const TracedLens& lens, const MonochromaticLens& atLine,
                                 SensorPoint sensor);

/// What the middle ray at the d line sees in the distance `focusDistanceMm` from the sensor: on the
/// plane across the axis there, or, beyond 60° from the axis, as far away along the ray. Infinity
/// stands for 1000 km. Empty where there is no such ray.
std::optional<Eigen::Vector3d> objectPoint(const TracedLens& lens, SensorPoint sensor,
                                           double focusDistanceMm);

/// `count` aperture points, evenly spaced along the unit vector `along` from edge to edge of what
/// passes of the beam from `targetMm`. None if nothing passes.
std::vector<AperturePoint> clearFan(const TracedLens& lens, const MonochromaticLens& atLine,
                                    const Eigen::Vector3d& targetMm, const Eigen::Vector2d& along,
                                    int count);

struct RayPath {
    std::vector<Eigen::Vector3d> pointsMm;  // on the sensor, then on each surface to the first
    Eigen::Vector3d direction;              // of the ray that leaves
};
/// The ray from `targetMm` through `aperture`. Empty if it does not pass.
std::optional<RayPath> rayPath(const TracedLens& lens, const MonochromaticLens& atLine,
                               const Eigen::Vector3d& targetMm, AperturePoint aperture);

}  // namespace etendue
