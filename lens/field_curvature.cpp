#include "lens/field_curvature.h"

#include <Eigen/Geometry>

#include "lens/ray_path.h"

namespace etendue {

namespace {

using D = Dual<2>;

constexpr PencilFocus none{std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::quiet_NaN()};

/// The ray toward the sensor that comes from `target` through `point` + u `first` + v `second`,
/// differentiated by u and v at 0. Both are across the ray.
LensRay<D> pencil(const Eigen::Vector3d& target, const Eigen::Vector3d& point,
                  const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
    const double distance = (target - point).norm();
    const Eigen::Vector3d direction = (point - target) / distance;
    const auto dual = [&](double value, int component, double scale) {
        D result(value);
        result.partials = {scale * first[component], scale * second[component]};
        return result;
    };
    const auto moved = [&](const Eigen::Vector3d& value, double scale) {
        return Vector3<D>{dual(value.x(), 0, scale), dual(value.y(), 1, scale),
                          dual(value.z(), 2, scale)};
    };
    return {moved(point, 1.0), moved(direction, 1.0 / distance)};
}

}  // namespace

PencilFocus pencilFocus(const TracedLens& lens, const Eigen::Vector2d& along, double heightMm,
                        double focusDistanceMm) {
    const SensorPoint sensor{heightMm * along};
    const MonochromaticLens atLine(lens, dLineNm);
    const std::optional<ExitRay> chief = atLine.trace(sensor, {{0.0, 0.0}});
    const std::optional<Eigen::Vector3d> target = objectPoint(lens, sensor, focusDistanceMm);
    if (!chief || !target) return none;
    const Eigen::Vector3d across(-along.y(), along.x(), 0.0);
    LensRay<D> ray = pencil(*target, chief->origin, across.cross(chief->direction), across);
    const Passage passage = carryToSensor<TraceMode::geometry>(
        atLine.system(), 0, lens.system().surfaces.size(), ray, [](auto...) {});
    if (passage.status != TraceStatus::passed) return none;
    const PlaneState<D> end = planeState(ray, lens.sensorZMm());
    // The point at `z` in front of the sensor is end + z slope.
    const auto focus = [&](const Eigen::Vector2d& axis, std::size_t variable) {
        const auto by = [&](const D& x, const D& y) {
            return axis.dot(Eigen::Vector2d(x.partials[variable], y.partials[variable]));
        };
        return -by(end.x, end.y) / by(end.slopeX, end.slopeY);
    };
    return {focus(along, 0), focus(across.head<2>(), 1)};
}

}  // namespace etendue
