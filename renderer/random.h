// Counter-based random numbers: the same (seed, stream, sample, dimension) gives the same number on
// any machine, in any order, on any number of threads. Philox 4x32-7, Salmon et al. 2011,
// "Parallel Random Numbers: As Easy as 1, 2, 3"; or Sobol' points that it scrambles (sobol.h).
#pragma once

#include <array>
#include <cstdint>

#include "renderer/sobol.h"
#include "renderer/vec.h"

namespace etendue {

using PhiloxBlock = std::array<std::uint32_t, 4>;

/// One keyed bijection of the 128-bit counter. Seven rounds are the fewest that pass all of
/// TestU01's BigCrush (Salmon et al. 2011, table 2).
template <int rounds = 7>
constexpr PhiloxBlock philox(PhiloxBlock counter, std::uint32_t key0, std::uint32_t key1) {
    for (int round = 0; round < rounds; ++round) {
        const std::uint64_t a = std::uint64_t{0xD2511F53u} * counter[0];
        const std::uint64_t b = std::uint64_t{0xCD9E8D57u} * counter[2];
        counter = {
            static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key0, static_cast<std::uint32_t>(b),
            static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key1, static_cast<std::uint32_t>(a)};
        key0 += 0x9E3779B9u;
        key1 += 0xBB67AE85u;
    }
    return counter;
}

/// A float in [0, 1): 32 random bits, never rounded up to 1.
constexpr float uniformFloat(std::uint32_t bits) {
    constexpr float oneBelowOne = 0x1.fffffep-1f;
    const float u = static_cast<float>(bits) * 0x1p-32f;
    return u < oneBelowOne ? u : oneBelowOne;
}

/// What a stream of numbers is used for, so that camera and light paths of equal index are
/// independent.
enum class RandomDomain : std::uint32_t { cameraPath = 0, lightPath = 1, test = 2, wavelength = 3 };

/// How the numbers of one sample go with those of the others.
enum class Sampler {
    independent,
    sobol,  // stratified together, in the first sobolDimensions numbers of each
};

/// The numbers of one path, dimension after dimension.
class RandomStream {
public:
    /// Independent ones. `index` is the pixel's index, `sample` that of the pixel's sample or light
    /// path, below 2⁵⁶.
    constexpr RandomStream(std::uint64_t seed, std::uint32_t index, std::uint64_t sample,
                           RandomDomain domain = RandomDomain::cameraPath)
        : key0_(static_cast<std::uint32_t>(seed)),
          key1_(static_cast<std::uint32_t>(seed >> 32)),
          counter_{0, static_cast<std::uint32_t>(sample), index,
                   static_cast<std::uint32_t>(domain) |
                       static_cast<std::uint32_t>(sample >> 32 << domainBits)} {}

    /// Point number `point` of a Sobol' sequence; those of each `sequence` and seed are scrambled
    /// by themselves. After sobolDimensions numbers the stream goes on as `independent`, which must
    /// be fresh and of the same seed and domain, and of one upper half of its sample in all points
    /// of a sequence.
    RandomStream(const RandomStream& independent, std::uint32_t sequence, std::uint32_t point)
        : RandomStream(independent) {
        sample_ = counter_[1];
        index_ = counter_[2];
        counter_[1] = ~0u;  // one path at most has this number, and later blocks
        counter_[2] = sequence;
        // The order of the points, shuffled in the nested way that keeps them stratified, so that
        // domains with the same point number are independent.
        point_ = owenScrambled(point, nextBits());
        dimension_ = 0;
    }

    std::uint32_t nextBits() {
        if (dimension_ < sobolDimensions) {
            const std::uint32_t scramble = nextIndependentBits();
            const std::uint32_t bits = owenScrambled(sobolBits(point_, dimension_), scramble);
            if (++dimension_ == sobolDimensions) {
                counter_ = {counter_[0], sample_, index_, counter_[3]};
                used_ = 4;
            }
            return bits;
        }
        return nextIndependentBits();
    }
    float next() { return uniformFloat(nextBits()); }
    Vec2 next2() {
        const float x = next();
        return {x, next()};
    }

private:
    static constexpr int domainBits = 8;

    constexpr std::uint32_t nextIndependentBits() {
        if (used_ == 4) {
            block_ = philox(counter_, key0_, key1_);
            ++counter_[0];
            used_ = 0;
        }
        return block_[used_++];
    }

    std::uint32_t key0_, key1_;
    PhiloxBlock counter_;
    PhiloxBlock block_{};
    std::uint32_t used_ = 4;
    std::uint32_t dimension_ = sobolDimensions;  // from there on numbers are independent
    std::uint32_t point_ = 0, sample_ = 0, index_ = 0;
};

}  // namespace etendue
