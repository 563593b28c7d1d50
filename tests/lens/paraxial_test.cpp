#include "lens/paraxial.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "lens/axial_beam.h"
#include "lens/sequential_trace.h"
#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A ray traced from the scene through all surfaces at the d line, exactly.
LensRay<double> throughLens(const OpticalSystem& system, LensRay<double> ray) {
    const std::vector<double> indices = refractiveIndices(system, dLineNm);
    const Passage passage = carryToSensor<TraceMode::geometry>(
        {system, indices, dLineNm}, 0, system.surfaces.size(), ray, [](auto...) {});
    REQUIRE(passage.status == TraceStatus::passed);
    return ray;
}

TEST_CASE("paraxialData: a thick lens obeys the lensmaker's equation") {
    const double r1 = 80.0, r2 = -120.0, t = 9.0, n = 1.6;
    const ParaxialAxis axis = paraxialData(OpticalSystem(singlet(r1, r2, t, n, 10.0))).y;
    const double power = (n - 1.0) * (1.0 / r1 - 1.0 / r2 + (n - 1.0) * t / (n * r1 * r2));
    const double f = 1.0 / power;
    // BFL = f (1 − (n−1) t/(n r1)) from the rear glass; the stop lies 2 mm behind it.
    CHECK(axis.focalLengthMm == doctest::Approx(f).epsilon(1e-13));
    CHECK(axis.backFocalDistanceMm ==
          doctest::Approx(f * (1.0 - (n - 1.0) * t / (n * r1)) - 2.0).epsilon(1e-13));
    CHECK(axis.frontFocalDistanceMm ==
          doctest::Approx(f * (1.0 + (n - 1.0) * t / (n * r2))).epsilon(1e-13));
    // Principal planes, from the front and the rear vertex.
    CHECK(axis.frontPrincipalZMm == doctest::Approx(axis.frontFocalDistanceMm - f).epsilon(1e-12));
    CHECK(axis.rearPrincipalZMm ==
          doctest::Approx(-t - 2.0 - axis.backFocalDistanceMm + f).epsilon(1e-12));
}

TEST_CASE(
    "paraxialData: a stop behind a thin lens has its entrance pupil where the lens images it") {
    // Thickness 1e-9 and a stop 20 mm behind f = 50 mm: image at 1/(1/50 − 1/20) = −33.3 mm, that
    // is 33.3 mm behind the lens, and 5/3 as large. Nothing lies between the stop and the sensor.
    Prescription prescription = singlet(50.0, -50.0, 1e-9, 1.5, 1e-5);
    prescription.surfaces[1].thicknessMm = 20.0;
    const ParaxialAxis axis = paraxialData(OpticalSystem(prescription)).x;
    CHECK(axis.focalLengthMm == doctest::Approx(50.0).epsilon(1e-9));
    CHECK(axis.entrancePupilZMm == doctest::Approx(-100.0 / 3.0).epsilon(1e-9));
    CHECK(axis.entrancePupilPerStop == doctest::Approx(5.0 / 3.0).epsilon(1e-9));
    CHECK(axis.exitPupilZMm == doctest::Approx(-20.0).epsilon(1e-9));
    CHECK(axis.exitPupilPerStop == doctest::Approx(1.0).epsilon(1e-12));
    CHECK(fNumber(paraxialData(OpticalSystem(prescription)), 3.0) ==
          doctest::Approx(5.0).epsilon(1e-9));
}

