#include "lens/traced_lens.h"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "config/config.h"
#include "tests/lens/lens_checks.h"
#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A lens that ships, as its header states it, and what a test draws from it.
struct Fixture {
    explicit Fixture(const ShippedLens& shipped, LensSettings settings = {})
        : prescription(load(shipped)), imageHeightMm(shipped.imageHeightMm) {
        if (!settings.fNumber) settings.fNumber = prescription.stated.fNumber;
        lens = makeTracedLens(prescription, settings);
    }
    SensorPoint sensorPoint(LensRandom& random) const {
        const double radius = imageHeightMm * std::sqrt(random.between(0.0, 1.0));
        const double turn = random.between(0.0, 2.0 * std::numbers::pi);
        return {{radius * std::cos(turn), radius * std::sin(turn)}};
    }

    Prescription prescription;
    double imageHeightMm;
    std::unique_ptr<TracedLens> lens;
};

/// Calls `check(fixture, s, a, ray)` for `count` rays that pass.
template <class Check>
void forPassingRays(const Fixture& fixture, LensRandom& random, int count, double wavelengthNm,
                    const Check& check) {
    int passed = 0;
    for (int tries = 0; passed < count && tries < 50 * count; ++tries) {
        const SensorPoint s = fixture.sensorPoint(random);
        const AperturePoint a = fixture.lens->sampleAperture(random.inUnitSquare());
        const auto ray = fixture.lens->trace(s, a, wavelengthNm);
        if (!ray) continue;
        ++passed;
        check(s, a, *ray);
    }
    CHECK(passed == count);
}

Eigen::Vector2d slopeOf(const Fixture& fixture, SensorPoint s, AperturePoint a,
                        double wavelengthNm) {
    const auto q = fixture.lens->at(wavelengthNm)->slopeThrough(s, a);
    REQUIRE(q.has_value());
    return *q;
}

/// ∂(pupil state)/∂(s, q), and the pupil state.
struct PupilMap {
    PupilState<double> pupil;
    Eigen::Matrix4d bySensor;
};

PupilMap pupilMap(const TracedLens& lens, const PupilSphere& sphere, const SensorState& sensor,
                  double wavelengthNm) {
    using D = Dual<4>;
    const PlaneState<D> seeded{D::variable(sensor.x, 0), D::variable(sensor.y, 1),
                               D::variable(sensor.slopeX, 2), D::variable(sensor.slopeY, 3)};
    LensRay<D> ray = rayOf(seeded, lens.sensorZMm());
    const MonochromaticLens atLine(lens, wavelengthNm);
    const Passage passage = carryToScene<TraceMode::light>(
        atLine.system(), 0, lens.system().surfaces.size(), ray, [](auto...) {});
    REQUIRE(passage.status == TraceStatus::passed);
    const auto state = sphere.state(ray);
    REQUIRE(state.has_value());
    PupilMap map;
    map.pupil = {state->x.value, state->y.value, state->directionX.value, state->directionY.value};
    const D* rows[] = {&state->x, &state->y, &state->directionX, &state->directionY};
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            map.bySensor(row, column) = rows[row]->partials[static_cast<std::size_t>(column)];
    return map;
}

TEST_CASE("TracedLens: every lens conserves étendue") {
    LensRandom random(51);
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Fixture fixture(shipped);
        const PupilSphere sphere(fixture.lens->system());
        for (const double wavelength : {350.0, 587.6, 1100.0})
            forPassingRays(fixture, random, 20, wavelength,
                           [&](SensorPoint s, AperturePoint a, const ExitRay&) {
                               const Eigen::Vector2d q = slopeOf(fixture, s, a, wavelength);
                               const SensorState sensor{s.mm.x(), s.mm.y(), q.x(), q.y()};
                               const PupilMap map =
                                   pupilMap(*fixture.lens, sphere, sensor, wavelength);
                               const double determinant =
                                   etendueDeterminant(map.bySensor, sensor, map.pupil, sphere);
                               CHECK(std::abs(determinant - 1.0) <= 1e-9);
                           });
    }
}

