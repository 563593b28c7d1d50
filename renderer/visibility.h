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

inline bool isVisible(const Scene& scene, const SurfacePoint& a, const SurfacePoint& b) {
    const Vec3 direction = b.position - a.position;
    return scene.isVisible(offsetOrigin(a, direction), offsetOrigin(b, -direction));
}

inline bool isVisible(const Scene& scene, const SurfacePoint& point, const LightSample& sample) {
    const Vec3 from = offsetOrigin(point, sample.direction);
    if (std::isinf(sample.distance)) return scene.isVisibleToInfinity(from, sample.direction);
    const SurfacePoint end = bareSurfacePoint(sample.position, sample.positionError, sample.normal);
    return scene.isVisible(from, offsetOrigin(end, -sample.direction));
}

}  // namespace etendue
