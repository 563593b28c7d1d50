// Spectrum: four lanes of light. In an RGB scene they are linear Rec. 709 R, G, B and 0; in a
// spectral scene each lane belongs to one of four hero wavelengths (Wilkie et al. 2014).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace etendue {

class Spectrum {
public:
    static constexpr int lanes = 4;

    constexpr Spectrum() = default;
    explicit constexpr Spectrum(float value) : lane_{value, value, value, value} {}
    constexpr Spectrum(float a, float b, float c, float d) : lane_{a, b, c, d} {}

    /// value(0) … value(3).
    template <class Value>
    static constexpr Spectrum fromLanes(const Value& value) {
        return {value(0), value(1), value(2), value(3)};
    }

    float operator[](int i) const { return lane_[i]; }

    friend bool operator==(const Spectrum& a, const Spectrum& b) {
        // All bits are set in the lanes that are equal.
        const auto equal = std::bit_cast<std::array<std::uint64_t, 2>>(a.lane_ == b.lane_);
        return (equal[0] & equal[1]) == ~std::uint64_t{0};
    }

    constexpr Spectrum& operator+=(const Spectrum& b) {
        lane_ = lane_ + b.lane_;
        return *this;
    }
    constexpr Spectrum& operator-=(const Spectrum& b) {
        lane_ = lane_ - b.lane_;
        return *this;
    }
    constexpr Spectrum& operator*=(const Spectrum& b) {
        lane_ = lane_ * b.lane_;
        return *this;
    }
    constexpr Spectrum& operator/=(const Spectrum& b) {
        lane_ = lane_ / b.lane_;
        return *this;
    }
    constexpr Spectrum& operator*=(float k) { return *this *= Spectrum(k); }
    constexpr Spectrum& operator/=(float k) { return *this *= Spectrum(1.0f / k); }

    friend constexpr Spectrum operator+(Spectrum a, const Spectrum& b) { return a += b; }
    friend constexpr Spectrum operator-(Spectrum a, const Spectrum& b) { return a -= b; }
    friend constexpr Spectrum operator*(Spectrum a, const Spectrum& b) { return a *= b; }
    friend constexpr Spectrum operator/(Spectrum a, const Spectrum& b) { return a /= b; }
    friend constexpr Spectrum operator*(Spectrum a, float k) { return a *= k; }
    friend constexpr Spectrum operator*(float k, Spectrum a) { return a *= k; }
    friend constexpr Spectrum operator/(Spectrum a, float k) { return a /= k; }

private:
    // A vector of GCC and Clang, which functions take and return in one register: an array of four
    // comes back in two halves that have to meet in memory first.
    float __attribute__((vector_size(16))) lane_{};
};

/// Linear Rec. 709 values in the first three lanes.
constexpr Spectrum rgb(float r, float g, float b) { return {r, g, b, 0.0f}; }

inline bool isBlack(const Spectrum& s) { return s == Spectrum(); }

inline bool isFinite(const Spectrum& s) {
    return std::isfinite(s[0]) && std::isfinite(s[1]) && std::isfinite(s[2]) && std::isfinite(s[3]);
}

inline float maxLane(const Spectrum& s) {
    return std::max(std::max(s[0], s[1]), std::max(s[2], s[3]));
}

/// The first lane, the hero's, standing for as many as it does.
inline Spectrum heroAlone(const Spectrum& s, float standsFor = Spectrum::lanes) {
    return {standsFor * s[0], 0.0f, 0.0f, 0.0f};
}

/// A scalar to choose by (light power, Russian roulette), not a colour measurement: the mean of the
/// lanes in use.
inline float brightness(const Spectrum& s) { return (s[0] + s[1] + s[2]) * (1.0f / 3.0f); }

}  // namespace etendue