TEST_CASE("TracedLens: the exit ray's derivatives agree with central differences") {
    LensRandom random(52);
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        Fixture fixture(shipped);
        fixture.imageHeightMm *= 0.8;  // so that the neighbours pass as well
        const double f = fixture.lens->focalLengthMm(), step = 2e-4 * f;
        int checked = 0;
        forPassingRays(
            fixture, random, 12, greenNm, [&](SensorPoint s, AperturePoint a, const ExitRay&) {
                for (const double x : {-2.0, 0.0, 2.0})
                    for (const double y : {-2.0, 0.0, 2.0})
                        if (!fixture.lens->trace({s.mm + step * Eigen::Vector2d(x, y)}, a, greenNm))
                            return;
                // Where a derivative nearly vanishes, 1e-6 of what is usual: 1 and 1/f.
                checkDerivatives(*fixture.lens, s, a, step, 1e-6, 1e-7 / std::max(1.0, f));
                ++checked;
            });
        CHECK(checked >= 6);
    }
}

TEST_CASE("TracedLens: a ray sent back returns to where it came from") {
    LensRandom random(53);
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Fixture fixture(shipped);
        for (const double wavelength : {350.0, 1100.0}) {
            const MonochromaticLens atLine(*fixture.lens, wavelength);
            forPassingRays(
                fixture, random, 15, wavelength, [&](SensorPoint s, AperturePoint a, const auto&) {
                    const Eigen::Vector2d q = slopeOf(fixture, s, a, wavelength);
                    const TracedRay out = atLine.traceToScene({s.mm.x(), s.mm.y(), q.x(), q.y()});
                    REQUIRE(out.passage.status == TraceStatus::passed);
                    const double away = std::pow(10.0, random.between(0.0, 4.0));
                    const TracedRay back = atLine.traceToSensor(
                        {out.ray.origin + out.ray.direction * away, out.ray.direction * -1.0});
                    REQUIRE(back.passage.status == TraceStatus::passed);
                    const SensorState end = planeState(back.ray, fixture.lens->sensorZMm());
                    CHECK(std::hypot(end.x - s.mm.x(), end.y - s.mm.y()) <= 1e-9);
                    CHECK(std::hypot(end.slopeX - q.x(), end.slopeY - q.y()) <= 1e-9);
                    CHECK(std::hypot(out.aperture.x - a.mm.x(), out.aperture.y - a.mm.y()) <= 1e-9);
                    CHECK(std::hypot(back.aperture.x - a.mm.x(), back.aperture.y - a.mm.y()) <=
                          1e-9);
                    CHECK(std::hypot(back.aperture.slopeX - out.aperture.slopeX,
                                     back.aperture.slopeY - out.aperture.slopeY) <= 1e-9);
                    CHECK(back.passage.transmittance ==
                          doctest::Approx(out.passage.transmittance).epsilon(1e-8));
                });
        }
    }
}

TEST_CASE("TracedLens: throughput is cos⁴θ |det ∂q/∂a| times a transmittance in (0, 1]") {
    LensRandom random(54);
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Fixture fixture(shipped);
        const MonochromaticLens atLine(*fixture.lens, greenNm);
        const double h = 1e-4 * fixture.lens->system().aperture.radiusMm();
        forPassingRays(
            fixture, random, 20, greenNm, [&](SensorPoint s, AperturePoint a, const ExitRay& ray) {
                const Eigen::Vector2d q = slopeOf(fixture, s, a, greenNm);
                const TracedRay traced = atLine.traceToScene({s.mm.x(), s.mm.y(), q.x(), q.y()});
                const double transmittance = traced.passage.transmittance;
                CHECK(transmittance > 0.0);
                CHECK(transmittance <= 1.0);
                // By differences of the solve itself: error h² ∼ 1e-8, rounding 1e-15/1e-4.
                Eigen::Matrix2d slopeByAperture;
                for (int axis = 0; axis < 2; ++axis) {
                    const Eigen::Vector2d moved = h * Eigen::Vector2d::Unit(axis);
                    slopeByAperture.col(axis) = (slopeOf(fixture, s, {a.mm + moved}, greenNm) -
                                                 slopeOf(fixture, s, {a.mm - moved}, greenNm)) /
                                                (2.0 * h);
                }
                const double cosSquared = 1.0 / (1.0 + q.squaredNorm());
                CHECK(ray.throughput == doctest::Approx(cosSquared * cosSquared * transmittance *
                                                        std::abs(slopeByAperture.determinant()))
                                            .scale(0.0)
                                            .epsilon(1e-6));
                // The solved ray is the traced one.
                CHECK((ray.direction - toEigen(traced.ray.direction)).norm() <= 1e-12);
                CHECK((ray.origin - toEigen(traced.ray.origin)).norm() <= 1e-9);
            });
    }
}

