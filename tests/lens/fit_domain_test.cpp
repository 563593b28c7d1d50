#include "lens/fit_domain.h"

#include <doctest/doctest.h>

#include <cmath>

#include "lens/field.h"
#include "tests/lens/prescriptions.h"

namespace etendue {

TEST_CASE("fitDomain: it is the sensor, focus and aperture that were asked for") {
    const Prescription tessar = loadPrescription(lensFile("tessar-100mm.toml"));
    const FitDomain domain = fitDomain(tessar, {{30.0, 20.0}, 2000.0, 5.6, 450.0, 650.0});
    CHECK(domain.sensorHalfSizeMm == Eigen::Vector2d(15.0, 10.0));
    CHECK(std::isinf(domain.imageRadiusMm));
    CHECK(domain.shortestWavelengthNm == 450.0);
    CHECK(domain.longestWavelengthNm == 650.0);
    const TracedLens lens = lensOf(tessar, domain);
    const auto asSet = makeTracedLens(tessar, {5.6, {}, 2000.0});
    CHECK(lens.sensorZMm() == doctest::Approx(asSet->sensorZMm()).epsilon(1e-14));
    CHECK(domain.apertureRadiusMm == asSet->system().aperture.radiusMm());
}

TEST_CASE("fitDomain: a sensor larger than the picture is cut to where there is light") {
    const Prescription fisheye = loadPrescription(lensFile("fisheye-220-6mm-f2.8.toml"));
    const FitDomain domain = fitDomain(fisheye, {});
    REQUIRE(domain.imageRadiusMm < domain.sensorHalfSizeMm.x());
    const TracedLens lens = lensOf(fisheye, domain);
    CHECK(relativeIllumination(lens, {{0.999 * domain.imageRadiusMm, 0.0}}) > 0.0);
    CHECK(relativeIllumination(lens, {{1.02 * domain.imageRadiusMm, 0.0}}) < 2e-3);
    DomainRequest small;
    small.sensorSizeMm = {12.0, 8.0};
    CHECK(std::isinf(fitDomain(fisheye, small).imageRadiusMm));
}

TEST_CASE("fitDomain: a lens that is telecentric at the sensor has a focus range too") {
    // The stop at the front focus: the exit pupil is at infinity, exactly.
    Prescription lens;
    lens.name = "telecentric";
    lens.surfaces = {stop(100.0, 5.0), spherical(50.0, 4.0, 12.0, plainGlass(1.5)),
                     spherical(std::numeric_limits<double>::infinity(), 50.0, 12.0)};
    DomainRequest request;
    request.sensorSizeMm = {10.0, 8.0};
    request.nearestFocusMm = 2000.0;
    const FitDomain domain = fitDomain(lens, request);
    REQUIRE(domain.sensorTravelMm > 0.0);
    // Cones of the slope 5/100, all over the sensor.
    CHECK(domain.sensorHalfSizeMm.x() - 5.0 ==
          doctest::Approx(0.05 * domain.sensorTravelMm).epsilon(1e-12));
    CHECK(domain.sensorHalfSizeMm.y() - 4.0 ==
          doctest::Approx(0.05 * domain.sensorTravelMm).epsilon(1e-12));
}

TEST_CASE("fitDomain: what no lens can meet is refused") {
    const Prescription tessar = loadPrescription(lensFile("tessar-100mm.toml"));
    const auto refuses = [&](const DomainRequest& request) {
        CHECK_THROWS_AS(fitDomain(tessar, request), std::invalid_argument);
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    refuses({{0.0, 24.0}});
    refuses({{36.0, -24.0}});
    refuses({{infinity, 24.0}});
    refuses({{36.0, 24.0}, 100.0});  // nearer than the lens can focus
    refuses({{36.0, 24.0}, -infinity});
    refuses({{36.0, 24.0}, infinity, 1.0});  // wider than it opens
    refuses({{36.0, 24.0}, infinity, {}, 349.0, 700.0});
    refuses({{36.0, 24.0}, infinity, {}, 400.0, 1101.0});
    refuses({{36.0, 24.0}, infinity, {}, 700.0, 400.0});
}

}  // namespace etendue