TEST_CASE("paraxialData: a stop in glass is seen through the surface in front of it") {
    // Behind a plane of index n at depth d it appears at d/n, as large as it is; behind a sphere
    // n/s′ = … gives z = −1/(n/d − (n − 1)/R), larger by n |z|/d.
    const double n = 1.5, depth = 12.0;
    for (const double radius : {30.0, -45.0, std::numeric_limits<double>::infinity()}) {
        Prescription prescription;
        prescription.surfaces = {spherical(radius, depth, 5.0, plainGlass(n)), stop(20.0, 3.0),
                                 spherical(-40.0, 50.0, 5.0)};
        prescription.surfaces[1].behind = plainGlass(n);
        const ParaxialAxis axis = paraxialData(OpticalSystem(prescription)).y;
        const double image = 1.0 / (n / depth - (n - 1.0) / radius);
        CHECK(axis.entrancePupilZMm == doctest::Approx(-image).epsilon(1e-13));
        CHECK(axis.entrancePupilPerStop == doctest::Approx(n * image / depth).epsilon(1e-13));
    }
}

TEST_CASE("paraxialData: in every lens it is the limit of exact rays near the axis") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const OpticalSystem system(load(shipped));
        const ParaxialData data = paraxialData(system);
        const double f = data.y.focalLengthMm, h = 1e-4 * f;
        // From the axis by h: aberrations are of order (h/f)² = 1e-8, times what a fast lens
        // multiplies them by; rounding 1e-16/1e-4.
        for (const bool inX : {false, true}) {
            const ParaxialAxis& axis = inX ? data.x : data.y;
            const auto across = [inX](const Vector3<double>& v) { return inX ? v.x : v.y; };
            const auto offset = [inX](double value) {
                return inX ? Vector3<double>{value, 0, 0} : Vector3<double>{0, value, 0};
            };
            const LensRay<double> parallel = throughLens(system, {offset(h), {0.0, 0.0, -1.0}});
            const double slope = across(parallel.direction) / parallel.direction.z;
            const double focusZ = parallel.origin.z - across(parallel.origin) / slope;
            CHECK(h / slope == doctest::Approx(axis.focalLengthMm).epsilon(1e-6));
            CHECK(data.lastVertexZMm - focusZ ==
                  doctest::Approx(axis.backFocalDistanceMm).epsilon(1e-6));
        }
        // A ray aimed at the entrance pupil's centre leaves the exit pupil's.
        if (!std::isfinite(data.y.entrancePupilZMm)) continue;
        const double tilt = 1e-4;
        const LensRay<double> chief =
            throughLens(system, {{0.0, -tilt * data.y.entrancePupilZMm, 0.0},
                                 normalized(Vector3<double>{0.0, -tilt, -1.0})});
        const double exitZ =
            chief.origin.z - chief.origin.y * chief.direction.z / chief.direction.y;
        CHECK(exitZ == doctest::Approx(data.y.exitPupilZMm).epsilon(1e-6));
    }
}

TEST_CASE("paraxialData: focal lengths shorten toward the blue in a simple lens") {
    Prescription prescription = singlet(50.0, -50.0, 4.0, 1.5, 10.0);
    prescription.surfaces[0].behind = glassFromCatalogue("N-BK7");
    const OpticalSystem system(prescription);
    CHECK(paraxialData(system, fLineNm).y.focalLengthMm <
          paraxialData(system, dLineNm).y.focalLengthMm);
    CHECK(paraxialData(system, dLineNm).y.focalLengthMm <
          paraxialData(system, cLineNm).y.focalLengthMm);
}

TEST_CASE("sensorDistanceMm: an object at the stated distance from the sensor is sharp") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const OpticalSystem system(load(shipped));
        const ParaxialData data = paraxialData(system);
        CHECK(sensorDistanceMm(data, infinity) ==
              doctest::Approx(0.5 * (data.x.backFocalDistanceMm + data.y.backFocalDistanceMm)));
        if (isAnamorphic(load(shipped))) continue;  // x and y are sharp at different distances
        for (const double times : {20.0, 100.0, 1e4}) {
            const double object = times * data.y.focalLengthMm - data.lastVertexZMm;
            const double sensor = sensorDistanceMm(data, object);
            const double objectZ = object + data.lastVertexZMm - sensor;
            const double tilt = 1e-4 * data.y.focalLengthMm / object;
            const LensRay<double> ray = throughLens(
                system, {{0.0, tilt * objectZ, 0.0}, normalized(Vector3<double>{0.0, tilt, -1.0})});
            const double focusZ = ray.origin.z - ray.origin.y * ray.direction.z / ray.direction.y;
            CHECK(data.lastVertexZMm - focusZ == doctest::Approx(sensor).epsilon(1e-6));
        }
    }
}

