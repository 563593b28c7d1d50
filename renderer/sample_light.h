// SampleLight: the light that one sample of the frame brings to a pixel, while it is added up.
#pragma once

#include <bit>
#include <cstdint>

#include "renderer/vec.h"

namespace etendue {

/// Three sums of floats, doubles rounded to their upper 48 bits: 37 bits of mantissa, so that n
/// terms are off by n · 2⁻³⁸ of the sum at most. A pixel may have all light paths of a frame, whose
/// terms may be equal: a float would be off by parts in a hundred at a million of them, and stop
/// growing at 2²⁴. Eighteen bytes side by side, since the pixel of a light path lies anywhere in
/// memory.
class [[gnu::packed]] SampleLight {
public:
    /// Adds three floats, finite and not negative. The sum depends on their order, in its last bit.
    void add(Vec3 light) {
        for (int k = 0; k < 3; ++k) store(k, load(k) + double{light[k]});
    }

    /// The nearest floats; infinite beyond their range.
    Vec3 value() const { return toFloat({load(0), load(1), load(2)}); }

    bool operator==(const SampleLight& other) const {
        for (int k = 0; k < 3; ++k)
            if (lower_[k] != other.lower_[k] || upper_[k] != other.upper_[k]) return false;
        return true;
    }

private:
    double load(int k) const {
        return std::bit_cast<double>(std::uint64_t{upper_[k]} << 48 | std::uint64_t{lower_[k]}
                                                                          << 16);
    }
    void store(int k, double sum) {
        const std::uint64_t kept =
            (std::bit_cast<std::uint64_t>(sum) + 0x8000) >> 16;  // the nearest
        lower_[k] = static_cast<std::uint32_t>(kept);
        upper_[k] = static_cast<std::uint16_t>(kept >> 32);
    }

    std::uint32_t lower_[3] = {};
    std::uint16_t upper_[3] = {};
};
static_assert(sizeof(SampleLight) == 18);

}  // namespace etendue