TEST_CASE("TracedLens: connect finds the ray that trace produced") {
    LensRandom random(55);
    for (const ShippedLens& shipped : shippedLenses())
        for (const double stopped : {1.0, 8.0}) {
            CAPTURE(shipped.file);
            const double wide = load(shipped).stated.fNumber;
            const Fixture fixture(shipped, {stopped * wide, {}, infinity});
            for (const double wavelength : {350.0, 550.0, 1100.0})
                forPassingRays(
                    fixture, random, 5, wavelength,
                    [&](SensorPoint s, AperturePoint a, const ExitRay& ray) {
                        for (const double distance : {100.0, 3e3, 1e6, 1e12}) {
                            const Eigen::Vector3d target = ray.origin + distance * ray.direction;
                            const auto found = fixture.lens->connect(target, a, wavelength);
                            REQUIRE(found.has_value());
                            CHECK((found->mm - s.mm).norm() <= 1e-9);
                        }
                    });
        }
}

TEST_CASE("TracedLens: connect misses none of 10000 rays on any lens" *
          doctest::test_suite("statistical")) {
    LensRandom random(56);
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        int tried = 0, found = 0;
        for (const double stopped : {1.0, 4.0, 20.0}) {
            const double wide = load(shipped).stated.fNumber;
            const Fixture fixture(shipped, {stopped * wide, {}, infinity});
            const auto roundTrip = [&](SensorPoint s, AperturePoint a, const ExitRay& ray) {
                for (const double distance : {100.0, 1e3, 1e5, 1e12}) {
                    const Eigen::Vector3d target = ray.origin + distance * ray.direction;
                    const auto again = fixture.lens->connect(target, a, greenNm);
                    ++tried;
                    found += again && (again->mm - s.mm).norm() <= 1e-9;
                }
            };
            forPassingRays(fixture, random, 850, greenNm, roundTrip);
        }
        CHECK(found == tried);
    }
}

TEST_CASE("TracedLens: trace finds every ray that passes") {
    LensRandom random(59);
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Fixture fixture(shipped);
        const MonochromaticLens atLine(*fixture.lens, greenNm);
        const TracedSurface& last = fixture.lens->system().surfaces.back();
        const double distance = last.vertexZMm - fixture.lens->sensorZMm();
        int passed = 0;
        for (int i = 0; i < 6000; ++i) {
            // Aimed anywhere at the last surface.
            const SensorPoint s = fixture.sensorPoint(random);
            const SensorPoint aim = random.onSensor(last.semiApertureMm, last.semiApertureMm);
            const Eigen::Vector2d q = (aim.mm - s.mm) / distance;
            const TracedRay ray = atLine.traceToScene({s.mm.x(), s.mm.y(), q.x(), q.y()});
            if (ray.passage.status != TraceStatus::passed) continue;
            ++passed;
            const auto found = atLine.trace(s, {{ray.aperture.x, ray.aperture.y}});
            REQUIRE(found.has_value());
            CHECK((found->direction - toEigen(ray.ray.direction)).norm() <= 1e-10);
        }
        CHECK(passed > 10);
    }
}

TEST_CASE("TracedLens: where the published search ends, it ends where ours does") {
    LensRandom random(58);
    int found = 0, lost = 0;
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Fixture fixture(shipped);
        for (int i = 0; i < 60; ++i) {
            const double half = 0.4 * fixture.imageHeightMm;
            const SensorPoint s = random.onSensor(half, half);
            const AperturePoint a = fixture.lens->sampleAperture(random.inUnitSquare());
            const auto ray = fixture.lens->trace(s, a, greenNm);
            if (!ray) continue;
            const Connection published = fixture.lens->solve(ray->origin + 1e6 * ray->direction, a,
                                                             greenNm, ConnectMethod::twoStep);
            if (published.sensor)
                ++found;
            else
                ++lost;
            if (published.sensor) CHECK((published.sensor->mm - s.mm).norm() <= 1e-6);
            if (!published.sensor) CHECK(published.status != ConnectStatus::found);
        }
    }
    // Halfway out to the image circle most are found, and not all.
    CHECK(found > 400);
    CHECK(lost > 0);
}

