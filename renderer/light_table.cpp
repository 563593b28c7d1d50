#include "renderer/light_table.h"

#include <limits>

namespace etendue {

LightTable::LightTable(std::vector<std::unique_ptr<Light>> lights) : lights_(std::move(lights)) {
    std::vector<double> weights;
    double finitePower = 0.0, infinitePower = 0.0;
    for (int i = 0; i < size(); ++i) {
        const Light& light = (*this)[i];
        // A power past the range of float still only means "the brightest by far".
        weights.push_back(std::min(light.power(), std::numeric_limits<float>::max()));
        if (light.isInfinite()) infiniteLights_.push_back(i);
        (light.isInfinite() ? infinitePower : finitePower) += weights.back();
    }
    // What a light at infinity sends into the scene grows with the scene's size, whatever it is
    // worth at any one place; half of the choices are kept for the lights that have a place.
    if (finitePower > 0.0 && infinitePower > 0.0)
        for (const int i : infiniteLights_)
            weights[static_cast<std::size_t>(i)] *= finitePower / infinitePower;
    choice_ = Distribution1D(weights);
}

float LightTable::probability(int index) const {
    return static_cast<float>(choice_.probability(static_cast<std::size_t>(index)));
}

}  // namespace etendue
