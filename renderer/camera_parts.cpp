// [camera]: where it stands, and which lens it looks through.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "renderer/camera_focus.h"
#include "renderer/scene_parts.h"

namespace etendue {

namespace {

/// Whether somebody says where the camera stands. Who says a part of it must say all.
bool isPlaced(const ConfigTable& table) { return table.has("from") || table.has("to"); }

/// Outside the scene's bounds, from the front, a little from the right and above, with all of them
/// in view.
Vec3d automaticPlace(const ConfigTable& table, const Eigen::Vector2d& focalMm,
                     const CameraSettings& frame, BoundingSphere bounds) {
    const double heightPerWidth = static_cast<double>(frame.height) / frame.width;
    const Eigen::Vector2d halfTangents =
        0.5 * frame.sensorWidthMm * Eigen::Vector2d(1.0, heightPerWidth).cwiseQuotient(focalMm);
    const double narrow = halfTangents.minCoeff();
    const double distance = bounds.radius * std::sqrt(1.0 + 1.0 / (narrow * narrow));
    if (!(distance <= farthestPlace))
        table.fail("", "the whole scene is in view from beyond 1e15 m only: give from and to");
    return toDouble(bounds.center) + normalize(Vec3d{0.45, 0.35, 1.0}) * distance;
}

Transform lookAt(Vec3d from, Vec3d to, Vec3d up) {
    const Vec3d z = normalize(to - from);
    const Vec3d x = normalize(cross(up, z));
    return {x, cross(z, x), z, from};
}

/// Focal length, or the horizontal field of view that the sensor's width turns into one. With
/// neither, a camera that nobody placed has a field of view for looking at things.
double focalLengthMm(const ConfigTable& table, double sensorWidthMm) {
    const bool hasFocalLength = table.has("focal_length_mm"), hasFov = table.has("fov");
    if (hasFocalLength && hasFov) table.fail("fov", "give either fov or focal_length_mm");
    if (hasFocalLength || (isPlaced(table) && !hasFov))
        return table.number("focal_length_mm", {1e-3, 1e5}, 50.0);
    const double fovDegrees = table.number("fov", {0.01, 179.0}, 35.0);
    return 0.5 * sensorWidthMm / std::tan(fovDegrees * std::numbers::pi / 360.0);
}

/// Distance in front of a thin lens, when `distance` is counted from the sensor as on a lens
/// barrel: u + v = d with 1/u + 1/v = 1/f.
double distanceFromLensMm(const ConfigTable& table, double distanceMm, double focalMm) {
    if (std::isinf(distanceMm)) return distanceMm;
    if (!(distanceMm > 4.0 * focalMm))
        table.fail("focus_distance", "counted from the sensor, must exceed four focal lengths: " +
                                         std::to_string(4e-3 * focalMm) + " m");
    return 0.5 * (distanceMm + std::sqrt(distanceMm * (distanceMm - 4.0 * focalMm)));
}

/// Distance in front of a thin lens at which it is sharp, infinity allowed.
double thinLensFocusMm(const ConfigTable& table, double focalMm, const CameraSettings& settings,
                       const Scene& scene) {
    const FocusRequest request = focusRequest(table, settings);
    if (request.sensorShiftMm) return focalMm * (focalMm / *request.sensorShiftMm + 1.0);
    if (request.distanceMm) return distanceFromLensMm(table, *request.distanceMm, focalMm);
    if (!request.point && !request.film)
        table.fail("focus_distance",
                   "a thin lens needs one, or focus_point, focus_pixel or "
                   "sensor_shift_mm");
    double depthMm = 0.0;
    if (request.point) {
        depthMm = depthOfPointMm(table, settings.worldFromLens, *request.point);
    } else {
        const Eigen::Vector2d s = sensorPointMm(settings, *request.film);
        depthMm = depthSeenMm(table, scene, settings.worldFromLens, {},
                              normalize(Vec3d{-s.x(), -s.y(), focalMm}));
    }
    if (!(depthMm > 2.0 * focalMm))
        table.fail(keyOf(request),
                   "so near the lens cannot be focused: nearer than two focal "
                   "lengths");
    return depthMm;
}

std::shared_ptr<const LensModel> loadThinLens(const ConfigTable& table, double focalMm,
                                              const CameraSettings& settings, LoadedScene& loaded) {
    loaded.lensModel = "thin lens";
    loaded.fNumber = table.number("f_number", {0.1, 1e4});
    const double u = thinLensFocusMm(table, focalMm, settings, *loaded.scene);
    const double v = focalMm / (1.0 - focalMm / u);
    loaded.focusDistance = 1e-3 * (u + v);
    return makeThinLens(focalMm, u, 0.5 * focalMm / loaded.fNumber);
}

}  // namespace

Transform placeCamera(const ConfigTable& table, const Eigen::Vector2d& focalMm,
                      const CameraSettings& frame, const Scene& scene) {
    const bool isAutomatic = !isPlaced(table);
    const Vec3d from =
        isAutomatic ? automaticPlace(table, focalMm, frame, scene.bounds()) : place(table, "from");
    const Vec3d to = isAutomatic ? toDouble(scene.bounds().center) : place(table, "to");
    const Vec3d up = table.has("up") ? vector3(table, "up") : Vec3d{0, 1, 0};
    if (!(length(to - from) > 0.0)) table.fail("to", "must differ from 'from'");
    if (!(length(cross(up, to - from)) > 1e-9 * length(up) * length(to - from)))
        table.fail("up", "must not be parallel to the viewing direction");
    return lookAt(from, to, up);
}

void loadCamera(const ConfigTable& table, const LoadOptions& options, LoadingScene& loading,
                LoadedScene& loaded) {
    CameraSettings settings;
    settings.width = loaded.film.width;
    settings.height = loaded.film.height;
    settings.sensorWidthMm = table.number("sensor_width_mm", {1e-3, 1e5}, 36.0);
    settings.exposureStops = table.number("exposure", {-60, 60}, 0.0);
    if (table.has("sensor_offset_mm")) {
        const std::vector<double> offset = table.numbers("sensor_offset_mm", 2, {-1e5, 1e5});
        settings.sensorOffsetMm = {offset[0], offset[1]};
    }
    std::shared_ptr<const LensModel> lens;
    if (table.has("lens")) {
        if (table.has("model")) table.fail("model", "give either model or lens");
        settings.isDispersive = table.boolean("dispersion", options.disperses);
        lens = loadLens(table, settings, options, loading, loaded);
    } else {
        const std::string model = table.choice("model", {"pinhole", "thin-lens"}, "pinhole");
        const double focalMm = focalLengthMm(table, settings.sensorWidthMm);
        settings.worldFromLens = placeCamera(table, {focalMm, focalMm}, settings, *loaded.scene);
        lens = model == "pinhole" ? makePinhole(focalMm)
                                  : loadThinLens(table, focalMm, settings, loaded);
    }
    table.finish();
    loaded.camera = std::make_unique<Camera>(std::move(lens), settings);
}

}  // namespace etendue
