// Paraxial data: what first-order optics says about a lens. Distances in mm, positions as z in lens
// space (optical_system.h). Born and Wolf, "Principles of Optics", §4.
#pragma once

#include <Eigen/Core>

#include "lens/optical_system.h"

namespace etendue {

/// Of a plane of symmetry, xz or yz.
struct ParaxialAxis {
    double focalLengthMm;         // EFL, positive for a lens that gathers
    double backFocalDistanceMm;   // BFL: from the last vertex to the focus, toward the sensor
    double frontFocalDistanceMm;  // FFL: from the first vertex to the focus, toward the scene
    double frontPrincipalZMm, rearPrincipalZMm;
    // Images of the stop, seen from the scene and from the sensor. Infinite where the lens is
    // telecentric on that side.
    double entrancePupilZMm, exitPupilZMm;
    double entrancePupilPerStop, exitPupilPerStop;  // height of the image of a stop point at 1 mm

    double entrancePupilRadiusMm(double stopRadiusMm) const;
    double exitPupilRadiusMm(double stopRadiusMm) const;
};

/// Both planes; the same in a lens of revolution.
struct ParaxialData {
    ParaxialAxis x, y;
    double lastVertexZMm;
};
ParaxialData paraxialData(const OpticalSystem& system, double wavelengthNm = dLineNm);

/// Where the image of an object at `objectDistanceMm` from the sensor is sharp: the distance of the
/// sensor behind the last vertex, infinity allowed; the mean of both planes in an anamorphic lens.
/// Throws std::invalid_argument when the object is nearer than the lens can focus, which is where
/// object and image are equally large.
double sensorDistanceMm(const ParaxialData& data, double objectDistanceMm);

/// Focal length over the diameter of the entrance pupil; geometric mean of both planes.
double fNumber(const ParaxialData& data, double stopRadiusMm);
double stopRadiusMm(const ParaxialData& data, double fNumber);

/// The linear map (position, slope) at the sensor → position at the stop.
struct StopMap {
    Eigen::Vector2d bySensor;  // ∂a/∂s: x on x, y on y
    Eigen::Vector2d bySlope;   // ∂a/∂q, mm
};
StopMap stopMap(const OpticalSystem& system, double sensorDistanceMm,
                double wavelengthNm = dLineNm);

}  // namespace etendue
