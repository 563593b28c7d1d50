#include "renderer/filter.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "renderer/random.h"
#include "statistics/statistics.h"

namespace etendue {
namespace {

std::vector<Filter> filters() {
    return {Filter(FilterKind::box),
            Filter(FilterKind::gaussian),
            Filter(FilterKind::blackmanHarris),
            Filter(FilterKind::box, 2.0f),
            Filter(FilterKind::gaussian, 0.7f),
            Filter(FilterKind::blackmanHarris, 3.0f)};
}

/// Simpson's rule for the filter's integral over a rectangle, with `panels` panels on each axis.
double integrate(const Filter& filter, Vec2T<double> low, Vec2T<double> high, int panels) {
    const auto weight = [panels](int i) {
        return i == 0 || i == 2 * panels ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    };
    const double hx = (high.x - low.x) / (2.0 * panels), hy = (high.y - low.y) / (2.0 * panels);
    double sum = 0.0;
    for (int j = 0; j <= 2 * panels; ++j)
        for (int i = 0; i <= 2 * panels; ++i) {
            const Vec2 p{static_cast<float>(low.x + i * hx), static_cast<float>(low.y + j * hy)};
            sum += weight(i) * weight(j) * filter.pdfFilm(p);
        }
    return sum * hx * hy / 9.0;
}

TEST_CASE("Filter: sampling follows the density") {
    constexpr std::size_t cells = 24;  // of the filter's square; with a margin of two all around
    constexpr std::size_t side = cells + 4;
    constexpr int count = 500000;
    const auto all = filters();
    for (const Filter& filter : all) {
        const double width = 2.0 * filter.radius() / cells;
        // The upper edge, which the filter excludes, is approached from below.
        const double edge = filter.radius() * (1.0 - 1e-6);
        std::vector<double> observed(side * side, 0.0), expected(side * side, 0.0);
        for (std::size_t j = 0; j < cells; ++j)
            for (std::size_t i = 0; i < cells; ++i) {
                const Vec2T<double> low{-filter.radius() + width * static_cast<double>(i),
                                        -filter.radius() + width * static_cast<double>(j)};
                const Vec2T<double> high{std::min(low.x + width, edge),
                                         std::min(low.y + width, edge)};
                expected[(j + 2) * side + i + 2] = count * integrate(filter, low, high, 2);
            }
        RandomStream random(1, 0, 0, RandomDomain::test);
        for (int n = 0; n < count; ++n) {
            const Vec2 p = filter.sample(random.next2());
            const auto cell = [&](float x) {
                return static_cast<std::size_t>((x + filter.radius()) / width + 2.0);
            };
            ++observed[cell(p.y) * side + cell(p.x)];
        }
        const ChiSquareResult result = chiSquareTest(observed, expected);
        CHECK(result.countInEmptyCells == 0.0);
        CHECK(result.pValue > sidakLevel(1e-3, all.size()));
    }
}

TEST_CASE("Filter: the density integrates to one") {
    for (const Filter& filter : filters()) {
        const double edge = filter.radius() * (1.0 - 1e-7);
        // 100 panels: Simpson's error is below 1e-7; float densities and the omitted edge add as
        // much each.
        CHECK(integrate(filter, {-filter.radius(), -filter.radius()}, {edge, edge}, 100) ==
              doctest::Approx(1.0).epsilon(1e-6));
    }
}

TEST_CASE("Filter: the default box is exactly one pixel") {
    const Filter box(FilterKind::box);
    CHECK(box.pdfFilm({0.0f, 0.0f}) == 1.0f);
    CHECK(box.pdfFilm({-0.5f, -0.5f}) == 1.0f);
    const float below = std::nextafter(0.5f, 0.0f);
    CHECK(box.pdfFilm({below, below}) == 1.0f);
    // A point on the edge belongs to the next pixel alone.
    CHECK(box.pdfFilm({0.5f, 0.0f}) == 0.0f);
    CHECK(box.pdfFilm({0.0f, 0.5f}) == 0.0f);
    CHECK(box.pdfFilm({std::nextafter(-0.5f, -1.0f), 0.0f}) == 0.0f);
    RandomStream random(2, 0, 0, RandomDomain::test);
    for (int i = 0; i < 1000; ++i) {
        const Vec2 u = random.next2();
        const Vec2 p = box.sample(u);
        CHECK(std::abs(p.x - (u.x - 0.5f)) <= 1e-7f);  // two roundings of numbers below one
        CHECK(std::abs(p.y - (u.y - 0.5f)) <= 1e-7f);
    }
}

TEST_CASE("Filter: sampling inverts the mass to the precision of a float") {
    const auto gaussian = [](double x) {
        return std::erf(3.0 * x / std::numbers::sqrt2) / std::erf(3.0 / std::numbers::sqrt2);
    };
    const auto blackmanHarris = [](double x) {
        const double t = std::numbers::pi * x;
        return x + (0.48829 * std::sin(t) + 0.14128 * std::sin(2.0 * t) / 2.0 +
                    0.01168 * std::sin(3.0 * t) / 3.0) /
                       (0.35875 * std::numbers::pi);
    };
    RandomStream random(4, 0, 0, RandomDomain::test);
    for (int i = 0; i < 20000; ++i) {
        const float u = random.next();
        const double mass = std::abs(2.0 * u - 1.0);
        const auto at = [&](FilterKind kind) {
            return std::abs(double{Filter(kind, 1.0f).sample({u, 0.0f}).x});
        };
        // 1.5e-8 of the table; rounding the result by 2⁻²⁵ moves the mass by up to 2.8 times that,
        // the highest density.
        CHECK(std::abs(gaussian(at(FilterKind::gaussian)) - mass) <= 1.5e-8 + 2.8 * 0x1p-25);
        CHECK(std::abs(blackmanHarris(at(FilterKind::blackmanHarris)) - mass) <=
              1.5e-8 + 2.8 * 0x1p-25);
    }
}

TEST_CASE("Filter: the Gaussian's standard deviation is a third of its radius") {
    const Filter filter(FilterKind::gaussian, 1.5f);
    const float peak = filter.pdfFilm({0.0f, 0.0f});
    for (const float x : {0.25f, 0.5f, 1.0f, 1.4375f})
        // x² is exact in float; the two densities round once each.
        CHECK(filter.pdfFilm({x, -0.5f}) / peak ==
              doctest::Approx(std::exp(-2.0 * (x * x + 0.25))).epsilon(2.5e-7));
    // The mean of x², ∫ x² of a Gaussian cut at ±3σ: σ² (1 − 6 φ(3) / erf(3/√2)).
    const double cut = 1.0 - 6.0 * std::exp(-4.5) / std::sqrt(2.0 * std::numbers::pi) /
                                 std::erf(3.0 / std::numbers::sqrt2);
    std::vector<double> squares;
    RandomStream random(3, 0, 0, RandomDomain::test);
    for (int i = 0; i < 100000; ++i) {
        const Vec2 p = filter.sample(random.next2());
        squares.push_back(static_cast<double>(p.x) * p.x);
    }
    const Summary summary = summarize(squares);
    CHECK(normalTwoSidedP((summary.mean - 0.25 * cut) / summary.standardError) > 1e-3);
}

TEST_CASE("Filter: the Blackman-Harris window has the published coefficients") {
    const Filter filter(FilterKind::blackmanHarris, 1.0f);
    // Harris 1978: the window is 1 at its centre, 6e-5 at its edge and has mean 0.35875; halfway
    // the first and third cosines vanish and the second is −1.
    const auto window = [&](float x) {
        return filter.pdfFilm({x, 0.0f}) / filter.pdfFilm({0.0f, 0.0f});
    };
    CHECK(window(0.5f) == doctest::Approx(0.35875 - 0.14128).epsilon(1e-6));
    CHECK(window(-1.0f) == doctest::Approx(6e-5).epsilon(1e-4));  // cancels to 4 digits of 6e-5
    CHECK(filter.pdfFilm({0.0f, 0.0f}) ==
          doctest::Approx(std::pow(0.5 / 0.35875, 2)).epsilon(1e-6));
}

TEST_CASE(
    "Filter: random numbers at the edge of their range stay inside, where the density is not "
    "zero") {
    const float edges[] = {
        0.0f,           0x1p-32f, 0x1p-24f, 0.5f, std::nextafter(0.5f, 0.0f), 1.0f - 0x1p-23f,
        1.0f - 0x1p-24f};
    for (const FilterKind kind :
         {FilterKind::box, FilterKind::gaussian, FilterKind::blackmanHarris})
        for (const float radius : {0.1f, 0.5f, 1.0f, 1.5f, 1.9999999f, 7.3f}) {
            const Filter filter(kind, radius);
            for (const float x : edges)
                for (const float y : edges) {
                    const Vec2 p = filter.sample({x, y});
                    CHECK(filter.pdfFilm(p) > 0.0f);
                    CHECK(std::isfinite(filter.pdfFilm(p)));
                }
        }
}

TEST_CASE("Filter: it is even, in sampling and in density") {
    for (const Filter& filter : filters())
        for (int i = 1; i < 64; ++i) {
            const float u = static_cast<float>(i) / 64.0f;  // 1 − u is exact
            const Vec2 p = filter.sample({u, 0.5f});
            const Vec2 q = filter.sample({1.0f - u, 0.5f});
            CHECK(p.x == -q.x);
            CHECK(p.y == 0.0f);
            CHECK(filter.pdfFilm({p.x, 0.1f}) == filter.pdfFilm({-p.x, 0.1f}));
        }
}

TEST_CASE("Filter: a point that is no number has no density") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Filter& filter : filters()) {
        CHECK(filter.pdfFilm({nan, 0.0f}) == 0.0f);
        CHECK(filter.pdfFilm({0.0f, nan}) == 0.0f);
        CHECK(filter.pdfFilm({std::numeric_limits<float>::infinity(), 0.0f}) == 0.0f);
    }
}

TEST_CASE("Filter: a radius that is not positive is refused") {
    for (const float radius : {0.0f, -1.0f, std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::quiet_NaN()})
        CHECK_THROWS_AS(Filter(FilterKind::gaussian, radius), std::invalid_argument);
}

}  // namespace
}  // namespace etendue
