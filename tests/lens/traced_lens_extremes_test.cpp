// TracedLens where lenses end: tiny stops, huge lenses, grazing rays, the edges of the spectrum.
#include <doctest/doctest.h>

#include <cmath>

#include "lens/traced_lens.h"
#include "tests/lens/lens_checks.h"
#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// f/8 and focused at infinity.
std::unique_ptr<TracedLens> atEight(const Prescription& prescription) {
    return makeTracedLens(prescription, {8.0, {}, infinity});
}

TEST_CASE("TracedLens: outside 350–1100 nm nothing passes, at the edges light does") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const auto lens = atEight(load(shipped));
        const SensorPoint s{{0.5, 0.2}};
        const AperturePoint a{{0.1, 0.0}};
        for (const double wavelength : {350.0, 1100.0}) {
            const auto ray = lens->trace(s, a, wavelength);
            REQUIRE(ray.has_value());
            CHECK(lens->connect(ray->origin + 1e3 * ray->direction, a, wavelength).has_value());
        }
        for (const double wavelength : {349.999, 1100.001, 0.0, -550.0, infinity, std::nan("")}) {
            CHECK_FALSE(lens->trace(s, a, wavelength).has_value());
            CHECK_FALSE(lens->connect({0.0, 0.0, 1e3}, a, wavelength).has_value());
            CHECK_FALSE(lens->at(wavelength).has_value());
        }
    }
}

TEST_CASE("TracedLens: states that are no rays give nothing") {
    const double nan = std::nan("");
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const auto lens = atEight(load(shipped));
        const AperturePoint centre{{0.0, 0.0}};
        for (const double x : {nan, infinity, -infinity, 1e300, 1e6, 1e4}) {
            CHECK_FALSE(lens->trace({{x, 0.0}}, centre, greenNm).has_value());
            CHECK_FALSE(lens->trace({{0.0, 0.0}}, {{0.0, x}}, greenNm).has_value());
            CHECK_FALSE(lens->connect({0.0, 0.0, 1e3}, {{x, 0.0}}, greenNm).has_value());
        }
        for (const Eigen::Vector3d& target :
             {Eigen::Vector3d(nan, 0, 1e3), Eigen::Vector3d(0, infinity, 1e3),
              Eigen::Vector3d(0, 0, -infinity), Eigen::Vector3d(0, 0, -1e6),
              Eigen::Vector3d(0, 10, lens->sensorZMm())})
            CHECK_FALSE(lens->connect(target, centre, greenNm).has_value());
    }
}

TEST_CASE("TracedLens: beyond the image circle rays end at a rim or miss, and are nothing") {
    LensRandom random(61);
    int endedOnAny = 0;
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const auto lens = atEight(load(shipped));
        const MonochromaticLens atLine(*lens, greenNm);
        const double f = lens->focalLengthMm();
        int present = 0, ended = 0, unsolved = 0;
        for (int i = 0; i < 60; ++i) {
            const double reach = i % 2 == 0 ? 4.0 * f : shipped.imageHeightMm;
            const SensorPoint s = random.onSensor(reach, reach);
            const AperturePoint a = lens->sampleAperture(random.inUnitSquare());
            const auto ray = lens->trace(s, a, greenNm);
            const auto q = atLine.slopeThrough(s, a);
            if (!q) {
                ++unsolved;
                CHECK_FALSE(ray.has_value());
                continue;
            }
            const TracedRay traced = atLine.traceToScene({s.mm.x(), s.mm.y(), q->x(), q->y()});
            const bool passes = traced.passage.status == TraceStatus::passed;
            ended += !passes;
            if (!ray) continue;
            ++present;
            CHECK(passes);  // the converse fails for folded rays
            CHECK(ray->originBySensor.allFinite());
            CHECK(ray->throughput > 0.0);
        }
        CHECK(present > 0);
        CHECK(ended + unsolved > 0);
        endedOnAny += ended;
    }
    CHECK(endedOnAny > 0);
}

