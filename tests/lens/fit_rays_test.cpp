#include "lens/fit_rays.h"

#include <doctest/doctest.h>

#include <cmath>

namespace etendue {
namespace {

FitDomain domainOf(double halfWidthMm, double halfHeightMm, double imageRadiusMm) {
    FitDomain domain{};
    domain.sensorHalfSizeMm = {halfWidthMm, halfHeightMm};
    domain.imageRadiusMm = imageRadiusMm;
    domain.sensorDistanceMm = 50.0;
    domain.apertureRadiusMm = 5.0;
    return domain;
}

TEST_CASE("Fit rays: a picture that is a speck on the sensor is hit as evenly as any other") {
    constexpr double radius = 10.0;
    constexpr std::uint64_t count = 10'000;
    // From all of the sensor a query would take 40 million draws.
    const FitDomain speck = domainOf(5e4, 5e4, radius);
    double squares = 0.0, products = 0.0;
    for (std::uint64_t i = 0; i < count; ++i) {
        const FitQuery query = drawQuery(speck, 3, i);
        CHECK(speck.contains(query.sensor, query.aperture, query.wavelengthNm));
        squares += query.sensor.mm.squaredNorm();
        products += query.sensor.mm.x() * query.sensor.mm.y();
    }
    // r² is uniform in [0, R²]: mean ½, deviation 1/√12. xy has mean 0, deviation 1/√24. Both in R²
    // and to four standard errors.
    const double standardError = radius * radius / std::sqrt(static_cast<double>(count));
    CHECK(std::abs(squares / count - 0.5 * radius * radius) <
          4.0 * standardError / std::sqrt(12.0));
    CHECK(std::abs(products / count) < 4.0 * standardError / std::sqrt(24.0));
    // On a sensor that is huge in one direction the other's edges stay where they are.
    const FitDomain strip = domainOf(5e4, 2.0, radius);
    double widest = 0.0;
    for (std::uint64_t i = 0; i < count; ++i) {
        const FitQuery query = drawQuery(strip, 3, i);
        CHECK(strip.contains(query.sensor, query.aperture, query.wavelengthNm));
        widest = std::max(widest, std::abs(query.sensor.mm.x()));
    }
    CHECK(widest > 0.98 * radius);
}

TEST_CASE("Fit rays: how large a picture is does not move the queries of a sensor within it") {
    const FitDomain whole = domainOf(18.0, 12.0, std::numeric_limits<double>::infinity());
    const FitDomain within = domainOf(18.0, 12.0, 21.64);
    for (std::uint64_t i = 0; i < 1000; ++i)
        CHECK(drawQuery(whole, 3, i).sensor.mm == drawQuery(within, 3, i).sensor.mm);
}

}  // namespace
}  // namespace etendue
