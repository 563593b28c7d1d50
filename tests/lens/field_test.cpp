#include "lens/field.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "lens/fit_domain.h"
#include "tests/lens/lens_checks.h"
#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

/// Irradiance under unit radiance, ∫ cos⁴θ τ d²q, by rays through a fine grid over the last
/// surface: no aperture point, no solve, no Jacobian.
double irradianceBySlopes(const TracedLens& lens, double height) {
    constexpr int grid = 160;
    const MonochromaticLens atLine(lens, dLineNm);
    const TracedSurface& last = lens.system().surfaces.back();
    const double distance = last.vertexZMm - lens.sensorZMm();
    double sum = 0.0;
    for (int i = 0; i < grid; ++i)
        for (int j = 0; j < grid; ++j) {
            const double x = last.semiApertureMm * (2.0 * (i + 0.5) / grid - 1.0);
            const double y = last.semiApertureMm * (2.0 * (j + 0.5) / grid - 1.0);
            const SensorState state{0.0, height, x / distance, (y - height) / distance};
            const TracedRay ray = atLine.traceToScene(state);
            if (ray.passage.status != TraceStatus::passed) continue;
            const double squared = state.slopeX * state.slopeX + state.slopeY * state.slopeY;
            sum += ray.passage.transmittance / ((1.0 + squared) * (1.0 + squared));
        }
    return sum;
}

TEST_CASE("relativeIllumination: it is what rays in all directions from the sensor add up to") {
    for (const ShippedLens& shipped :
         {ShippedLens{"tessar-100mm.toml", 30.0}, ShippedLens{"double-gauss-50mm-f1.1.toml", 14.0},
          ShippedLens{"fisheye-220-6mm-f2.8.toml", 8.0}, ShippedLens{"fisheye-10mm.toml", 12.0}}) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        const double height = shipped.imageHeightMm;
        const auto lens = makeTracedLens(prescription, {prescription.stated.fNumber});
        const double expected = irradianceBySlopes(*lens, height) / irradianceBySlopes(*lens, 0.0);
        // A grid counts the cells along a rim all or not at all. Of a beam m cells wide that is
        // an error of about m^-1.5; the narrowest here, a fisheye's, is 25 cells wide.
        CHECK(relativeIllumination(*lens, {{0.0, height}}, dLineNm, 60) ==
              doctest::Approx(expected).epsilon(0.02));
    }
}

TEST_CASE("relativeIllumination: it is 1 on the axis and falls toward the edge") {
    const auto lens = makeTracedLens(loadPrescription(lensFile("tessar-100mm.toml")), {2.81});
    double before = 1.0 + 1e-12;
    for (const double height : {0.0, 10.0, 20.0, 30.0, 40.0, 55.0}) {
        const double found = relativeIllumination(*lens, {{height, 0.0}});
        CHECK(found <= before);
        before = found;
    }
    CHECK(before < 0.3);
}

TEST_CASE("imageHeightMm: the picture ends where the illumination falls below the share") {
    for (const auto& file : {"tessar-100mm.toml", "fisheye-181-10mm.toml"}) {
        CAPTURE(file);
        const Prescription prescription = loadPrescription(lensFile(file));
        const auto lens = makeTracedLens(prescription, {prescription.stated.fNumber});
        const double height = imageHeightMm(*lens, {0.0, 1.0}, 0.2);
        CHECK(relativeIllumination(*lens, {{0.0, height * 0.999}}) >= 0.2);
        CHECK(relativeIllumination(*lens, {{0.0, height * 1.001}}) < 0.2);
        CHECK(imageHeightMm(*lens, {1.0, 0.0}, 0.05) >= height);
    }
}

TEST_CASE("imageHeightMm: without light on the axis there is no picture, and no endless search") {
    // None of the points that the aperture is sampled in lies where the rims let light through.
    Prescription tessar = loadPrescription(lensFile("tessar-100mm.toml"));
    tessar.surfaces[stopIndex(tessar)].semiApertureMm = 300.0;
    const auto lens = makeTracedLens(tessar);
    CHECK(imageHeightMm(*lens, {1.0, 0.0}, 1e-3) == 0.0);
    CHECK(relativeIllumination(*lens, {{0.0, 0.0}}, dLineNm, 12) == 0.0);
    CHECK_THROWS_AS(fitDomain(tessar, {}), std::invalid_argument);
}

TEST_CASE("relativeIllumination: there is no lens beyond 350–1100 nm") {
    const auto lens = makeTracedLens(loadPrescription(lensFile("tessar-100mm.toml")));
    for (const double wavelength : {200.0, 349.9, 1100.1, 5000.0, std::nan("")}) {
        CHECK_THROWS_AS(relativeIllumination(*lens, {{0.0, 1.0}}, wavelength),
                        std::invalid_argument);
        CHECK_THROWS_AS(MonochromaticLens(*lens, wavelength), std::invalid_argument);
    }
}

TEST_CASE("fieldOfView: a small sensor sees its size over the focal length") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        const auto lens = makeTracedLens(prescription);
        const double fx = prescription.stated.focalLengthXMm;
        const double fy = prescription.stated.focalLengthYMm;
        const FieldOfView field = fieldOfView(*lens, 0.02 * fx, 0.01 * fy);
        // Distortion is of the order of the field squared, 1e-4; the header has 4 digits. The
        // foci of an anamorphic lens differ, and a sensor between them sees a percent more or less.
        const double tolerance = isAnamorphic(prescription) ? 0.02 : 2e-3;
        const double degree = 180.0 / std::numbers::pi;
        CHECK(field.horizontalDegrees == doctest::Approx(0.02 * degree).epsilon(tolerance));
        CHECK(field.verticalDegrees == doctest::Approx(0.01 * degree).epsilon(tolerance));
        CHECK(field.diagonalDegrees ==
              doctest::Approx(std::sqrt(5e-4) * degree).epsilon(tolerance));
    }
}

TEST_CASE("fieldOfView: the 10 mm fisheye sees 180° and more on its format's diagonal") {
    // The lens's role: 180° over the 28.3 mm of a 23.7 × 15.6 mm sensor.
    const auto lens = makeTracedLens(loadPrescription(lensFile("fisheye-10mm.toml")));
    const FieldOfView field = fieldOfView(*lens, 22.0, 14.6);
    CHECK(field.diagonalDegrees > 170.0);
    CHECK(field.diagonalDegrees < 200.0);
    CHECK(field.horizontalDegrees < field.diagonalDegrees);
    CHECK(std::isnan(fieldOfView(*lens, 80.0, 80.0).diagonalDegrees));
}

}  // namespace
}  // namespace etendue