TEST_CASE(
    "TracedLens: any slope at the sensor comes to one end or another, never to a number "
    "that is none") {
    LensRandom random(62);
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        const auto lens = makeTracedLens(prescription);
        const MonochromaticLens atLine(*lens, 400.0);
        for (int i = 0; i < 500; ++i) {
            const double steep = std::pow(10.0, random.between(-3.0, 6.0));
            const TracedRay ray =
                atLine.traceToScene({random.between(-40, 40), random.between(-40, 40),
                                     steep * random.between(-1, 1), steep * random.between(-1, 1)});
            CHECK(ray.passage.surface < prescription.surfaces.size());
            CHECK(ray.passage.transmittance >= 0.0);
            CHECK(ray.passage.transmittance <= 1.0);
            CHECK(toEigen(ray.ray.origin).allFinite());
            CHECK(toEigen(ray.ray.direction).norm() == doctest::Approx(1.0).epsilon(1e-13));
        }
    }
}

TEST_CASE("TracedLens: a ray that a ball turns back toward the scene does not end on the sensor") {
    // At 89° to the normal of a ball of index 1.5 a ray is turned by 2 (89° − 41.8°) > 90°.
    Prescription ball;
    ball.surfaces = {stop(1.0, 10.0), spherical(10.0, 20.0, 9.9999, plainGlass(1.5)),
                     spherical(-10.0, 5.0, 9.9999)};
    const TracedLens lens(ball, Aperture(10.0), 5.0);
    const MonochromaticLens atLine(lens, greenNm);
    const double height = 10.0 * std::sin(89.0 * std::acos(-1.0) / 180.0);
    const TracedRay turned = atLine.traceToSensor({{height, 0.0, 5.0}, {0.0, 0.0, -1.0}});
    CHECK(turned.ray.direction.z > 0.0);
    CHECK(turned.passage.status == TraceStatus::missedSurface);
    const TracedRay straight = atLine.traceToSensor({{1.0, 0.0, 5.0}, {0.0, 0.0, -1.0}});
    CHECK(straight.passage.status == TraceStatus::passed);
}

TEST_CASE("TracedLens: a lens that diverges connects as any other") {
    const Prescription lens = singlet(-50.0, 50.0, 3.0, 1.5, 10.0);
    const TracedLens traced(lens, Aperture(2.0), 60.0);
    REQUIRE(traced.focalLengthMm() < 0.0);
    for (const double distance : {30.0, 1e3, 1e6})
        checkRoundTrip(traced, {{4.0, -3.0}}, {{1.0, 0.5}}, distance, 1e-8);
}

TEST_CASE("TracedLens: light that grazes the front surface is all but reflected") {
    // Along the tangent at a point of the front sphere, tilted inward; much below 1e-6 the depth
    // of the chord, R angle²/2, drowns in rounding.
    const Prescription prescription = load({"fisheye-220-6mm-f2.8.toml", 0.0});
    const auto lens = makeTracedLens(prescription);
    const MonochromaticLens atLine(*lens, greenNm);
    const double radius = prescription.surfaces[0].radiusMm, polar = 0.3;
    const Vector3<double> normal{std::sin(polar), 0.0, std::cos(polar)};
    const Vector3<double> tangent{-std::cos(polar), 0.0, std::sin(polar)};
    const Vector3<double> point = normal * radius + Vector3<double>{0.0, 0.0, -radius};
    const auto grazing = [&](double angle) {
        const Vector3<double> direction = normalized(tangent - normal * angle);
        return atLine.traceToSensor({point - direction * 10.0, direction}).passage;
    };
    // Both reflectances are 1 − O(cos θ): of the angle a share of 4 n²/√(n² − 1) at most passes.
    for (const double angle : {1e-2, 1e-4, 1e-6}) {
        CHECK(grazing(angle).transmittance <= 10.0 * angle);
        CHECK(grazing(angle).transmittance > 0.0);
    }
    CHECK(grazing(-1e-6).status == TraceStatus::missedSurface);
}

TEST_CASE("TracedLens: a ray at the rim passes just inside it and ends just outside") {
    const auto lens = makeTracedLens(load({"tessar-100mm.toml", 0.0}));
    const double radius = lens->system().aperture.radiusMm();
    for (const double turn : {0.0, 1.0, 2.0}) {
        const Eigen::Vector2d along(std::cos(turn), std::sin(turn));
        CHECK(lens->trace({{0.0, 0.0}}, {radius * along}, greenNm).has_value());
        CHECK_FALSE(lens->trace({{0.0, 0.0}}, {radius * (1.0 + 1e-12) * along}, greenNm));
    }
}

