// SurfacePoint: where a ray met the scene, with a bound on how far rounding may have moved it.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "renderer/frame.h"
#include "renderer/vec.h"

namespace etendue {

struct Instance;
struct Material;
struct Mesh;
struct RayHit;

struct Ray {
    Vec3 origin;
    Vec3 direction;  // unit
    float maxDistance = std::numeric_limits<float>::infinity();
};

struct SurfacePoint {
    SurfacePoint() = default;
    /// The point of a hit in world space: computed in double from the barycentric coordinates, so
    /// that its error does not grow with the ray's length. docs/precision.md derives the bound.
    SurfacePoint(const Mesh& mesh, const Instance& instance, const RayHit& hit);

    Vec3 position;
    Vec3 positionError;    // per axis: the surface that the intersector sees lies within ± this
    Vec3 geometricNormal;  // unit, on the front side (counter-clockwise winding)
    Frame shading;         // z = interpolated normal, in the hemisphere of geometricNormal
    Vec2 uv;
    const Material* material = nullptr;
    int light = -1;  // index of the light this triangle belongs to, or -1
};

/// The float next to `x` on the side of `direction`'s sign; denormals count as zero.
/// (std::nextafter is a library call, and this is needed six times a bounce.)
inline float nextFloat(float x, float direction) {
    constexpr float smallest = std::numeric_limits<float>::min();
    if (std::abs(x) < smallest) return std::copysign(smallest, direction);
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
    return std::bit_cast<float>((x < 0.0f) == (direction < 0.0f) ? bits + 1 : bits - 1);
}

/// Where a ray leaving `point` along `direction` (not necessarily unit) starts, so that it cannot
/// meet the surface it leaves: moved off the plane by the error bound, then rounded away from it
/// (Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th ed., §6.8.6).
inline Vec3 offsetOrigin(const SurfacePoint& point, Vec3 direction) {
    const Vec3 n =
        dot(direction, point.geometricNormal) < 0 ? -point.geometricNormal : point.geometricNormal;
    const Vec3 offset = n * dot(abs(n), point.positionError);
    const auto away = [](float p, float d) { return d == 0.0f ? p : nextFloat(p + d, d); };
    return {away(point.position.x, offset.x), away(point.position.y, offset.y),
            away(point.position.z, offset.z)};
}

}  // namespace etendue
