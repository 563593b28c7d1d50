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

struct Scattering {
    Spectrum value;  // f |cosθi|
    float pdfSolidAngle = 0.0f, pdfSolidAngleReverse = 0.0f;
};

/// The continuous part from `wo` to `wi`, both world, unit, away from the surface.
inline Scattering scatteringBetween(const SurfacePoint& point, const BsdfContext& context, Vec3 wo,
                                    Vec3 wi) {
    const Vec3 localWo = point.shading.localFromWorld(wo),
               localWi = point.shading.localFromWorld(wi);
    if (!sidesAgree(point, wo, localWo.z) || !sidesAgree(point, wi, localWi.z)) return {};
    const BsdfValue v = point.material->bsdf->evaluate(context, localWo, localWi);
    return {v.f * std::abs(localWi.z), v.pdfSolidAngle, v.pdfSolidAngleReverse};
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
    return BsdfSample{wi, sample->weight, sample->pdfSolidAngle, sample->pdfSolidAngleReverse,
                      sample->isDirac};
}

}  // namespace etendue
