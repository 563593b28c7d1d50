#include "lens/chromatic.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

constexpr double farAway = std::numeric_limits<double>::infinity();

TEST_CASE("focusShiftMm: close to the axis it is the paraxial focus of the wavelength") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        if (isAnamorphic(prescription)) continue;  // the sensor is between two foci
        const auto lens = makeTracedLens(prescription);
        const double atD = sensorDistanceMm(paraxialData(lens->system()), farAway);
        for (const double wavelength : {fLineNm, cLineNm}) {
            const double there =
                sensorDistanceMm(paraxialData(lens->system(), wavelength), farAway);
            const double found =
                focusShiftMm(*lens, Eigen::Vector2d::UnitY(), 1e-2, wavelength, farAway);
            // From a ray at 1/100 of the aperture: spherical aberration is 1e-4 of what it is at
            // the rim, up to 4e-4 mm (220° fisheye); and the solve's 1e-9 rad are 1e-4 mm along so
            // flat a ray.
            CHECK(found == doctest::Approx(atD - there).scale(1.0).epsilon(5e-4));
        }
    }
}

TEST_CASE("lateralColourMm: none at the d line, and none where glass does not disperse") {
    const auto tessar = makeTracedLens(loadPrescription(lensFile("tessar-100mm.toml")));
    const Eigen::Vector2d along = Eigen::Vector2d::UnitX();
    CHECK(std::abs(lateralColourMm(*tessar, along, 20.0, dLineNm, farAway)) < 1e-7);
    CHECK(std::abs(lateralColourMm(*tessar, along, 20.0, gLineNm, farAway)) > 1e-4);

    const auto plain = makeTracedLens(singlet(60.0, -60.0, 5.0, 1.5, 10.0));
    CHECK(std::abs(lateralColourMm(*plain, along, 10.0, gLineNm, farAway)) < 1e-7);
}

TEST_CASE("lateralColourMm: none where the chief ray is blocked") {
    const auto lens = makeTracedLens(loadPrescription(lensFile("anamorphic-80x90mm.toml")));
    const Eigen::Vector2d along = Eigen::Vector2d::UnitY();
    CHECK(std::isfinite(lateralColourMm(*lens, along, 5.0, fLineNm, farAway)));
    CHECK(std::isnan(lateralColourMm(*lens, along, 7.2, cLineNm, farAway)));
}

TEST_CASE("lateralColourMm: a simple lens with its stop behind spreads blue inward") {
    // The stop is behind: chief rays cross the lens above the axis and are bent back toward it,
    // blue more than red.
    Prescription lens = singlet(60.0, -60.0, 5.0, 1.5, 10.0);
    lens.surfaces[0].behind = glassFromCatalogue("N-BK7");
    lens.surfaces[1].thicknessMm = 15.0;
    const auto traced = makeTracedLens(lens);
    const Eigen::Vector2d along = Eigen::Vector2d::UnitY();
    const double blue = lateralColourMm(*traced, along, 5.0, fLineNm, farAway);
    const double red = lateralColourMm(*traced, along, 5.0, cLineNm, farAway);
    CHECK(blue * red < 0.0);
    CHECK(std::isfinite(blue));
    CHECK(std::isnan(lateralColourMm(*traced, along, 500.0, fLineNm, farAway)));
}

}  // namespace
}  // namespace etendue