TEST_CASE("TracedLens: wide open, where beams fold or miss the rear, rays are found as they were") {
    // The stop of the 220° fisheye is no f-stop as tabulated: the rim of its aperture folds. Nor
    // is the anamorphic zoom's: at its rim no ray leaves the sensor's centre, where a solve that
    // leaves the aperture point where it is would have to start.
    LensRandom random(57);
    for (const ShippedLens& shipped : {ShippedLens{"fisheye-220-6mm.toml", 11.0},
                                       ShippedLens{"anamorphic-80x90mm.toml", 16.0}}) {
        CAPTURE(shipped.file);
        const auto lens = makeTracedLens(load(shipped));
        int passed = 0;
        for (int i = 0; i < 2000; ++i) {
            const SensorPoint s = random.onSensor(shipped.imageHeightMm, shipped.imageHeightMm);
            const AperturePoint a = lens->sampleAperture(random.inUnitSquare());
            const auto ray = lens->trace(s, a, greenNm);
            if (!ray) continue;
            ++passed;
            const auto found = lens->connect(ray->origin + 1e3 * ray->direction, a, greenNm);
            REQUIRE(found.has_value());
            CHECK((found->mm - s.mm).norm() <= 1e-9);
        }
        CHECK(passed > 80);
    }
}

TEST_CASE("TracedLens: fisheyes see behind themselves") {
    for (const ShippedLens& shipped :
         {ShippedLens{"fisheye-220-6mm-f2.8.toml", 11.2}, ShippedLens{"fisheye-10mm.toml", 13.6}}) {
        CAPTURE(shipped.file);
        const Fixture fixture(shipped);
        const double height = shipped.imageHeightMm;
        const auto chief = fixture.lens->trace({{height, 0.0}}, {{0.0, 0.0}}, greenNm);
        REQUIRE(chief.has_value());
        CHECK(chief->direction.z() < -0.02);
        CHECK(chief->direction.x() < 0.0);
        // It leaves the front surface, and outward.
        const double radius = fixture.prescription.surfaces[0].radiusMm;
        const Eigen::Vector3d fromCentre = chief->origin + Eigen::Vector3d(0.0, 0.0, radius);
        CHECK(fromCentre.norm() == doctest::Approx(radius).epsilon(1e-12));
        CHECK(fromCentre.dot(chief->direction) > 0.0);
        const auto found =
            fixture.lens->connect(chief->origin + 50.0 * chief->direction, {{0.0, 0.0}}, greenNm);
        REQUIRE(found.has_value());
        CHECK((found->mm - Eigen::Vector2d(height, 0.0)).norm() <= 1e-9);
    }
}

TEST_CASE("TracedLens: a lens of revolution turns with its rays, an anamorphic one mirrors them") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Fixture fixture(shipped);
        const Eigen::Vector2d s(0.3 * fixture.imageHeightMm, -0.2 * fixture.imageHeightMm);
        const double r = fixture.lens->system().aperture.radiusMm();
        const Eigen::Vector2d a(-0.1 * r, 0.2 * r);
        const auto ray = fixture.lens->trace({s}, {a}, greenNm);
        REQUIRE(ray.has_value());
        Eigen::Matrix3d turn = Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal();
        if (!isAnamorphic(fixture.prescription)) turn << 0.8, -0.6, 0.0, 0.6, 0.8, 0.0, 0, 0, 1;
        const Eigen::Matrix2d plane = turn.topLeftCorner<2, 2>();
        const auto turned = fixture.lens->trace({plane * s}, {plane * a}, greenNm);
        REQUIRE(turned.has_value());
        CHECK((turned->direction - turn * ray->direction).norm() <= 1e-12);
        CHECK((turned->origin - turn * ray->origin).norm() <= 1e-10);
        CHECK((turned->directionBySensor - turn * ray->directionBySensor * plane.transpose())
                  .norm() <= 1e-10 * ray->directionBySensor.norm());
        CHECK(turned->throughput == doctest::Approx(ray->throughput).scale(0.0).epsilon(1e-11));
    }
}

