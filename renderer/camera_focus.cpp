#include "renderer/camera_focus.h"

#include <cmath>
#include <stdexcept>

#include "renderer/scene_parts.h"

namespace etendue {

namespace {

constexpr double mmPerMetre = 1e3;

Vec2 focusPixel(const ConfigTable& table, const CameraSettings& frame) {
    const std::vector<double> pixel = table.numbers("focus_pixel", 2, Range::any());
    const bool isInside =
        pixel[0] >= 0.0 && pixel[0] <= frame.width && pixel[1] >= 0.0 && pixel[1] <= frame.height;
    if (!isInside)
        table.fail("focus_pixel", "must lie in the frame of " + std::to_string(frame.width) +
                                      " × " + std::to_string(frame.height) + " pixels");
    return {static_cast<float>(pixel[0]), static_cast<float>(pixel[1])};
}

}  // namespace

FocusRequest focusRequest(const ConfigTable& table, const CameraSettings& frame) {
    FocusRequest request;
    int asked = 0;
    const auto isAsked = [&](const char* key) {
        if (!table.has(key)) return false;
        if (++asked > 1)
            table.fail(key,
                       "give one of focus_distance, focus_point, focus_pixel and "
                       "sensor_shift_mm");
        return true;
    };
    if (isAsked("focus_distance"))
        request.distanceMm = mmPerMetre * table.number("focus_distance", {1e-6, Range::infinity});
    if (isAsked("focus_point")) request.point = vector3(table, "focus_point");
    if (isAsked("focus_pixel")) request.film = focusPixel(table, frame);
    if (isAsked("sensor_shift_mm"))
        request.sensorShiftMm = table.number("sensor_shift_mm", {0.0, 1e5});
    return request;
}

const char* keyOf(const FocusRequest& request) {
    return request.point           ? "focus_point"
           : request.film          ? "focus_pixel"
           : request.sensorShiftMm ? "sensor_shift_mm"
                                   : "focus_distance";
}

double depthSeenMm(const ConfigTable& table, const Scene& scene, const Transform& worldFromLens,
                   Vec3d originMm, Vec3d direction) {
    const Ray ray{toFloat(worldFromLens.point(originMm / mmPerMetre)),
                  toFloat(worldFromLens.vector(direction))};
    const std::optional<SurfacePoint> hit = scene.closestHit(ray);
    if (!hit) table.fail("focus_pixel", "there is nothing to be seen at that pixel");
    return worldFromLens.inverse().point(toDouble(hit->position)).z * mmPerMetre;
}

double depthOfPointMm(const ConfigTable& table, const Transform& worldFromLens, Vec3d point) {
    const double depth = worldFromLens.inverse().point(point).z * mmPerMetre;
    if (!(depth > 0.0)) table.fail("focus_point", "must lie in front of the lens");
    return depth;
}

double focusDistanceForDepthMm(const Prescription& prescription, const ParaxialData& data,
                               double depthMm) {
    const auto sensorBehindOrigin = [&](double distanceMm) {
        return lengthMm(prescription) + sensorDistanceMm(data, distanceMm);
    };
    // The sensor's place follows the distance so slowly that a few rounds suffice; nearer than two
    // focal lengths they would not settle, and there the lens cannot focus.
    double distanceMm = depthMm + sensorBehindOrigin(std::numeric_limits<double>::infinity());
    for (int round = 0; round < 200; ++round) {
        const double next = depthMm + sensorBehindOrigin(distanceMm);
        if (std::abs(next - distanceMm) <= 1e-12 * next) return next;
        distanceMm = next;
    }
    throw std::invalid_argument("so near the lens cannot be focused");
}

double focusDistanceForShiftMm(const ParaxialData& data, double shiftMm) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double atInfinity = sensorDistanceMm(data, infinity);
    if (shiftMm == 0.0) return infinity;
    // The shift falls steadily with the distance: Newton's equation for one plane, the mean of two
    // in an anamorphic lens. Bisection in the distance's logarithm.
    const auto isTooFar = [&](double distanceMm) {
        return sensorDistanceMm(data, distanceMm) - atInfinity < shiftMm;
    };
    const auto canFocus = [&](double distanceMm) {
        try {
            sensorDistanceMm(data, distanceMm);
            return true;
        } catch (const std::invalid_argument&) {
            return false;
        }
    };
    double near = 1e-3, far = 1e15;
    for (int i = 0; i < 200; ++i) {
        const double middle = std::sqrt(near * far);
        (canFocus(middle) && isTooFar(middle) ? far : near) = middle;
    }
    if (!(std::abs(sensorDistanceMm(data, far) - atInfinity - shiftMm) <= 1e-6 * shiftMm))
        throw std::invalid_argument("the lens focuses nothing with the sensor so far back");
    return far;
}

}  // namespace etendue
