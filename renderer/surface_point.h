// SurfacePoint: where a ray met the scene, with a bound on how far rounding may have moved it.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "renderer/frame.h"
#include "renderer/lanes.h"
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

/// For each lane of `by` that is not zero: the float after x + by on the side of by's sign;
/// denormals count as zero. (std::nextafter is a library call, and this is needed twice a bounce.)
inline FloatLanes movedPast(FloatLanes x, FloatLanes by) {
    constexpr std::int32_t signBit = std::numeric_limits<std::int32_t>::min();
    constexpr float smallest = std::numeric_limits<float>::min();
    const FloatLanes sum = x + by;
    const auto bits = std::bit_cast<IntLanes>(sum), sign = std::bit_cast<IntLanes>(by) & signBit;
    // Of the sign's side if the bits grow: away from zero.
    const IntLanes isOutward = ((bits ^ sign) >= 0) & 1;
    const IntLanes next = bits + 2 * isOutward - 1;
    const IntLanes nearZero = sign | std::bit_cast<std::int32_t>(smallest);
    const IntLanes isNearZero = (sum > -smallest) & (sum < smallest);
    const auto moved = std::bit_cast<FloatLanes>(isNearZero ? nearZero : next);
    return by == 0.0f ? x : moved;
}

/// Where a ray leaving `point` along `direction` (not necessarily unit) starts, so that it cannot
/// meet the surface it leaves: moved off the plane by the error bound, then rounded away from it
/// (Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th ed., §6.8.6).
inline Vec3 offsetOrigin(const SurfacePoint& point, Vec3 direction) {
    const Vec3 n =
        dot(direction, point.geometricNormal) < 0 ? -point.geometricNormal : point.geometricNormal;
    const float distance = dot(abs(n), point.positionError);
    return vecOf(movedPast(lanesOf(point.position), lanesOf(n) * distance));
}

}  // namespace etendue
