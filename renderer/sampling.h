// Maps from the unit square to discs, hemispheres, spheres and triangles, each beside its density.
#pragma once

#include <cmath>

#include "renderer/vec.h"

namespace etendue {

/// The point of the unit circle at `angle` from +x, for |angle| ≤ π/4; within one rounding of sine
/// and cosine. Inline and without a branch, a third of the library's time, and the same bits on
/// every system. The polynomials are those of Moshier's Cephes library.
constexpr Vec2 nearUnitX(float angle) {
    const float x = angle * angle;
    const float sine = ((-1.9515295891e-4f * x + 8.3321608736e-3f) * x - 1.6666654611e-1f) * x;
    const float cosine =
        ((2.443315711809948e-5f * x - 1.388731625493765e-3f) * x + 4.166664568298827e-2f) * x;
    return {1.0f + x * (cosine - 0.5f), angle + angle * sine};
}

/// The point of the unit circle at `turns` turns from +x towards +y; 0 ≤ turns ≤ 1.
inline Vec2 onUnitCircle(float turns) {
    const float quarter = std::floor(4.0f * turns + 0.5f);
    const Vec2 d = nearUnitX((pi / 2) * (4.0f * turns - quarter));
    const int quarters = static_cast<int>(quarter);
    const Vec2 turned = quarters & 1 ? Vec2{-d.y, d.x} : d;
    return quarters & 2 ? turned * -1.0f : turned;
}

/// Uniform on the unit disc; concentric, so that neighbours stay neighbours (Shirley and Chiu
/// 1997).
inline Vec2 sampleUnitDisc(Vec2 u) {
    const Vec2 p = {2.0f * u.x - 1.0f, 2.0f * u.y - 1.0f};
    if (p.x == 0.0f && p.y == 0.0f) return {};
    const bool xLeads = std::abs(p.x) > std::abs(p.y);
    const float radius = xLeads ? p.x : p.y, side = xLeads ? p.y : p.x;
    const Vec2 d = nearUnitX((pi / 4) * (side / radius)) * radius;
    return xLeads ? d : Vec2{d.y, d.x};
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
    const Vec2 around = onUnitCircle(u.y) * r;
    return {around.x, around.y, z};
}
inline constexpr float uniformSpherePdfSolidAngle = 0.25f * inversePi;

/// Uniform in the cone of half angle θmax around +z. `oneMinusCosMax` = 1 − cos θmax, given so
/// because the cosine itself rounds to 1 for a narrow cone.
inline Vec3 sampleCone(Vec2 u, float oneMinusCosMax) {
    const float oneMinusCos = u.x * oneMinusCosMax;
    const float sinTheta = std::sqrt(std::max(0.0f, oneMinusCos * (2.0f - oneMinusCos)));
    const Vec2 around = onUnitCircle(u.y) * sinTheta;
    return {around.x, around.y, 1.0f - oneMinusCos};
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
