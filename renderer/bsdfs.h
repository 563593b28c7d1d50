// The BSDFs, one .cpp each. Reflectances, tints and textures lie in [0, 1]; roughness too: it is
// the square root of GGX's α, and 0 (or α < smallestAlpha, ggx.h) is smooth.
//
// Diffuse, conductor and plastic are opaque and scatter alike on both sides. A dielectric has its
// medium on the back side: wo.z > 0 is outside. All conserve energy exactly: what single scattering
// between microfacets loses is given back (energy_compensation.h), so that white ones reflect (and,
// for the dielectric, transmit) all light.
#pragma once

#include <memory>

#include "renderer/bsdf.h"
#include "renderer/metals.h"
#include "renderer/texture.h"

namespace etendue {

/// Lambert's law.
std::unique_ptr<Bsdf> makeDiffuse(Texture reflectance);

/// A metal.
std::unique_ptr<Bsdf> makeConductor(const ConductorOptics& optics, float roughness);
/// The same surface made of facets that reflect `reflectance` at every angle; white loses nothing.
std::unique_ptr<Bsdf> makeConductor(const Spectrum& reflectance, float roughness);

/// `ior`: index inside over that outside; may be below 1, and 1 is no surface at all. `tint` is
/// what one crossing leaves of refracted light; reflections are not coloured. Smooth too where α
/// |ior − 1| < smallestAlpha: light goes nearly straight through, and its direction no longer says
/// which microfacet refracted it.
std::unique_ptr<Bsdf> makeDielectric(float ior, const Spectrum& tint, float roughness);

/// The same, smooth, of a glass whose index falls with the wavelength: `ior` at the d line, and
/// Abbe's number (n_d − 1) / (n_F − n_C), positive. In an RGB scene it does not disperse.
std::unique_ptr<Bsdf> makeDispersiveDielectric(float ior, float abbeNumber, const Spectrum& tint);

/// A diffuse base under a coat of dielectric; light that the coat lets in bounces between the two
/// until it leaves, and is coloured by `diffuse` each time.
std::unique_ptr<Bsdf> makePlastic(Texture diffuse, float ior, float roughness);

}  // namespace etendue
