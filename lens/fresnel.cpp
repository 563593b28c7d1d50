#include "lens/fresnel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {

namespace {

/// Amplitudes reflected, perpendicular and parallel to the plane of incidence.
struct Amplitudes {
    double s, p;
};

Amplitudes amplitudes(const Refraction& r) {
    const double fromFrom = r.indexFrom * r.cosFrom, toTo = r.indexTo * r.cosTo;
    const double toFrom = r.indexTo * r.cosFrom, fromTo = r.indexFrom * r.cosTo;
    return {(fromFrom - toTo) / (fromFrom + toTo), (toFrom - fromTo) / (toFrom + fromTo)};
}

/// Airy's sum over the reflections in the film: amplitudes at its two faces, and the cosine of the
/// phase gained by crossing it twice.
double filmReflectance(double first, double second, double cosPhase) {
    const double both = first * second, cross = 2.0 * both * cosPhase;
    return (first * first + second * second + cross) / (1.0 + both * both + cross);
}

}  // namespace

double reflectance(const Refraction& refraction) {
    const auto [s, p] = amplitudes(refraction);
    return 0.5 * (s * s + p * p);
}

double reflectance(const Refraction& refraction, const Coating& coating, double wavelengthNm) {
    const auto& [from, to, cosFrom, cosTo] = refraction;
    const double ratio = from / coating.index;
    // Zero only by rounding: the film is no rarer than the rarer side.
    const double cosFilm =
        std::sqrt(std::max(0.0, 1.0 - ratio * ratio * (1.0 - cosFrom * cosFrom)));
    const Amplitudes first = amplitudes({from, coating.index, cosFrom, cosFilm});
    const Amplitudes second = amplitudes({coating.index, to, cosFilm, cosTo});
    const double waves = coating.thicknessWaves * coating.designWavelengthNm / wavelengthNm;
    const double cosPhase = std::cos(4.0 * std::numbers::pi * waves * cosFilm);
    return 0.5 * (filmReflectance(first.s, second.s, cosPhase) +
                  filmReflectance(first.p, second.p, cosPhase));
}

}  // namespace etendue
