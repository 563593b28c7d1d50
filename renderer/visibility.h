// Visibility between points of the scene, each moved off its surface first.
#pragma once

#include "renderer/light.h"
#include "renderer/scene.h"
#include "renderer/surface_point.h"

namespace etendue {

/// A point known by place and normal only: on a light, or (with zero error) in the air.
inline SurfacePoint bareSurfacePoint(Vec3 position, Vec3 positionError, Vec3 normal) {
    SurfacePoint point;
    point.position = position;
    point.positionError = positionError;
    point.geometricNormal = normal;
    return point;
}

/// Where a ray from `from` ends, so that it does not meet the surface it ends on. The intersector
/// sees that surface from the ray's origin: besides the surface's own error there is the rounding
/// of the differences between its vertices and the origin, and of the ray's direction, a few
/// roundings of the origin's largest coordinate whatever the axis (docs/precision.md).
inline Vec3 rayEnd(SurfacePoint end, Vec3 from) {
    constexpr float roundings = 8.0f, epsilon = 0x1p-24f;
    const float error =
        roundings * epsilon * std::max(maxComponent(abs(from)), maxComponent(abs(end.position)));
    end.positionError += Vec3{error, error, error};
    return offsetOrigin(end, from - end.position);
}

inline bool isVisible(const Scene& scene, const SurfacePoint& a, const SurfacePoint& b) {
    const Vec3 from = offsetOrigin(a, b.position - a.position);
    return scene.isVisible(from, rayEnd(b, from));
}

inline bool isVisible(const Scene& scene, const SurfacePoint& point, const LightSample& sample) {
    const Vec3 from = offsetOrigin(point, sample.direction);
    if (std::isinf(sample.distance)) return scene.isVisibleToInfinity(from, sample.direction);
    return scene.isVisible(
        from, rayEnd(bareSurfacePoint(sample.position, sample.positionError, sample.normal), from));
}

}  // namespace etendue