TEST_CASE("sensorDistanceMm: nearest is where object and image are equally large") {
    const ParaxialData data = paraxialData(OpticalSystem(load({"tessar-100mm.toml", 0.0})));
    const double f = data.y.focalLengthMm;
    const double nearest =
        data.y.frontFocalDistanceMm - data.lastVertexZMm + data.y.backFocalDistanceMm + 2.0 * f;
    // There x = x′ = f.
    CHECK(sensorDistanceMm(data, nearest * (1.0 + 1e-14)) ==
          doctest::Approx(data.y.backFocalDistanceMm + f).epsilon(1e-5));
    CHECK_THROWS_AS(sensorDistanceMm(data, nearest * 0.999), std::invalid_argument);
    CHECK_THROWS_AS(sensorDistanceMm(data, 0.0), std::invalid_argument);
    CHECK_THROWS_AS(sensorDistanceMm(data, -1e4), std::invalid_argument);
    CHECK_THROWS_AS(sensorDistanceMm(data, std::nan("")), std::invalid_argument);
}

TEST_CASE("stopMap: it is the limit of exact rays from the sensor near the axis") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const OpticalSystem system(load(shipped));
        const ParaxialData data = paraxialData(system);
        const double distance = sensorDistanceMm(data, infinity);
        const StopMap map = stopMap(system, distance);
        const std::vector<double> indices = refractiveIndices(system, dLineNm);
        const double s = 1e-4 * data.y.focalLengthMm, q = 1e-4;
        LensRay<double> ray{{s, -s, data.lastVertexZMm - distance},
                            normalized(Vector3<double>{q, 2.0 * q, 1.0})};
        const Passage passage = carryToScene<TraceMode::geometry>(
            {system, indices, dLineNm}, system.stop, system.surfaces.size(), ray, [](auto...) {});
        REQUIRE(passage.status == TraceStatus::passed);
        // As above; the two terms of a may cancel down to a tenth.
        const double size = 1e-6 * (std::abs(map.bySlope.x() * q) + std::abs(map.bySensor.x() * s));
        CHECK(std::abs(ray.origin.x - map.bySensor.x() * s - map.bySlope.x() * q) <= size);
        CHECK(std::abs(ray.origin.y + map.bySensor.y() * s - map.bySlope.y() * 2.0 * q) <=
              2.0 * size);
    }
}

TEST_CASE("stopRadiusForFNumber: stated f-numbers open every lens, and small ones are paraxial") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        const OpticalSystem system(prescription);
        const double radius = stopRadiusForFNumber(system, prescription.stated.fNumber);
        CHECK(radius <= system.surfaces[system.stop].semiApertureMm);
        const ParaxialData data = paraxialData(system);
        // Aberrations of the pupil are of order 1/N², here 1e-4 times a few.
        CHECK(stopRadiusForFNumber(system, 128.0) ==
              doctest::Approx(stopRadiusMm(data, 128.0)).epsilon(1e-3));
        CHECK(fNumber(data, stopRadiusMm(data, 7.0)) == doctest::Approx(7.0).epsilon(1e-14));
        CHECK_THROWS_AS(stopRadiusForFNumber(system, 0.3), std::invalid_argument);
        CHECK_THROWS_AS(stopRadiusForFNumber(system, -1.0), std::invalid_argument);
        CHECK_THROWS_AS(stopRadiusForFNumber(system, std::nan("")), std::invalid_argument);
    }
}

}  // namespace
}  // namespace etendue
