// Ggx: the isotropic GGX distribution of microfacet normals (Walter et al. 2007, "Microfacet Models
// for Refraction through Rough Surfaces") with Smith's height-correlated masking (Heitz 2014).
//
// Directions are unit and local (+z = normal of the surface), on whichever side; sines and cosines
// are taken from their components, so that nothing cancels or overflows however smooth the surface
// or grazing the direction.
#pragma once

#include <cmath>
#include <optional>

#include "renderer/vec.h"

namespace etendue {

/// The roughness that scenes speak of is the square root of GGX's α.
constexpr float alphaFromRoughness(float roughness) { return roughness * roughness; }

/// Below this the surface counts as smooth: a float direction that has been through world space no
/// longer says which microfacet it met (the density is 1 % off in the mean here, and 10 % at a
/// tenth of it; ggx_test.cpp measures it). It is a roughness of 0.0032.
inline constexpr float smallestAlpha = 1e-5f;

class Ggx {
public:
    /// `alpha` in [smallestAlpha, 1].
    explicit Ggx(float alpha)
        : alpha_(alpha),
          inverseAlphaSquared_(1.0f / (alpha * alpha)),
          peak_(inversePi * inverseAlphaSquared_) {}

    /// D(m), 1/sr, for m.z > 0.
    float density(Vec3 m) const {
        const float e = m.z * m.z + (m.x * m.x + m.y * m.y) * inverseAlphaSquared_;
        return peak_ / (e * e);
    }

    /// |cosθ| (1 + 2Λ) = √(cos²θ + α² sin²θ): the length of `v` in the space that stretches the
    /// surface to unit roughness.
    float stretchedLength(Vec3 v) const {
        return std::sqrt(v.z * v.z + alpha_ * alpha_ * (v.x * v.x + v.y * v.y));
    }

    /// G₁(v) / |cosθ|.
    float g1OverCosine(Vec3 v) const { return 2.0f / (std::abs(v.z) + stretchedLength(v)); }

    /// G₂(wo, wi) / |cosθo cosθi|, height-correlated. The formula is the same where wi is
    /// refracted.
    float g2OverCosines(Vec3 wo, Vec3 wi) const {
        return 2.0f / (std::abs(wo.z) * stretchedLength(wi) + std::abs(wi.z) * stretchedLength(wo));
    }

    /// A microfacet normal as seen from `wo`, wo.z > 0: density G₁(wo) max(0, wo·m) D(m) / wo.z
    /// (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps").
    Vec3 sampleVisibleNormal(Vec3 wo, Vec2 u) const;

private:
    float alpha_, inverseAlphaSquared_, peak_;
};

/// The microfacet that carries light between two directions, with everything about it but its
/// orientation's density D:
///
///     f = F D transfer G₂ / |cosθo cosθi|,        pdfSolidAngle of wi = F D transfer G₁(wo) /
///     |cosθo|
///
/// F being the share of the light that goes this way. transfer = wo·m dωm/dωi (Walter et al. 2007,
/// eqs. 14 and 17); transferReverse is the same for the walk reversed. They differ by the squared
/// ratio of the refractive indices: f is that of light travelling from wo to wi with the first, and
/// from wi to wo with the second.
struct Microfacet {
    Vec3 normal;             // unit, on the side of wo
    float cosineO, cosineI;  // |wo·m|, |wi·m|, in (0, 1]
    float transfer, transferReverse;
};

/// wo.z and wi.z both positive. Empty where the half vector is too short to have a direction.
std::optional<Microfacet> reflectingMicrofacet(Vec3 wo, Vec3 wi);

/// wo.z > 0 > wi.z; `eta` is the index on wi's side over that on wo's. Empty when no microfacet on
/// this surface refracts the one into the other.
std::optional<Microfacet> refractingMicrofacet(Vec3 wo, Vec3 wi, float eta);

inline Vec3 reflect(Vec3 wo, Vec3 m) { return m * (2.0f * dot(wo, m)) - wo; }

/// `cosine` = wo·m, `cosTransmitted` from fresnelDielectric.
inline Vec3 refract(Vec3 wo, Vec3 m, float eta, float cosine, float cosTransmitted) {
    return m * (cosine / eta - cosTransmitted) - wo / eta;
}

}  // namespace etendue
