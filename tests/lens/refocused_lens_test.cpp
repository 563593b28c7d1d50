#include "lens/refocused_lens.h"

#include <doctest/doctest.h>

#include <cmath>

#include "lens/fit_domain.h"
#include "tests/lens/fitted_lenses.h"
#include "tests/lens/lens_checks.h"

namespace etendue {
namespace {

/// A 50 mm lens that focuses from infinity to a metre, in either form.
struct Fixture {
    explicit Fixture(FitForm form) {
        DomainRequest request;
        request.nearestFocusMm = 1000.0;
        FitSettings settings = smallSettings();
        settings.form = form;
        settings.terms = 32;
        settings.degree = 9;
        settings.clip = {24, 7, 3000};
        domain = fitDomain(prescription, request);
        fit = fitLens(prescription, domain, settings);
    }
    RefocusedLens at(double focusDistanceMm) const {
        return {prescription, fit, Aperture(domain.apertureRadiusMm),
                sensorDistanceMm(paraxialData(OpticalSystem(prescription)), focusDistanceMm)};
    }

    Prescription prescription = loadPrescription(lensFile("petzval-50mm.toml"));
    FitDomain domain;
    LensFit fit;
};

const Fixture& fixtureOf(FitForm form) {
    static const Fixture twoPoint(FitForm::twoPoint), sensorState(FitForm::sensorState);
    return form == FitForm::twoPoint ? twoPoint : sensorState;
}

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr FitForm bothForms[] = {FitForm::twoPoint, FitForm::sensorState};

TEST_CASE("RefocusedLens: a ray is that of the exact lens with its sensor moved") {
    for (const FitForm form : bothForms)
        for (const double focus : {infinity, 3000.0, 1000.0}) {
            CAPTURE(focus);
            const Fixture& fixture = fixtureOf(form);
            const RefocusedLens lens = fixture.at(focus);
            const auto exact = makeTracedLens(fixture.prescription, {{}, {}, focus});
            LensRandom random(81);
            int rays = 0;
            for (int i = 0; i < 500; ++i) {
                const SensorPoint s = random.onSensor(10.0, 8.0);
                const AperturePoint a = lens.sampleAperture(random.inUnitSquare());
                const auto ray = lens.trace(s, a, greenNm), truth = exact->trace(s, a, greenNm);
                if (!ray || !truth) continue;
                ++rays;
                // The fit's largest error, and as much again for the slope's.
                CHECK((ray->direction - truth->direction).norm() <=
                      2e-3 * fixture.fit.errors.directionMrad.most);
                CHECK(std::abs(ray->throughput - truth->throughput) <= 0.01 * truth->throughput);
                CHECK((ray->directionBySensor - truth->directionBySensor).norm() <=
                      0.01 * truth->directionBySensor.norm());
            }
            CHECK(rays > 100);
        }
}

TEST_CASE("RefocusedLens: derivatives and connections are those of its own rays") {
    for (const FitForm form : bothForms) {
        const RefocusedLens lens = fixtureOf(form).at(1000.0);
        LensRandom random(82);
        for (int i = 0; i < 20; ++i) {
            const SensorPoint s = random.onSensor(7.0, 5.0);
            const AperturePoint a{2.0 * (random.inUnitSquare() - Eigen::Vector2d(0.5, 0.5))};
            checkDerivatives(lens, s, a, 0.05, 1e-6, 1e-12);
            for (const double distance : {100.0, 1000.0, 1e7})
                checkRoundTrip(lens, s, a, distance, 1e-9);
        }
    }
}

TEST_CASE("RefocusedLens: light is conserved whatever the focus") {
    // Of one scene point's rays through the whole aperture, ∫ J da, what the moved sensor sees less
    // of in one place it sees more of in another: J ds da is the same bundle of rays.
    const Fixture& fixture = fixtureOf(FitForm::twoPoint);
    const RefocusedLens far = fixture.at(infinity), near = fixture.at(1000.0);
    LensRandom random(83);
    int rays = 0;
    for (int i = 0; i < 100; ++i) {
        const SensorPoint s = random.onSensor(7.0, 5.0);
        const AperturePoint a = far.sampleAperture(random.inUnitSquare());
        const auto ray = far.trace(s, a, greenNm);
        if (!ray) continue;
        const auto there = near.connect(ray->origin + 1e4 * ray->direction, a, greenNm);
        REQUIRE(there.has_value());
        const auto again = near.trace(*there, a, greenNm);
        REQUIRE(again.has_value());
        ++rays;
        // The same ray, by both sensors: throughput over footprint is its own.
        const auto area = [](const ExitRay& r) {
            return r.direction.dot(r.directionBySensor.col(0).cross(r.directionBySensor.col(1)));
        };
        CHECK(std::abs(again->throughput / area(*again) - ray->throughput / area(*ray)) <=
              1e-9 * ray->throughput / area(*ray));
    }
    CHECK(rays > 50);
}

TEST_CASE("RefocusedLens: outside its focus range, and outside its domain, there is none") {
    const Fixture& fixture = fixtureOf(FitForm::twoPoint);
    CHECK_THROWS_AS(fixture.at(900.0), std::invalid_argument);
    CHECK_THROWS_AS(RefocusedLens(fixture.prescription, fixture.fit, Aperture(5.0),
                                  fixture.domain.sensorDistanceMm - 0.1),
                    std::invalid_argument);
    const RefocusedLens lens = fixture.at(1000.0);
    for (const double x : {60.0, 1e300, infinity, std::nan("")})
        CHECK_FALSE(lens.trace({{x, 0.0}}, {{0.0, 0.0}}, greenNm).has_value());
    CHECK_FALSE(lens.connect({0.0, 0.0, -1e4}, {{0.0, 0.0}}, greenNm).has_value());
    DomainRequest reversed;
    reversed.focusDistanceMm = 1000.0;
    reversed.nearestFocusMm = 2000.0;
    CHECK_THROWS_AS(fitDomain(fixture.prescription, reversed), std::invalid_argument);
}

}  // namespace
}  // namespace etendue
