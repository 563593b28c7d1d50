// LightTable: the lights of a scene, and the choice of one of them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "renderer/distribution.h"
#include "renderer/light.h"

namespace etendue {

struct LightChoice {
    int index;
    float probability;  // positive
    float remainder;    // the random number remapped, uniform in [0, 1)
};

/// Lights are chosen in proportion to their power, those at infinity and the others each with half
/// of the probability if there are both; a light of zero power never is.
class LightTable {
public:
    explicit LightTable(std::vector<std::unique_ptr<Light>> lights);

    /// `u` in [0, 1). Empty when no light has power.
    std::optional<LightChoice> sample(float u) const {
        const auto chosen = choice_.sample(u);
        if (!chosen) return {};
        return LightChoice{static_cast<int>(chosen->index), static_cast<float>(chosen->probability),
                           unitFloat(chosen->remainder)};
    }
    /// With which sample() chooses that light.
    float probability(int index) const;

    const Light& operator[](int index) const { return *lights_[static_cast<std::size_t>(index)]; }
    int size() const { return static_cast<int>(lights_.size()); }
    /// Indices of the lights that a ray meets when it leaves the scene.
    std::span<const int> infiniteLights() const { return infiniteLights_; }

private:
    std::vector<std::unique_ptr<Light>> lights_;
    std::vector<int> infiniteLights_;
    Distribution1D choice_;
};

}  // namespace etendue
