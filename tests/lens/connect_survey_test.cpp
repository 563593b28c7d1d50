#include "lens/connect_survey.h"

#include <doctest/doctest.h>

#include "tests/lens/fitted_lenses.h"

namespace etendue {
namespace {

TEST_CASE("connectSurvey: rings cover the sensor, and nothing of a double Gauss is lost") {
    const Prescription table = doubleGauss();
    FitSettings settings = smallSettings();
    settings.terms = 24;
    const LensFit fit = fitLens(table, doubleGaussDomain(), settings);
    const PolynomialLens lens(table, fit, Aperture(fit.domain.apertureRadiusMm));
    const std::vector<double> distances{100.0, 1e4, 1e9};
    const auto rings = connectSurvey(lens, ConnectMethod::newton, distances, 4, 200);
    REQUIRE(rings.size() == 4);
    double before = -1.0;
    for (const ConnectRing& ring : rings) {
        CHECK(ring.rays == 200);
        CHECK(ring.failures == 0);
        CHECK(ring.otherPoints == 0);
        CHECK(ring.meanIterations >= 0.0);
        CHECK(ring.meanIterations <= ring.mostIterations);
        CHECK(ring.mostIterations >= 1);
        CHECK(ring.fieldDegrees > before);
        before = ring.fieldDegrees;
    }
    // Of chief rays: atan(21.6/100) is 12.2°; the ring's middle is 7/8 as far out.
    CHECK(before == doctest::Approx(10.7).epsilon(0.1));
    const auto published = connectSurvey(lens, ConnectMethod::twoStep, distances, 4, 200);
    CHECK(published.back().meanIterations > rings.back().meanIterations);
}

}  // namespace
}  // namespace etendue
