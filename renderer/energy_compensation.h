// The energy that a rough surface of microfacets loses when light that meets a second microfacet is
// dropped, and the lobe that gives it back (Kulla and Conty 2017, "Revisiting Physically Based
// Shading at Imageworks"; Kelemen and Szirmay-Kalos 2001).
//
// With E(μ) the share that single scattering keeps of light incident at cosine μ, the lobe
//
//     f(μo, μi) = (1 − E(μo)) (1 − E(μi)) / (π (1 − Eavg)),     Eavg = 2 ∫ E(μ) μ dμ
//
// is reciprocal and scatters exactly 1 − E(μo).
#pragma once

#include "renderer/energy_table.h"
#include "renderer/spectrum.h"

namespace etendue {

/// 1 − E(μ) of a GGX surface that reflects everything. 0 < μ ≤ 1; absolute error below 1e-5 (as of
/// the two below).
double reflectorLoss(double mu, double alpha);

/// 1 − E(μ) of a GGX dielectric that reflects and refracts; `eta` is the index beyond the surface
/// over that on the incident side.
double dielectricLoss(double mu, double alpha, double eta);

/// What a GGX dielectric does not reflect by single scattering: all that a coat of it lets through.
double coatTransmittance(double mu, double alpha, double eta);

/// Their tables.
EnergyTable reflectorLossTable(double alpha);
EnergyTable dielectricLossTable(double alpha, double eta);
EnergyTable coatTransmittanceTable(double alpha, double eta);

/// The colour of light that has met at least two microfacets: Favg² Eavg / (1 − Favg (1 − Eavg)),
/// per lane, for a surface that reflects Favg on average and keeps Eavg = 1 − `averageLoss`.
Spectrum multipleScatteringColor(const Spectrum& averageReflectance, float averageLoss);

/// How a dielectric divides between its two sides what its compensation gives back. With a = 1 −
/// Eavg seen from each side, any shares for which n² a share is equal on both sides make the lobe
/// reciprocal. These are the mean Fresnel transmittances, for which n² transmittance is equal, each
/// times the far side's a over the larger of the two.
struct TransmittedShares {
    float outside, inside;  // of the light that came from there
};
TransmittedShares compensationShares(double ior, float averageLossOutside, float averageLossInside);

}  // namespace etendue
