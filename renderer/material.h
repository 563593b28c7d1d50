// Material: what a surface is made of.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "renderer/bsdf.h"
#include "renderer/texture.h"

namespace etendue {

struct Material {
    std::string name;
    std::unique_ptr<Bsdf> bsdf;
    /// The share of the surface that is there at all; empty: all of it. Where a ray meets the rest
    /// it goes on as if nothing had been there.
    std::optional<Texture> opacity;
    Spectrum emission;  // radiance, W/(sr m²)
    bool isEmissionTwoSided = false;
};

inline bool emits(const Material& m) { return !isBlack(m.emission); }

}  // namespace etendue
