#include "lens/illumination.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "lens/field.h"
#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

/// A stop behind a round window of nothing, `gapMm` in front of it.
TracedLens windowAndStop(double windowRadiusMm, double gapMm, double stopRadiusMm,
                         double sensorDistanceMm) {
    const double infinity = std::numeric_limits<double>::infinity();
    Prescription lens = singlet(infinity, infinity, 1e-6, 1.0, windowRadiusMm);
    lens.surfaces[1].thicknessMm = gapMm;
    lens.surfaces[1].semiApertureMm = 1e3;
    lens.surfaces.back() = stop(1.0, stopRadiusMm);
    return TracedLens(lens, Aperture(stopRadiusMm), sensorDistanceMm);
}

/// Of two discs whose centres are `distance` apart and whose rims cross.
double sharedArea(double r, double s, double distance) {
    const double d2 = distance * distance;
    const double a = std::acos((d2 + r * r - s * s) / (2.0 * distance * r));
    const double b = std::acos((d2 + s * s - r * r) / (2.0 * distance * s));
    return r * r * (a - 0.5 * std::sin(2.0 * a)) + s * s * (b - 0.5 * std::sin(2.0 * b));
}

TEST_CASE("illuminationCurve: through a small hole it falls by cos⁴ alone") {
    const TracedLens lens = windowAndStop(100.0, 1.0, 0.05, 30.0);
    for (const Illumination& at : illuminationCurve(lens, Eigen::Vector2d::UnitX(), 30.0, 7, 50)) {
        const double cosine = std::cos(std::atan(at.heightMm / 30.0));
        CHECK(at.cosFourth == doctest::Approx(std::pow(cosine, 4)).epsilon(1e-9));
        CHECK(at.total == doctest::Approx(at.cosFourth).epsilon(1e-4));  // the hole is 1/600 wide
        CHECK(at.vignetting == doctest::Approx(1.0));
        CHECK(at.rest == doctest::Approx(1.0).epsilon(1e-4));
    }
}

TEST_CASE("illuminationCurve: a window in front cuts what two discs do not share") {
    constexpr double radius = 4.0, gap = 20.0, distance = 40.0;
    const TracedLens lens = windowAndStop(radius, gap, radius, distance);
    // From a point on the sensor the window appears in the plane of the stop smaller, and moved.
    const double scale = distance / (distance + gap), window = scale * radius;
    int cut = 0;
    for (const Illumination& at :
         illuminationCurve(lens, Eigen::Vector2d::UnitY(), 16.0, 9, 10'000)) {
        const double moved = at.heightMm * (1.0 - scale);
        const bool isWhole = moved <= radius - window;
        const double share =
            isWhole ? 1.0
                    : sharedArea(window, radius, moved) / (std::numbers::pi * window * window);
        cut += isWhole ? 0 : 1;
        // 4400 of the points are in the window, 240 of their cells at its rim, of which the error
        // is at most about the square root.
        CHECK(at.vignetting == doctest::Approx(share).epsilon(0.01));
    }
    CHECK(cut >= 4);
}

TEST_CASE("illuminationCurve: its parts make up what the field measures") {
    const auto lens = makeTracedLens(loadPrescription(lensFile("petzval-50mm.toml")));
    double vignettingBefore = 1.01;
    for (const Illumination& at :
         illuminationCurve(*lens, Eigen::Vector2d::UnitY(), 16.0, 5, 4000)) {
        CHECK(at.total ==
              doctest::Approx(relativeIllumination(*lens, {{0.0, at.heightMm}}, dLineNm, 60))
                  .epsilon(0.02));
        CHECK(at.total == doctest::Approx(at.cosFourth * at.vignetting * at.rest).epsilon(1e-12));
        CHECK(at.vignetting <= vignettingBefore);
        vignettingBefore = at.vignetting;
    }
    CHECK(vignettingBefore < 0.8);
}

}  // namespace
}  // namespace etendue
