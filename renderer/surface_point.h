// SurfacePoint: where a ray met the scene, with a bound on how far rounding may have moved it.
#pragma once

#include <cstdint>
#include <limits>

#include "renderer/frame.h"
#include "renderer/vec.h"

namespace etendue {

struct Material;

struct Ray {
    Vec3 origin;
    Vec3 direction;  // unit
    float maxDistance = std::numeric_limits<float>::infinity();
};

struct SurfacePoint {
    Vec3 position;
    Vec3 positionError;    // per axis: the surface that the intersector sees lies within ± this
    Vec3 geometricNormal;  // unit, on the front side (counter-clockwise winding)
    Frame shading;         // z = interpolated normal, in the hemisphere of geometricNormal
    Vec2 uv;
    const Material* material = nullptr;
    int light = -1;  // index of the light this triangle belongs to, or -1
};

/// Where a ray leaving `point` along `direction` (not necessarily unit) starts, so that it cannot
/// meet the surface it leaves: moved off the plane by the error bound, then rounded away from it
/// (Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th ed., §6.8.6).
inline Vec3 offsetOrigin(const SurfacePoint& point, Vec3 direction) {
    const Vec3 n =
        dot(direction, point.geometricNormal) < 0 ? -point.geometricNormal : point.geometricNormal;
    const Vec3 offset = n * dot(abs(n), point.positionError);
    const auto away = [](float p, float d) {
        const float moved = p + d;
        if (d > 0) return std::nextafter(moved, std::numeric_limits<float>::infinity());
        if (d < 0) return std::nextafter(moved, -std::numeric_limits<float>::infinity());
        return moved;
    };
    return {away(point.position.x, offset.x), away(point.position.y, offset.y),
            away(point.position.z, offset.z)};
}

}  // namespace etendue
