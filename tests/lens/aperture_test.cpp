#include "lens/aperture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "statistics/statistics.h"
#include "tests/lens/lens_checks.h"

namespace etendue {
namespace {

std::vector<Aperture> apertures() {
    std::vector<Aperture> all{Aperture(3.0)};
    for (const int count : {3, 5, 6, 9})
        for (const double roundness : {0.0, 0.3, 0.9, 1.0})
            all.push_back(Aperture(3.0, {count, 17.0, roundness}));
    return all;
}

/// ½ ∮ r² dφ with r found by bisection on contains(): midpoint rule over angles.
double areaByContainment(const Aperture& aperture) {
    constexpr int angles = 2880;
    double sum = 0.0;
    for (int i = 0; i < angles; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i + 0.5) / angles;
        const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
        double low = 0.0, high = 2.0 * aperture.radiusMm();
        for (int j = 0; j < 34; ++j) {
            const double middle = 0.5 * (low + high);
            (aperture.contains(middle * along) ? low : high) = middle;
        }
        sum += low * low;
    }
    return sum * std::numbers::pi / angles;
}

TEST_CASE("Aperture: a circle has a circle's area, a polygon a polygon's") {
    CHECK(Aperture(3.0).areaMm2() == doctest::Approx(9.0 * std::numbers::pi).epsilon(1e-15));
    CHECK(Aperture(3.0, {6, 11.0, 1.0}).areaMm2() ==
          doctest::Approx(9.0 * std::numbers::pi).epsilon(1e-15));
    CHECK(Aperture(3.0, {4}).areaMm2() == doctest::Approx(18.0).epsilon(1e-14));
    CHECK(Aperture(3.0, {6}).areaMm2() ==
          doctest::Approx(9.0 * 1.5 * std::sqrt(3.0)).epsilon(1e-14));
}

TEST_CASE("Aperture: its area is what its containment test encloses") {
    for (const Aperture& aperture : apertures())
        // The midpoint rule errs at the corners alone, where the slope of r² jumps by up to 7 R²:
        // by up to 7/16 R² δ² for each, 2e-6 R² with δ = 2π/2880.
        CHECK(areaByContainment(aperture) == doctest::Approx(aperture.areaMm2()).epsilon(6e-6));
}

TEST_CASE("Aperture: roundness opens it from the polygon to the circle") {
    const double polygon = Aperture(3.0, {5}).areaMm2(), circle = Aperture(3.0).areaMm2();
    CHECK(Aperture(3.0, {5, 0.0, 0.25}).areaMm2() ==
          doctest::Approx(0.75 * polygon + 0.25 * circle).epsilon(1e-14));
}

TEST_CASE("Aperture: a corner points along +x turned by the rotation") {
    const Aperture square(2.0, {4, 30.0, 0.0});
    const double angle = std::numbers::pi / 6.0;
    const Eigen::Vector2d corner(std::cos(angle), std::sin(angle));
    CHECK(square.contains(1.999 * corner));
    CHECK_FALSE(square.contains(2.001 * corner));
    const Eigen::Vector2d edge(std::cos(angle + 0.25 * std::numbers::pi),
                               std::sin(angle + 0.25 * std::numbers::pi));
    CHECK(square.contains(1.414 * edge));
    CHECK_FALSE(square.contains(1.4145 * edge));
}

TEST_CASE("Aperture: samples lie inside and are uniform") {
    const std::vector<Aperture> all = apertures();
    const double level = sidakLevel(1e-3, all.size());
    LensRandom random(11);
    for (const Aperture& aperture : all) {
        // Square cells; what falls into one is proportional to its share of the area, counted on
        // a grid 40 times as fine: cells on the edge are known to about 1/40 · 1/40 of a cell.
        constexpr int cells = 8, fine = 40, count = 40000;
        std::vector<double> observed(cells * cells, 0.0), expected(cells * cells, 0.0);
        const double r = aperture.radiusMm();
        const auto cellOf = [&](double x, double y) {
            const auto index = [r](double v) {
                return std::clamp(static_cast<int>((v / r + 1.0) * 0.5 * cells), 0, cells - 1);
            };
            return static_cast<std::size_t>(index(y) * cells + index(x));
        };
        double inside = 0.0;
        for (int j = 0; j < cells * fine; ++j)
            for (int i = 0; i < cells * fine; ++i) {
                const double x = r * (2.0 * (i + 0.5) / (cells * fine) - 1.0);
                const double y = r * (2.0 * (j + 0.5) / (cells * fine) - 1.0);
                if (!aperture.contains({x, y})) continue;
                expected[cellOf(x, y)] += 1.0;
                inside += 1.0;
            }
        for (double& share : expected) share *= count / inside;
        bool allInside = true;
        for (int i = 0; i < count; ++i) {
            const Eigen::Vector2d a = aperture.sample(random.inUnitSquare());
            allInside = allInside && aperture.contains(a);
            observed[cellOf(a.x(), a.y())] += 1.0;
        }
        CHECK(allInside);
        CHECK(chiSquareTest(observed, expected).pValue > level);
    }
}

TEST_CASE("Aperture: random numbers at the edge of their range give points inside") {
    for (const Aperture& aperture : apertures())
        for (const double x : {0.0, 0x1p-32, 0.2, 0.5, 1.0 - 0x1p-24, 1.0 - 0x1p-53})
            for (const double y : {0.0, 0x1p-32, 0.5, 1.0 - 0x1p-24, 1.0 - 0x1p-53})
                CHECK(aperture.contains(aperture.sample({x, y})));
}

TEST_CASE("Aperture: what cannot be an aperture is refused") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double radius : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()})
        CHECK_THROWS_AS(Aperture{radius}, std::invalid_argument);
    for (const int count : {-3, 1, 2})
        CHECK_THROWS_AS(Aperture(1.0, {count, 0.0, 0.0}), std::invalid_argument);
    for (const double roundness : {-0.1, 1.1, nan})
        CHECK_THROWS_AS(Aperture(1.0, {6, 0.0, roundness}), std::invalid_argument);
    CHECK_THROWS_AS(Aperture(1.0, {6, nan, 0.0}), std::invalid_argument);
    CHECK_FALSE(Aperture(1.0).contains({nan, 0.0}));
}

}  // namespace
}  // namespace etendue
