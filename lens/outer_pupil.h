// OuterPupil: light that enters through a point drawn on the lens' outermost surface and is traced
// on to the sensor, if it gets there. This is how light tracers found the sensor before they could
// aim through the aperture; here it is what that is compared with.
#pragma once

#include <optional>

#include "lens/traced_lens.h"

namespace etendue {

/// Where a ray into the lens arrived.
struct PupilArrival {
    Eigen::Vector2d sensorMm;
    Eigen::Vector3d entranceMm, direction;  // of the ray, unit, from the lens toward the scene
    /// τ cosθ over the density of the point on the surface, mm²: times the radiance that comes
    /// along the ray and the solid angle it comes in, an estimate of what arrives.
    double etenduePerSolidAngle;
};

class OuterPupil {
public:
    explicit OuterPupil(std::shared_ptr<const TracedLens> lens);

    /// The ray from `targetMm`, or from its direction at infinity, through the point of the
    /// outermost surface that `u` draws: uniform on its rim's disc along the axis. Empty when it
    /// ends inside the lens.
    std::optional<PupilArrival> arrive(const Eigen::Vector3d& targetMm, bool isAtInfinity,
                                       Eigen::Vector2d u, double wavelengthNm) const;

private:
    std::shared_ptr<const TracedLens> lens_;
};

}  // namespace etendue
