// ExactColor: a sum of colours that is the same bits in whatever order they come, as ExactSums are,
// and smaller: for the pictures of a film, where colours are never negative.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "renderer/vec.h"

namespace etendue {

/// Three sums, whole numbers of 77 bits in a unit that they share, a power of two: the least in
/// which the largest of them fits, and so the same in any order. A term is added without error as
/// long as its last bit is at least the unit: a float that is not below 2⁻⁵³ of the largest always
/// is. Thirty bytes side by side.
class [[gnu::packed]] ExactColor {
public:
    /// Adds three floats, finite and not negative. False if bits of one were below the unit, or of
    /// a sum when the unit had to grow, and are lost.
    bool add(float x, float y, float z) {
        const std::array<Float, 3> terms{decode(x), decode(y), decode(z)};
        const int largest =
            std::max({terms[0].exponent, terms[1].exponent, terms[2].exponent}) + floatBits;
        Sums sums = unpack();
        bool isExact = sums.growUnit(largest - sumBits);
        for (std::size_t k = 0; k < 3; ++k) {
            const int shift = terms[k].exponent - sums.unit;
            const Wide term{terms[k].mantissa};
            if (shift >= 0) [[likely]] {
                sums.of[k] += term << shift;
            } else {
                isExact &= isMultiple(term, -shift);
                sums.of[k] += shiftRight(term, -shift);
            }
        }
        isExact &= sums.makeFit();
        pack(sums);
        return isExact;
    }

    /// Adds another sum, as if by its terms.
    bool add(const ExactColor& other) {
        Sums sums = unpack(), others = other.unpack();
        bool isExact = sums.growUnit(others.unit);
        isExact &= others.growUnit(sums.unit);
        for (std::size_t k = 0; k < 3; ++k) sums.of[k] += others.of[k];
        isExact &= sums.makeFit();
        pack(sums);
        return isExact;
    }

    /// The nearest doubles.
    Vec3d value() const {
        const Sums sums = unpack();
        const double unit = std::ldexp(1.0, sums.unit + leastExponent);
        return Vec3d{static_cast<double>(sums.of[0]), static_cast<double>(sums.of[1]),
                     static_cast<double>(sums.of[2])} *
               unit;
    }

    /// Whether fewer than 2⁶⁴ floats can add up to it: what is read from a file may be anything.
    bool isPossible() const { return unpack().unit <= 128 + 64 - leastExponent - sumBits; }

    bool operator==(const ExactColor& other) const {
        for (int k = 0; k < 3; ++k)
            if (low_[k] != other.low_[k] || high_[k] != other.high_[k]) return false;
        return true;
    }

private:
    __extension__ using Wide = unsigned __int128;

    static constexpr int sumBits = 77;
    static constexpr int leastExponent = -149;  // of the least float; units count from it

    /// mantissa · 2^(exponent + leastExponent)
    struct Float {
        std::uint32_t mantissa;  // of 24 bits, or fewer where the exponent is 0
        int exponent;
    };
    static constexpr int floatBits = 24;
    static Float decode(float value) {
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(value) & 0x7fffffff;  // −0 is 0
        const std::uint32_t exponent = bits >> 23, isNormal = exponent > 0;
        return {(bits & 0x7fffff) | isNormal << 23, static_cast<int>(exponent - isNormal)};
    }

    static Wide shiftRight(Wide value, int bits) { return bits < 128 ? value >> bits : 0; }
    static bool isMultiple(Wide value, int bits) {  // of 2^bits
        return value == 0 || (bits < 128 && (value & ((Wide{1} << bits) - 1)) == 0);
    }

    struct Sums {
        std::array<Wide, 3> of;
        int unit;  // 2^(unit + leastExponent)

        /// To that one at least. False if a sum has bits below it, which are lost.
        bool growUnit(int to) {
            if (to <= unit) [[likely]]
                return true;
            bool isExact = true;
            for (Wide& sum : of) {
                isExact &= isMultiple(sum, to - unit);
                sum = shiftRight(sum, to - unit);
            }
            unit = to;
            return isExact;
        }
        /// After an addition. False as above.
        bool makeFit() {
            const bool fits = ((of[0] | of[1] | of[2]) >> sumBits) == 0;
            return fits || growUnit(unit + 1);
        }
    };

    // The upper 13 bits of each sum, and above all three the unit.
    static constexpr int highBits = sumBits - 64;
    Sums unpack() const {
        const std::uint64_t high =
            high_[0] | std::uint64_t{high_[1]} << 16 | std::uint64_t{high_[2]} << 32;
        const auto sum = [&](int k) {
            const std::uint64_t upper = high >> (k * highBits) & ((1u << highBits) - 1);
            return Wide{upper} << 64 | low_[k];
        };
        return {{sum(0), sum(1), sum(2)}, static_cast<int>(high >> (3 * highBits))};
    }
    void pack(const Sums& sums) {
        auto high = static_cast<std::uint64_t>(sums.unit) << (3 * highBits);
        for (int k = 0; k < 3; ++k) {
            const Wide& sum = sums.of[static_cast<std::size_t>(k)];
            low_[k] = static_cast<std::uint64_t>(sum);
            high |= static_cast<std::uint64_t>(sum >> 64) << (k * highBits);
        }
        for (int k = 0; k < 3; ++k) high_[k] = static_cast<std::uint16_t>(high >> (16 * k));
    }

    std::uint64_t low_[3] = {};
    std::uint16_t high_[3] = {};
};
static_assert(sizeof(ExactColor) == 30);

}  // namespace etendue
