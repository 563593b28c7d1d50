#include "renderer/ggx.h"

namespace etendue {

Vec3 Ggx::sampleVisibleNormal(Vec3 wo, Vec2 u) const {
    // In stretched space the surface is a hemisphere of mirrors; what it reflects is uniform on the
    // cap z > −wo.z of the sphere, and the normal is the half vector.
    const Vec3 stretched = normalize(Vec3{alpha_ * wo.x, alpha_ * wo.y, wo.z});
    const float phi = 2.0f * pi * u.x;
    const float depth = u.y * (1.0f + stretched.z);  // 1 − z of the reflected direction
    const float sinTheta = std::sqrt(std::max(0.0f, depth * (2.0f - depth)));
    const Vec3 half = {sinTheta * std::cos(phi) + stretched.x,
                       sinTheta * std::sin(phi) + stretched.y, (1.0f - u.y) * (1.0f + stretched.z)};
    return normalize(Vec3{alpha_ * half.x, alpha_ * half.y, half.z});
}

namespace {

// The square of a length below which its square could underflow.
constexpr float shortestSquared = 1e-30f;

}  // namespace

std::optional<Microfacet> reflectingMicrofacet(Vec3 wo, Vec3 wi) {
    const Vec3 half = wo + wi;
    const float squared = lengthSquared(half);
    if (!(squared > shortestSquared)) return std::nullopt;
    const float halfLength = std::sqrt(squared);
    // Half the sum of unit vectors is as long as the cosine, and the same whichever comes first.
    const float cosine = std::min(0.5f * halfLength, 1.0f);
    return Microfacet{half / halfLength, cosine, cosine, 0.25f, 0.25f};
}

std::optional<Microfacet> refractingMicrofacet(Vec3 wo, Vec3 wi, float eta) {
    // Snell's law says that wo + η wi is normal to the microfacet, pointing to the thinner side.
    const Vec3 half = wo + wi * eta;
    const float squared = lengthSquared(half);
    if (!(squared > shortestSquared)) return std::nullopt;
    const Vec3 m = half / std::copysign(std::sqrt(squared), half.z);
    const float cosineO = dot(wo, m), cosineI = -dot(wi, m);
    if (!(cosineO > 0.0f && cosineI > 0.0f)) return std::nullopt;
    const float reverse = cosineO * cosineI / squared;
    return Microfacet{m, std::min(cosineO, 1.0f), std::min(cosineI, 1.0f), reverse * eta * eta,
                      reverse};
}

}  // namespace etendue
