// Spot diagrams: where the rays from one point of the scene meet the sensor.
#pragma once

#include <span>
#include <vector>

#include "lens/lens_model.h"

namespace etendue {

/// `count` points evenly over a disc, in a sunflower's order (Vogel 1979).
std::vector<AperturePoint> sunflower(double radiusMm, int count);

/// One point for each aperture point, not a number where no ray passes. The same for every lens
/// model, so that an exact and a fitted lens can be compared ray by ray.
std::vector<Eigen::Vector2d> spotDiagram(const LensModel& lens, const Eigen::Vector3d& targetMm,
                                         double wavelengthNm,
                                         std::span<const AperturePoint> apertures);

/// Of the points that are numbers.
struct SpotSize {
    Eigen::Vector2d centroidMm = Eigen::Vector2d::Zero();
    double rmsRadiusMm = 0.0;  // about the centroid
    int points = 0;
};
SpotSize spotSize(std::span<const Eigen::Vector2d> pointsMm);

}  // namespace etendue
