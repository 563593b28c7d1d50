// Fresnel's equations for unpolarised light, exact. Cosines are of the angle to the surface's
// normal and positive.
#pragma once

#include <algorithm>
#include <cmath>

#include "renderer/spectrum.h"

namespace etendue {

template <class T>
struct DielectricFresnel {
    T reflectance;     // in [0, 1]; the rest is refracted
    T cosTransmitted;  // positive; 0 where all is reflected
};

/// `eta` is the refractive index beyond the surface over that on the side the light comes from.
/// `cosIncident` in (0, 1].
template <class T>
DielectricFresnel<T> fresnelDielectric(T cosIncident, T eta) {
    // (η cosθt)² as a sum that does not cancel; it is cos²θi exactly for η = 1.
    const T projectedSquared = (eta - 1) * (eta + 1) + cosIncident * cosIncident;
    if (projectedSquared <= 0) return {T(1), T(0)};
    const T projected = std::sqrt(projectedSquared);
    const T perpendicular = (cosIncident - projected) / (cosIncident + projected);
    const T parallel =
        (eta * eta * cosIncident - projected) / (eta * eta * cosIncident + projected);
    return {T(0.5) * (perpendicular * perpendicular + parallel * parallel),
            std::min(projected / eta, T(1))};
}

/// One minus the reflectance, where both cosines are known by Snell's law: nothing cancels, and for
/// the ray reversed it is the same to rounding.
template <class T>
T dielectricTransmittance(T cosIncident, T cosTransmitted, T eta) {
    const T perpendicular = cosIncident + eta * cosTransmitted;
    const T parallel = eta * cosIncident + cosTransmitted;
    return T(2) * eta * cosIncident * cosTransmitted *
           (T(1) / (perpendicular * perpendicular) + T(1) / (parallel * parallel));
}

/// The mean over cosine-weighted directions, 2 ∫ F(μ) μ dμ.
double fresnelDielectricAverage(double eta);

/// A metal in air: complex refractive index η + i k, per lane. η > 0, k ≥ 0.
struct ConductorOptics {
    Spectrum eta, k;
};

float fresnelConductor(float cosIncident, float eta, float k);
Spectrum fresnelConductor(float cosIncident, const ConductorOptics& optics);
Spectrum fresnelConductorAverage(const ConductorOptics& optics);

}  // namespace etendue
