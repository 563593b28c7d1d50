#include "lens/glass.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "lens/glass_catalogue.h"

namespace etendue {
namespace {

double at(const Glass& glass, double wavelengthNm) { return refractiveIndex(glass, wavelengthNm); }

TEST_CASE("Glass: every glass of the catalogue has its published index and Abbe number") {
    CHECK(glassCatalogue().size() >= 60);
    for (const CatalogueGlass& entry : glassCatalogue()) {
        CAPTURE(entry.name);
        const Glass glass = entry.dispersion;
        // Published to 5 and 2 digits; the makers' fits are good to a few 1e-6, which the
        // smallest dispersion here, 0.0046 at vd = 95, turns into 0.06 of vd.
        CHECK(std::abs(at(glass, dLineNm) - entry.nd) <= 2e-5);
        CHECK(std::abs(abbeNumber(glass) - entry.vd) <= 0.06);
        CHECK(isPlausible(glass));
    }
}

TEST_CASE("Glass: N-BK7 and F2 have the indices of their data sheets far from the d line") {
    const Glass crown = glassFromCatalogue("N-BK7"), flint = glassFromCatalogue("F2");
    CHECK(std::abs(at(crown, 365.0146) - 1.53627) <= 1e-5);
    CHECK(std::abs(at(crown, gLineNm) - 1.52668) <= 1e-5);
    CHECK(std::abs(at(crown, fLineNm) - 1.52238) <= 1e-5);
    CHECK(std::abs(at(crown, cLineNm) - 1.51432) <= 1e-5);
    CHECK(std::abs(at(crown, 1013.98) - 1.50731) <= 1e-5);
    CHECK(std::abs(at(flint, gLineNm) - 1.64202) <= 1e-5);
    CHECK(std::abs(at(flint, fLineNm) - 1.63208) <= 1e-5);
    CHECK(std::abs(at(flint, cLineNm) - 1.61503) <= 1e-5);
}

TEST_CASE("Glass: one named by nd and vd has exactly these") {
    for (const CatalogueGlass& entry : glassCatalogue()) {
        const Glass glass = glassFromAbbeNumber(entry.nd, entry.vd);
        CHECK(at(glass, dLineNm) == doctest::Approx(entry.nd).epsilon(1e-15));
        // nF − nC ≈ 0.01 is a difference of numbers with 2e-16: 2e-14 of itself.
        CHECK(abbeNumber(glass) == doctest::Approx(entry.vd).epsilon(1e-13));
        CHECK(isPlausible(glass));
    }
}

TEST_CASE("Glass: nd and vd foretell a glass as well as the header of glass.h says") {
    std::vector<double> errors;
    for (const CatalogueGlass& entry : glassCatalogue()) {
        const Glass exact = entry.dispersion, model = glassFromAbbeNumber(entry.nd, entry.vd);
        double worst = 0.0;
        for (double wavelength = 400.0; wavelength <= 700.0; wavelength += 10.0)
            worst = std::max(worst, std::abs(at(exact, wavelength) - at(model, wavelength)));
        errors.push_back(worst);
    }
    std::ranges::sort(errors);
    CHECK(errors[errors.size() / 2] < 3.5e-4);
    CHECK(errors.back() < 5e-3);
}

TEST_CASE("Glass: an unknown name is refused with the nearest known one") {
    CHECK_THROWS_WITH_AS(glassFromCatalogue("N-BK8"),
                         "the catalogue has no glass \"N-BK8\"; did you mean \"N-BK7\"?",
                         std::invalid_argument);
    CHECK_THROWS_AS(glassFromCatalogue("window pane"), std::invalid_argument);
    CHECK_THROWS_AS(glassFromCatalogue(""), std::invalid_argument);
}

TEST_CASE("Glass: what no glass can be is not plausible") {
    CHECK(isPlausible(Air{}));
    CHECK_FALSE(isPlausible(ConradyGlass{0.9, 0.0, 0.0}));
    CHECK_FALSE(isPlausible(ConradyGlass{1.5, -0.01, 0.0}));            // rises toward the red
    CHECK_FALSE(isPlausible(glassFromAbbeNumber(1.5, 0.0)));            // not a number
    CHECK_FALSE(isPlausible(SellmeierGlass{{1, 0, 0}, {0.25, 0, 0}}));  // a resonance at 500 nm
    CHECK_FALSE(isPlausible(SellmeierGlass{{-3, 0, 0}, {0, 0, 0}}));    // n² < 0
}

}  // namespace
}  // namespace etendue
