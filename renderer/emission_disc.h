// The disc from which a light at infinity emits: as wide as the scene's bounding sphere, across the
// direction of the light and just before the sphere, so that every point of the scene is reached.
#pragma once

#include "renderer/frame.h"
#include "renderer/light.h"
#include "renderer/sampling.h"

namespace etendue {

/// Uniform on the disc for light that travels along the unit `direction`.
inline Vec3 sampleEmissionDisc(const BoundingSphere& scene, Vec3 direction, Vec2 u) {
    constexpr float distanceInRadii = 1.001f;  // clear of what touches the sphere, after rounding
    const Frame frame = Frame::fromZ(direction);
    const Vec2 d = sampleUnitDisc(u);
    return scene.center +
           (frame.x * d.x + frame.y * d.y - direction * distanceInRadii) * scene.radius;
}

inline float emissionDiscArea(const BoundingSphere& scene) { return pi * square(scene.radius); }
inline float emissionDiscPdfArea(const BoundingSphere& scene) {
    return 1.0f / emissionDiscArea(scene);
}

}  // namespace etendue
