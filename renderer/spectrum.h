// Spectrum: four lanes of light. In an RGB scene they are linear Rec. 709 R, G, B and 0; in a
// spectral scene each lane belongs to one of four hero wavelengths (Wilkie et al. 2014).
#pragma once

#include <array>
#include <cmath>

namespace etendue {

struct Spectrum {
    static constexpr int lanes = 4;
    alignas(16) std::array<float, lanes> lane{};

    constexpr Spectrum() = default;
    explicit constexpr Spectrum(float value) : lane{value, value, value, value} {}
    constexpr Spectrum(float a, float b, float c, float d) : lane{a, b, c, d} {}

    constexpr float operator[](int i) const { return lane[static_cast<std::size_t>(i)]; }
    constexpr float& operator[](int i) { return lane[static_cast<std::size_t>(i)]; }

    friend constexpr bool operator==(const Spectrum&, const Spectrum&) = default;

    constexpr Spectrum& operator+=(const Spectrum& b) {
        for (int i = 0; i < lanes; ++i) (*this)[i] += b[i];
        return *this;
    }
    constexpr Spectrum& operator-=(const Spectrum& b) {
        for (int i = 0; i < lanes; ++i) (*this)[i] -= b[i];
        return *this;
    }
    constexpr Spectrum& operator*=(const Spectrum& b) {
        for (int i = 0; i < lanes; ++i) (*this)[i] *= b[i];
        return *this;
    }
    constexpr Spectrum& operator/=(const Spectrum& b) {
        for (int i = 0; i < lanes; ++i) (*this)[i] /= b[i];
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
};

/// Linear Rec. 709 values in the first three lanes.
constexpr Spectrum rgb(float r, float g, float b) { return {r, g, b, 0.0f}; }

constexpr bool isBlack(const Spectrum& s) {
    for (const float v : s.lane)
        if (v != 0.0f) return false;
    return true;
}

inline bool isFinite(const Spectrum& s) {
    for (const float v : s.lane)
        if (!std::isfinite(v)) return false;
    return true;
}

constexpr float maxLane(const Spectrum& s) {
    float m = s[0];
    for (const float v : s.lane) m = v > m ? v : m;
    return m;
}

/// A scalar to choose by (light power, Russian roulette), not a colour measurement: the mean of the
/// lanes in use.
constexpr float brightness(const Spectrum& s) { return (s[0] + s[1] + s[2]) * (1.0f / 3.0f); }

/// The wavelengths that a path carries, one per lane. An RGB scene traces the lens and every
/// refraction at `rgbWavelengthNm`, in the middle of the visible range.
struct Wavelengths {
    static constexpr float rgbWavelengthNm = 550.0f;
    std::array<float, Spectrum::lanes> nm{rgbWavelengthNm, rgbWavelengthNm, rgbWavelengthNm,
                                          rgbWavelengthNm};

    constexpr float heroNm() const { return nm[0]; }
};

}  // namespace etendue