TEST_CASE("TracedLens: a stop of a ten-thousandth is a pinhole that still works") {
    LensRandom random(63);
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        const double full = prescription.surfaces[stopIndex(prescription)].semiApertureMm;
        const ParaxialData data = paraxialData(OpticalSystem(prescription));
        const TracedLens lens(prescription, Aperture(1e-4 * full),
                              sensorDistanceMm(data, infinity));
        for (int i = 0; i < 6; ++i) {
            const SensorPoint s =
                random.onSensor(0.4 * shipped.imageHeightMm, 0.4 * shipped.imageHeightMm);
            const AperturePoint a = lens.sampleAperture(random.inUnitSquare());
            const auto ray = lens.trace(s, a, greenNm), chief = lens.trace(s, {{0, 0}}, greenNm);
            REQUIRE(ray.has_value());
            REQUIRE(chief.has_value());
            // The aperture is within 1e-4 of the stop: so are throughput and direction.
            CHECK(ray->throughput == doctest::Approx(chief->throughput).scale(0.0).epsilon(2e-3));
            CHECK((ray->direction - chief->direction).norm() <= 1e-3);
            const auto found = lens.connect(ray->origin + 1e3 * ray->direction, a, greenNm);
            REQUIRE(found.has_value());
            CHECK((found->mm - s.mm).norm() <= 1e-9);
        }
    }
}

TEST_CASE("TracedLens: a lens 1000 times larger or smaller does the same on its own scale") {
    LensRandom random(64);
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        const auto lens = atEight(prescription);
        for (const double factor : {1e-3, 1e3}) {
            const auto other = atEight(scaled(prescription, factor));
            for (int i = 0; i < 5; ++i) {
                const SensorPoint s =
                    random.onSensor(0.5 * shipped.imageHeightMm, 0.5 * shipped.imageHeightMm);
                const AperturePoint a = lens->sampleAperture(random.inUnitSquare());
                const auto ray = lens->trace(s, {0.99 * a.mm}, greenNm);
                const auto large = other->trace({factor * s.mm}, {0.99 * factor * a.mm}, greenNm);
                REQUIRE(ray.has_value() == large.has_value());
                if (!ray) continue;
                CHECK((large->direction - ray->direction).norm() <= 1e-10);
                CHECK((large->origin / factor - ray->origin).norm() <= 1e-8);
                CHECK((large->originBySensor - ray->originBySensor).norm() <=
                      1e-9 * ray->originBySensor.norm());
                CHECK(large->throughput * factor * factor ==
                      doctest::Approx(ray->throughput).scale(0.0).epsilon(1e-9));
                const auto found = other->connect(large->origin + 1e3 * factor * large->direction,
                                                  {0.99 * factor * a.mm}, greenNm);
                REQUIRE(found.has_value());
                CHECK((found->mm / factor - s.mm).norm() <= 1e-9);
            }
        }
    }
}

TEST_CASE("TracedLens: focused as near as may be it still connects") {
    LensRandom random(65);
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        const ParaxialData data = paraxialData(OpticalSystem(prescription));
        const auto nearest = [](const ParaxialAxis& axis, double lastZ) {
            return axis.frontFocalDistanceMm - lastZ + axis.backFocalDistanceMm +
                   2.0 * axis.focalLengthMm;
        };
        const double focus = 1.001 * std::max(nearest(data.x, data.lastVertexZMm),
                                              nearest(data.y, data.lastVertexZMm));
        const auto lens = makeTracedLens(prescription, {11.0, {}, focus});
        int passed = 0;
        for (int i = 0; i < 15; ++i) {
            const SensorPoint s =
                random.onSensor(0.3 * shipped.imageHeightMm, 0.3 * shipped.imageHeightMm);
            const AperturePoint a = lens->sampleAperture(random.inUnitSquare());
            const auto ray = lens->trace(s, a, greenNm);
            if (!ray) continue;
            ++passed;
            for (const double distance : {1.0, 100.0, 1e5}) {
                const auto found =
                    lens->connect(ray->origin + distance * ray->direction, a, greenNm);
                REQUIRE(found.has_value());
                CHECK((found->mm - s.mm).norm() <= 1e-8);
            }
        }
        CHECK(passed > 4);
    }
}

}  // namespace
}  // namespace etendue
