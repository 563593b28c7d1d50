// Scattering at a surface point, in world space: the step between the walk and the Bsdf, shared by
// every estimator.
#pragma once

#include <optional>

#include "renderer/bsdf.h"
#include "renderer/material.h"
#include "renderer/surface_point.h"

namespace etendue {

/// The shading normal only shapes the light; which side a direction lies on is for the geometric
/// normal to say (Veach 1997, §5.3). A pair of directions on which the two disagree scatters
/// nothing.
inline bool sidesAgree(const SurfacePoint& point, Vec3 direction, float localZ) {
    return dot(point.geometricNormal, direction) * localZ > 0.0f;
}

/// Veach's factor for the light's side of a path on which shading and geometric normal differ:
/// importance scatters by the adjoint of the Bsdf (Veach 1997, §5.3, equation 5.19). 1 for
/// radiance. `wo` and `wi` in world space, `localWo` and `localWi` the same in the shading frame.
inline float shadingNormalFactor(const SurfacePoint& point, Transport transport, Vec3 wo,
                                 Vec3 localWo, Vec3 wi, Vec3 localWi) {
    if (transport == Transport::radiance) return 1.0f;
    const float numerator = std::abs(localWo.z) * absDot(point.geometricNormal, wi);
    const float denominator = absDot(point.geometricNormal, wo) * std::abs(localWi.z);
    return numerator / denominator;
}

struct Scattering {
    Spectrum value;  // f |cosθi|; under Transport::importance times shadingNormalFactor
    float pdfSolidAngle = 0.0f, pdfSolidAngleReverse = 0.0f;
};

/// The continuous part from `wo` to `wi`, both world, unit, away from the surface.
inline Scattering scatteringBetween(const SurfacePoint& point, const BsdfContext& context, Vec3 wo,
                                    Vec3 wi) {
    const Vec3 localWo = point.shading.localFromWorld(wo),
               localWi = point.shading.localFromWorld(wi);
    if (!sidesAgree(point, wo, localWo.z) || !sidesAgree(point, wi, localWi.z)) return {};
    const BsdfValue v = point.material->bsdf->evaluate(context, localWo, localWi);
    const float factor = shadingNormalFactor(point, context.transport, wo, localWo, wi, localWi);
    return {v.f * (std::abs(localWi.z) * factor), v.pdfSolidAngle, v.pdfSolidAngleReverse};
}

/// A direction to go on in; its `wi` is in world space. Empty when the walk ends here.
inline std::optional<BsdfSample> sampleScattering(const SurfacePoint& point,
                                                  const BsdfContext& context, Vec3 wo, float uLobe,
                                                  Vec2 u) {
    const Vec3 localWo = point.shading.localFromWorld(wo);
    if (!sidesAgree(point, wo, localWo.z)) return std::nullopt;
    const std::optional<BsdfSample> sample =
        point.material->bsdf->sample(context, localWo, uLobe, u);
    if (!sample) return std::nullopt;
    const Vec3 wi = renormalize(point.shading.worldFromLocal(sample->wi));
    if (!sidesAgree(point, wi, sample->wi.z)) return std::nullopt;
    const float factor = shadingNormalFactor(point, context.transport, wo, localWo, wi, sample->wi);
    return BsdfSample{wi,
                      sample->weight * factor,
                      sample->pdfSolidAngle,
                      sample->pdfSolidAngleReverse,
                      sample->isDirac,
                      sample->isHeroOnly};
}

}  // namespace etendue
