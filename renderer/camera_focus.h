// Where a camera is to be sharp: a distance, a point, what a pixel shows, or a shift of the sensor.
#pragma once

#include <optional>

#include "config/config.h"
#include "lens/paraxial.h"
#include "lens/prescription.h"
#include "renderer/camera.h"
#include "renderer/scene.h"
#include "renderer/transform.h"

namespace etendue {

/// What the keys of a [camera] table ask for. At most one is set; none: infinity.
struct FocusRequest {
    std::optional<double> distanceMm;  // from the sensor, as on a lens barrel
    std::optional<Vec3d> point;        // world
    std::optional<Vec2> film;          // pixels: sharp is what is seen there
    std::optional<double>
        sensorShiftMm;  // from the sensor's place for infinity, away from the lens
};

/// focus_distance, focus_point, focus_pixel, which must lie in the frame, and sensor_shift_mm.
FocusRequest focusRequest(const ConfigTable& table, const CameraSettings& frame);
/// The key that asked, for messages.
const char* keyOf(const FocusRequest& request);

/// What the ray meets, as depth along the camera's axis from the lens' origin, mm. Throws at
/// focus_pixel when it meets nothing.
double depthSeenMm(const ConfigTable& table, const Scene& scene, const Transform& worldFromLens,
                   Vec3d originMm, Vec3d direction);
/// Of a world point. Throws at focus_point when it is not in front of the lens.
double depthOfPointMm(const ConfigTable& table, const Transform& worldFromLens, Vec3d point);

/// The distance from the sensor of a plane `depthMm` in front of the lens' origin, when the lens is
/// focused on it. Throws std::invalid_argument when it cannot be.
double focusDistanceForDepthMm(const Prescription& prescription, const ParaxialData& data,
                               double depthMm);
/// The focus distance of a lens whose sensor was moved. `shiftMm` ≥ 0.
double focusDistanceForShiftMm(const ParaxialData& data, double shiftMm);

}  // namespace etendue
