// Bsdf: how a surface scatters. All directions are unit, in the local shading frame (+z = shading
// normal, on the surface's front side) and point away from the surface.
//
// `wo` is the direction the walk came from, `wi` the direction it goes on to. Under
// Transport::radiance the walk started at the camera and wi looks for light; under
// Transport::importance it started at a light. They differ by the squared ratio of refractive
// indices where light is refracted (Veach 1997, §5.2), and in nothing else.
//
// A Bsdf may mix Dirac lobes (mirror, smooth glass) with a continuous part. evaluate() speaks of
// the continuous part alone; its densities include the probability that the continuous part is
// chosen.
#pragma once

#include <memory>
#include <optional>

#include "renderer/spectrum.h"
#include "renderer/vec.h"
#include "renderer/wavelengths.h"

namespace etendue {

enum class Transport { radiance, importance };

struct BsdfContext {
    Vec2 uv;
    Transport transport = Transport::radiance;
    const Wavelengths& wavelengths = rgbWavelengths;  // not owned: a path has them once
};

struct BsdfValue {
    Spectrum f;                  // 1/sr, without the cosine
    float pdfSolidAngle = 0.0f;  // of drawing wi from wo
    float pdfSolidAngleReverse =
        0.0f;  // of drawing wo from wi (the walk reversed, so transport too)
};

struct BsdfSample {
    Vec3 wi;
    Spectrum weight;  // f |cosθi| / pdfSolidAngle
    float pdfSolidAngle =
        0.0f;  // of the continuous part; of a Dirac lobe: its probability, no density
    float pdfSolidAngleReverse = 0.0f;  // likewise, for the walk reversed
    bool isDirac = false;
    bool isHeroOnly = false;  // the direction is the hero wavelength's; the others go elsewhere
};

class Bsdf {
public:
    virtual ~Bsdf() = default;

    /// The continuous part. Zero where it does not scatter (and for a Bsdf of Dirac lobes only).
    virtual BsdfValue evaluate(const BsdfContext&, Vec3 wo, Vec3 wi) const = 0;

    /// Empty when the light is absorbed or the microfacet sends it below the surface: the walk
    /// ends, and its contribution is zero. `uLobe` and `u` are uniform in [0, 1).
    virtual std::optional<BsdfSample> sample(const BsdfContext&, Vec3 wo, float uLobe,
                                             Vec2 u) const = 0;

    /// True when there is no continuous part, so that no connection can be made to this surface.
    virtual bool isDirac() const = 0;
    /// Whether it scatters to the other side; else wo and wi lie on the same one.
    virtual bool isTransmitting() const = 0;

    /// Directional-hemispherical reflectance, roughly, for the albedo image.
    virtual Spectrum albedo(const BsdfContext&) const = 0;
};

}  // namespace etendue
