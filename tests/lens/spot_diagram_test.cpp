#include "lens/spot_diagram.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace etendue {
namespace {

TEST_CASE("sunflower: it fills the disc evenly") {
    const auto points = sunflower(2.0, 4000);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double squares = 0.0;
    for (const AperturePoint& point : points) {
        CHECK(point.mm.norm() < 2.0);
        sum += point.mm / 4000.0;
        squares += point.mm.squaredNorm() / 4000.0;
    }
    CHECK(sum.norm() < 1e-3);
    CHECK(squares == doctest::Approx(2.0).epsilon(1e-3));  // R²/2
}

TEST_CASE("spotDiagram: an ideal lens images the plane in focus to points") {
    const auto lens = makeThinLens(50.0, 2000.0, 10.0);
    const auto points = spotDiagram(*lens, {300.0, -100.0, 2000.0}, 550.0, sunflower(10.0, 200));
    REQUIRE(points.size() == 200);
    CHECK(spotSize(points).rmsRadiusMm < 1e-12);
}

TEST_CASE("spotDiagram: out of focus the spot is the aperture, scaled") {
    constexpr double focal = 50.0, focus = 2000.0, radius = 10.0, object = 1000.0;
    const auto lens = makeThinLens(focal, focus, radius);
    const auto points = spotDiagram(*lens, {0.0, 0.0, object}, 550.0, sunflower(radius, 4000));
    // The sensor is at v of the plane in focus, the image of the object at v′; the cone of light
    // is R wide at the lens. A disc's rms radius is R/√2.
    const double sensor = 1.0 / (1.0 / focal - 1.0 / focus);
    const double image = 1.0 / (1.0 / focal - 1.0 / object);
    const double blur = radius * std::abs(sensor - image) / image;
    CHECK(spotSize(points).rmsRadiusMm ==
          doctest::Approx(blur / std::numbers::sqrt2).epsilon(1e-3));
    CHECK(spotSize(points).centroidMm.norm() < 1e-3 * blur);
}

TEST_CASE("spotDiagram: a ray that does not pass is no number and counts for nothing") {
    const auto lens = makeThinLens(50.0, 2000.0, 10.0);
    const std::vector<AperturePoint> apertures{{{0.0, 0.0}}, {{11.0, 0.0}}, {{0.0, 5.0}}};
    const auto points = spotDiagram(*lens, {0.0, 0.0, 2000.0}, 550.0, apertures);
    REQUIRE(points.size() == 3);
    CHECK(points[0].allFinite());
    CHECK_FALSE(points[1].allFinite());
    CHECK(spotSize(points).points == 2);
    CHECK(spotSize({}).rmsRadiusMm == 0.0);
}

}  // namespace
}  // namespace etendue
