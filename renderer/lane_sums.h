// LaneSums: what a camera path splats, wavelength by wavelength.
#pragma once

#include <array>
#include <span>
#include <stdexcept>

#include "renderer/estimator.h"

namespace etendue {

/// What all techniques of one camera path splat: each of its wavelengths lands in one place.
class LaneSums {
public:
    void add(const Contribution& c) {
        std::size_t lane = 0;
        while (lane < count_ && !(sums_[lane].film == c.film)) ++lane;
        if (lane == count_) {
            if (count_ == sums_.size())
                throw std::logic_error("lane sums: a camera path lands in more places than lanes");
            sums_[count_++] = {.technique = {}, .value = {}, .film = c.film, .isSplat = true};
        }
        sums_[lane].value += c.value * c.weight;
    }
    std::span<const Contribution> sums() const { return std::span(sums_).first(count_); }

private:
    std::array<Contribution, Spectrum::lanes> sums_;
    std::size_t count_ = 0;
};

}  // namespace etendue
