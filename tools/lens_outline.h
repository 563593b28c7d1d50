// The cross-section of a lens: outlines of its glass, as a draughtsman draws them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lens/optical_system.h"

namespace etendue {

/// Of lens space, seen so that light comes from the left.
enum class SectionPlane { xz, yz };

/// (−z, height): the axis runs to the right, toward the sensor.
using SectionPoint = Eigen::Vector2d;
SectionPoint inSection(const Eigen::Vector3d& pointMm, SectionPlane plane);

/// One surface from the lower rim to the upper.
std::vector<SectionPoint> surfaceProfile(const TracedSurface& surface, SectionPlane plane);

struct GlassElement {
    std::vector<SectionPoint> outline;  // closed
    double index;                       // at the d line
};
/// From the scene to the sensor. Where the clear apertures of two faces differ, the smaller is
/// framed by a flat, as lenses are made, unless that would cut the other face.
std::vector<GlassElement> glassElements(const OpticalSystem& system, SectionPlane plane);

}  // namespace etendue