TEST_CASE("TracedLens: blades stop what lies outside them") {
    const Prescription prescription = load({"tessar-100mm.toml", 0.0});
    const auto lens = makeTracedLens(prescription, {5.6, {6, 10.0, 0.0}, infinity});
    const Aperture& aperture = lens->system().aperture;
    CHECK(lens->apertureAreaMm2() == aperture.areaMm2());
    const MonochromaticLens atLine(*lens, greenNm);
    LensRandom random(58);
    for (int i = 0; i < 300; ++i) {
        const double r = aperture.radiusMm();
        const AperturePoint a{{random.between(-r, r), random.between(-r, r)}};
        const SensorPoint s = random.onSensor(8.0, 8.0);
        CHECK(lens->trace(s, a, greenNm).has_value() == aperture.contains(a.mm));
        const auto q = atLine.slopeThrough(s, a);
        REQUIRE(q.has_value());
        const TracedRay ray = atLine.traceToScene({s.mm.x(), s.mm.y(), q->x(), q->y()});
        if (!aperture.contains(a.mm)) CHECK(ray.passage.status == TraceStatus::blockedByStop);
    }
}

TEST_CASE("TracedLens: the plane in focus is sharp at the stated distance from the sensor") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        if (isAnamorphic(prescription)) continue;
        const double f = prescription.stated.focalLengthYMm;
        const double length = lengthMm(prescription) + prescription.stated.backFocalDistanceYMm;
        for (const double focus : {length + 6.0 * f, length + 60.0 * f, infinity}) {
            const auto lens = makeTracedLens(prescription, {64.0, {}, focus});
            const double r = 0.05 * lens->system().aperture.radiusMm();
            const auto ray = lens->trace({{0.0, 0.0}}, {{0.0, r}}, dLineNm);
            REQUIRE(ray.has_value());
            const double slope = ray->direction.y() / ray->direction.z();
            // Aberrations leave the paraxial focus by the square of the beam's width over f.
            const double curvature = -slope / ray->origin.y();  // 1/(distance to the focus)
            const double wanted =
                std::isinf(focus) ? 0.0 : 1.0 / (focus + lens->sensorZMm() - ray->origin.z());
            CHECK(std::abs(curvature - wanted) <= 1e-4 / f);
        }
    }
}

TEST_CASE("TracedLens: settings that no lens can have are refused") {
    const Prescription lens = load({"tessar-100mm.toml", 0.0});
    const double nan = std::nan("");
    CHECK_THROWS_AS(makeTracedLens(lens, {1.0, {}, infinity}), std::invalid_argument);
    CHECK_THROWS_AS(makeTracedLens(lens, {0.0, {}, infinity}), std::invalid_argument);
    CHECK_THROWS_AS(makeTracedLens(lens, {nan, {}, infinity}), std::invalid_argument);
    CHECK_THROWS_AS(makeTracedLens(lens, {8.0, {2}, infinity}), std::invalid_argument);
    CHECK_THROWS_AS(makeTracedLens(lens, {8.0, {}, 300.0}), std::invalid_argument);
    CHECK_THROWS_AS(makeTracedLens(lens, {8.0, {}, nan}), std::invalid_argument);
    CHECK_THROWS_AS(TracedLens(lens, Aperture(16.0), 80.0), std::invalid_argument);
    CHECK_THROWS_AS(TracedLens(lens, Aperture(5.0), 0.0), std::invalid_argument);
    CHECK_THROWS_AS(TracedLens(lens, Aperture(5.0), nan), std::invalid_argument);
    Prescription faulty = lens;
    faulty.surfaces[2].radiusMm = 0.0;
    CHECK_THROWS_WITH_AS(
        makeTracedLens(faulty),
        "Tessar, 100 mm f/2.8: surface[2].radius_mm: a radius must differ from 0 (inf for a plane)",
        InputError);
}

}  // namespace
}  // namespace etendue
