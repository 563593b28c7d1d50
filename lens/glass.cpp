#include "lens/glass.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "config/config.h"
#include "lens/glass_catalogue.h"

namespace etendue {

namespace {

constexpr double micrometres(double wavelengthNm) { return 1e-3 * wavelengthNm; }

double indexOf(const Air& /*air*/, double /*micrometres*/) { return 1.0; }

double indexOf(const ConradyGlass& glass, double wavelength) {
    const double inverse = 1.0 / wavelength;
    return glass.a + inverse * (glass.b + glass.c * inverse * inverse * std::sqrt(inverse));
}

double indexOf(const SellmeierGlass& glass, double wavelength) {
    const double square = wavelength * wavelength;
    double sum = 1.0;
    for (std::size_t i = 0; i < glass.b.size(); ++i)
        sum += glass.b[i] * square / (square - glass.c[i]);
    return std::sqrt(sum);
}

}  // namespace

ConradyGlass glassFromAbbeNumber(double nd, double vd) {
    const double dispersion = (nd - 1.0) / vd;  // nF − nC
    const double partial = dispersion * (0.6438 - 0.001682 * vd);
    const auto first = [](double lineNm) { return 1.0 / micrometres(lineNm); };
    const auto second = [](double lineNm) {
        const double x = micrometres(lineNm);
        return 1.0 / (x * x * x * std::sqrt(x));
    };
    // nF − nC and ng − nF are linear in b and c.
    const double b1 = first(fLineNm) - first(cLineNm), c1 = second(fLineNm) - second(cLineNm);
    const double b2 = first(gLineNm) - first(fLineNm), c2 = second(gLineNm) - second(fLineNm);
    const double determinant = b1 * c2 - c1 * b2;
    const double b = (dispersion * c2 - c1 * partial) / determinant;
    const double c = (b1 * partial - b2 * dispersion) / determinant;
    return {nd - b * first(dLineNm) - c * second(dLineNm), b, c};
}

SellmeierGlass glassFromCatalogue(std::string_view name) {
    for (const CatalogueGlass& entry : glassCatalogue())
        if (entry.name == name) return entry.dispersion;
    const auto nearest = nearestName(name, catalogueGlassNames());
    throw std::invalid_argument("the catalogue has no glass \"" + std::string(name) + '"' +
                                (nearest ? "; did you mean \"" + *nearest + "\"?" : ""));
}

std::vector<std::string> catalogueGlassNames() {
    std::vector<std::string> names;
    for (const CatalogueGlass& entry : glassCatalogue()) names.emplace_back(entry.name);
    return names;
}

double refractiveIndex(const Glass& glass, double wavelengthNm) {
    const double wavelength = micrometres(wavelengthNm);
    return std::visit([wavelength](const auto& medium) { return indexOf(medium, wavelength); },
                      glass);
}

double abbeNumber(const Glass& glass) {
    const double dispersion = refractiveIndex(glass, fLineNm) - refractiveIndex(glass, cLineNm);
    if (dispersion == 0.0) return std::numeric_limits<double>::infinity();
    return (refractiveIndex(glass, dLineNm) - 1.0) / dispersion;
}

bool isPlausible(const Glass& glass) {
    constexpr int steps = 75;
    double before = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= steps; ++i) {
        const double t = static_cast<double>(i) / steps;
        const double n =
            refractiveIndex(glass, std::lerp(shortestWavelengthNm, longestWavelengthNm, t));
        if (!(n >= 1.0 && n <= before)) return false;  // also refuses NaN
        before = n;
    }
    return true;
}

}  // namespace etendue
