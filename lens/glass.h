// Glass: the refractive index of a medium against wavelength, relative to air at 20 °C, whose own
// index counts as exactly 1.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace etendue {

/// Wavelengths at which lenses are computed. Beyond them nothing is transmitted.
constexpr double shortestWavelengthNm = 350.0, longestWavelengthNm = 1100.0;

/// Fraunhofer's lines by which glass is named: helium d, hydrogen F and C, mercury g.
constexpr double dLineNm = 587.5618, fLineNm = 486.1327, cLineNm = 656.2725, gLineNm = 435.8343;

struct Air {};

/// n = a + b/λ + c/λ^3.5, λ in µm (Conrady, Applied Optics and Optical Design, 1929).
struct ConradyGlass {
    double a, b, c;
};

/// n² = 1 + Σ bᵢ λ²/(λ² − cᵢ), λ in µm, cᵢ in µm².
struct SellmeierGlass {
    std::array<double, 3> b, c;
};

using Glass = std::variant<Air, ConradyGlass, SellmeierGlass>;

/// The glass of index nd at the d line and Abbe number vd = (nd − 1)/(nF − nC). Two numbers leave
/// the curvature of the dispersion open: it is taken from the line of normal glasses,
/// PgF = (ng − nF)/(nF − nC) = 0.6438 − 0.001682 vd (Schott, TIE-29). Over the catalogue the index
/// is then off by 3e-4 in the median and 5e-3 at the worst (dense flints at 400 nm) in 400–700 nm.
ConradyGlass glassFromAbbeNumber(double nd, double vd);

/// `name` as its maker writes it ("N-BK7", "S-LAH58", "fused-silica"). Throws
/// std::invalid_argument, naming the nearest, when the catalogue has no such glass.
SellmeierGlass glassFromCatalogue(std::string_view name);
std::vector<std::string> catalogueGlassNames();

double refractiveIndex(const Glass& glass, double wavelengthNm);
/// vd; infinite for air.
double abbeNumber(const Glass& glass);

/// Whether over 350–1100 nm the index is a number, at least 1, and never rises toward the red.
bool isPlausible(const Glass& glass);

}  // namespace etendue
