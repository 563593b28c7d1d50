// Wavelengths: the four that a path carries, one per lane of its Spectrum, and what they make of
// colours given as RGB (docs/spectral.md).
#pragma once

#include <array>

#include "renderer/spectrum.h"

namespace etendue {

/// Of an RGB scene by default: its lanes are R, G, B and 0, and whatever needs a wavelength takes
/// `rgbWavelengthNm`, in the middle of the visible range.
struct Wavelengths {
    static constexpr float rgbWavelengthNm = 550.0f;
    static constexpr float shortestNm = 400.0f, longestNm = 700.0f;

    std::array<float, Spectrum::lanes> nm{rgbWavelengthNm, rgbWavelengthNm, rgbWavelengthNm,
                                          rgbWavelengthNm};
    /// The spectra of Rec. 709's primaries at these wavelengths; unused in an RGB scene.
    std::array<Spectrum, 3> primaries{};
    bool isSpectral = false;

    constexpr float heroNm() const { return nm[0]; }

    /// A colour, in linear Rec. 709, as lanes: a reflectance, or radiance relative to D65's.
    Spectrum lanesOf(const Spectrum& rgb) const {
        if (!isSpectral) return rgb;
        return primaries[0] * rgb[0] + primaries[1] * rgb[1] + primaries[2] * rgb[2];
    }
};

/// Those of any RGB scene.
inline const Wavelengths rgbWavelengths{};

/// The wavelengths of one sample of a picture, and how the film sees them.
struct SpectralSample {
    Wavelengths wavelengths;
    /// The film's responses, X, Y and Z, at each wavelength, over the density of drawing it.
    std::array<Spectrum, 3> xyz{};

    /// What the film adds up: the RGB lanes themselves, or X, Y, Z and 0.
    Spectrum onFilm(const Spectrum& lanes) const;
    /// The same of one lane of a spectral render, the others black.
    Spectrum onFilm(std::size_t lane, float value) const {
        const auto response = [&](std::size_t i) {
            return value * xyz[i][static_cast<int>(lane)] * (1.0f / Spectrum::lanes);
        };
        return {response(0), response(1), response(2), 0.0f};
    }
};

/// Four wavelengths a quarter of the visible range apart (Wilkie et al. 2014, "Hero Wavelength
/// Spectral Sampling"), the first uniform for uniform `u`. The film's response to D65 is that of
/// Rec. 709's white.
SpectralSample sampleWavelengths(float u);

}  // namespace etendue
