// Maps from the unit square to discs, hemispheres, spheres and triangles, each beside its density.
#pragma once

#include <cmath>

#include "renderer/vec.h"

namespace etendue {

/// Uniform on the unit disc; concentric, so that neighbours stay neighbours (Shirley and Chiu
/// 1997).
inline Vec2 sampleUnitDisc(Vec2 u) {
    const Vec2 p = {2.0f * u.x - 1.0f, 2.0f * u.y - 1.0f};
    if (p.x == 0.0f && p.y == 0.0f) return {};
    if (std::abs(p.x) > std::abs(p.y)) {
        const float angle = (pi / 4) * (p.y / p.x);
        return {p.x * std::cos(angle), p.x * std::sin(angle)};
    }
    const float angle = (pi / 2) - (pi / 4) * (p.x / p.y);
    return {p.y * std::cos(angle), p.y * std::sin(angle)};
}

/// pdfSolidAngle = cosθ / π around +z.
inline Vec3 sampleCosineHemisphere(Vec2 u) {
    const Vec2 d = sampleUnitDisc(u);
    return {d.x, d.y, std::sqrt(std::max(0.0f, 1.0f - d.x * d.x - d.y * d.y))};
}
constexpr float cosineHemispherePdfSolidAngle(float cosTheta) {
    return cosTheta > 0.0f ? cosTheta * inversePi : 0.0f;
}

/// pdfSolidAngle = 1 / 4π.
inline Vec3 sampleUnitSphere(Vec2 u) {
    const float z = 1.0f - 2.0f * u.x;
    const float r = 2.0f * std::sqrt(std::max(0.0f, u.x * (1.0f - u.x)));
    const float phi = 2.0f * pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), z};
}
inline constexpr float uniformSpherePdfSolidAngle = 0.25f * inversePi;

/// Uniform in the cone of half angle θmax around +z. `oneMinusCosMax` = 1 − cos θmax, given so
/// because the cosine itself rounds to 1 for a narrow cone.
inline Vec3 sampleCone(Vec2 u, float oneMinusCosMax) {
    const float oneMinusCos = u.x * oneMinusCosMax;
    const float sinTheta = std::sqrt(std::max(0.0f, oneMinusCos * (2.0f - oneMinusCos)));
    const float phi = 2.0f * pi * u.y;
    return {sinTheta * std::cos(phi), sinTheta * std::sin(phi), 1.0f - oneMinusCos};
}
constexpr float conePdfSolidAngle(float oneMinusCosMax) {
    return 1.0f / (2.0f * pi * oneMinusCosMax);
}

/// Barycentric coordinates (b1, b2) of the second and third vertex, uniform by area.
inline Vec2 sampleTriangle(Vec2 u) {
    const float root = std::sqrt(u.x);
    return {root * (1.0f - u.y), root * u.y};
}

}  // namespace etendue
