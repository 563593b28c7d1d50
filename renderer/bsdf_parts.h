// What the BSDFs share.
#pragma once

#include <cmath>
#include <optional>

#include "renderer/bsdf.h"

namespace etendue {

/// A direction with |cosθ| at or below this lies in the surface and scatters nothing: BSDFs of
/// microfacets grow like 1 / cosθ there and would overflow.
inline constexpr float smallestCosine = 1e-18f;

inline bool isInSurface(Vec3 w) { return !(std::abs(w.z) > smallestCosine); }

/// Mirrored in the surface.
inline Vec3 flipped(Vec3 w) { return {w.x, w.y, -w.z}; }

/// The sample that drew `wi`, of which evaluate() says `value`. Empty where nothing is scattered.
inline std::optional<BsdfSample> continuousSample(Vec3 wi, const BsdfValue& value) {
    if (!(value.pdfSolidAngle > 0.0f) || !std::isfinite(value.pdfSolidAngle)) return std::nullopt;
    return BsdfSample{wi, value.f * (std::abs(wi.z) / value.pdfSolidAngle), value.pdfSolidAngle,
                      value.pdfSolidAngleReverse};
}

inline BsdfSample diracSample(Vec3 wi, const Spectrum& weight, float probability,
                              float probabilityReverse) {
    return {wi, weight, probability, probabilityReverse, true};
}

/// The direction of cosine `cosine` to +z that `u` puts round it.
inline Vec3 directionAround(float cosine, float u) {
    const float sine = std::sqrt(std::fmax(0.0f, (1.0f - cosine) * (1.0f + cosine)));
    const float phi = 2.0f * pi * u;
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

}  // namespace etendue
