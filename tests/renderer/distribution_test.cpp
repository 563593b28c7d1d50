#include "renderer/distribution.h"

#include <doctest/doctest.h>

#include <numeric>
#include <vector>

#include "tests/support/estimate.h"

using namespace etendue;

namespace {

constexpr double largestBelowOne = 1.0 - 0x1p-53;

std::size_t bin(double unit, std::size_t bins) {
    return std::min(static_cast<std::size_t>(unit * static_cast<double>(bins)), bins - 1);
}

const std::vector<double> weightsWithGaps{0.0, 3.0, 0.0, 0.0, 1.0, 0.5, 7.0, 0.25, 0.0};

}  // namespace

TEST_CASE("unitFloat: rounding never reaches one") {
    CHECK(unitFloat(0.0) == 0.0f);
    CHECK(unitFloat(largestBelowOne) < 1.0f);
    CHECK(unitFloat(0.25) == 0.25f);
}

TEST_CASE("Distribution1D: indices come up by weight, and the remainder is uniform in each") {
    const Distribution1D distribution(weightsWithGaps);
    constexpr std::uint32_t count = 200'000;
    constexpr std::size_t bins = 16;
    std::vector<double> observed(weightsWithGaps.size() * bins), expected;
    for (std::uint32_t i = 0; i < count; ++i) {
        RandomStream random(1, i, 0, RandomDomain::test);
        const auto s = distribution.sample(random.next());
        REQUIRE(s);
        REQUIRE(s->remainder >= 0.0);
        REQUIRE(s->remainder < 1.0);
        REQUIRE(s->probability == distribution.probability(s->index));
        ++observed[s->index * bins + bin(s->remainder, bins)];
    }
    const double total = std::accumulate(weightsWithGaps.begin(), weightsWithGaps.end(), 0.0);
    for (const double w : weightsWithGaps)
        expected.insert(expected.end(), bins, count * w / total / bins);
    const ChiSquareResult result = chiSquareTest(observed, expected);
    CHECK(result.countInEmptyCells == 0.0);
    CHECK(result.pValue > falseAlarmLevel);
}

TEST_CASE("Distribution1D: an index without weight is never drawn, not even on a boundary") {
    const Distribution1D distribution(weightsWithGaps);
    std::vector<double> edges{0.0, 0x1p-32, 1.0 - 0x1p-24, largestBelowOne};
    double boundary = 0.0;
    for (std::size_t i = 0; i + 1 < weightsWithGaps.size(); ++i) {
        boundary += distribution.probability(i);
        edges.push_back(std::min(boundary, largestBelowOne));
        edges.push_back(std::nextafter(boundary, 0.0));
        edges.push_back(std::min(std::nextafter(boundary, 1.0), largestBelowOne));
    }
    for (const double u : edges) {
        const auto s = distribution.sample(u);
        REQUIRE(s);
        CHECK(weightsWithGaps[s->index] > 0.0);
        CHECK(s->probability > 0.0);
        CHECK(s->remainder >= 0.0);
        CHECK(s->remainder < 1.0);
    }
}

TEST_CASE("Distribution1D: without weight there is nothing to draw") {
    CHECK_FALSE(Distribution1D().sample(0.5));
    CHECK_FALSE(Distribution1D(std::vector<double>{}).sample(0.0));
    const Distribution1D dark(std::vector<double>{0.0, 0.0, 0.0});
    CHECK_FALSE(dark.sample(0.0));
    CHECK(dark.size() == 3);
    CHECK(dark.probability(1) == 0.0);
}

TEST_CASE("Distribution1D: a million equal weights stay equal") {
    constexpr std::size_t count = 1'000'000;
    const Distribution1D distribution(std::vector<double>(count, 0.3));
    double worst = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        worst = std::max(worst, std::abs(distribution.probability(i) * count - 1.0));
        sum += distribution.probability(i);
    }
    // A step of the sum is rounded by up to 2^-53 of the sum, so by count · 2^-53 of the step; so
    // are the mean step and the division by the total.
    CHECK(worst < 3.0 * count * 0x1p-53);
    CHECK(sum == doctest::Approx(1.0).epsilon(count * 0x1p-53));
    CHECK(relativeError(distribution.totalWeight(), 0.3 * count) < count * 0x1p-53);
}

TEST_CASE(
    "Distribution1D: a share far below the resolution of a float is drawn as often as it says") {
    const Distribution1D distribution(std::vector<double>{1.0, 1e-12, 1.0});
    const double p = distribution.probability(1);
    // Both ends of the share are rounded by 2^-54, 2e-4 of it in all.
    CHECK(relativeError(p, 0.5e-12) < 2.3e-4);
    const double begin = distribution.probability(0);
    CHECK(distribution.sample(std::nextafter(begin, 0.0))->index == 0);
    CHECK(distribution.sample(begin)->index == 1);
    CHECK(distribution.sample(begin + 0.5 * p)->remainder == doctest::Approx(0.5).epsilon(2.3e-4));
    CHECK(distribution.sample(begin + p)->index == 2);
}

TEST_CASE("Distribution2D: cells come up by weight, uniform within, and the density says how") {
    struct Grid {
        int width, height;
        std::vector<double> weights;
    };
    std::vector<double> hot(21, 0.01), random21;
    hot[9] = 1e4;
    RandomStream random(2, 0, 0, RandomDomain::test);
    for (int i = 0; i < 21; ++i) random21.push_back(i / 7 == 1 ? 0.0 : double{random.next()});
    const std::vector<Grid> grids{
        {1, 1, {0.7}}, {2, 1, {0.0, 3.0}}, {1, 3, {1.0, 0.0, 2.0}}, {7, 3, hot}, {7, 3, random21}};
    for (const Grid& grid : grids) {
        const Distribution2D distribution(grid.width, grid.height, grid.weights);
        const double total = std::accumulate(grid.weights.begin(), grid.weights.end(), 0.0);
        CHECK(relativeError(distribution.totalWeight(), total) < 1e-14);
        constexpr std::uint32_t count = 50'000;
        constexpr std::size_t bins = 4;
        std::vector<double> observed(grid.weights.size() * bins * bins), expected;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec2 u = random.next2();
            const auto s = distribution.sample({u.x, u.y});
            REQUIRE(s);
            REQUIRE(s->density == distribution.density(s->x, s->y));
            const auto cell = static_cast<std::size_t>(s->y * grid.width + s->x);
            ++observed[(cell * bins + bin(s->remainder.x, bins)) * bins +
                       bin(s->remainder.y, bins)];
        }
        double integral = 0.0;
        const double cellArea = 1.0 / (grid.width * grid.height);
        for (int y = 0; y < grid.height; ++y)
            for (int x = 0; x < grid.width; ++x) {
                const double weight = grid.weights[static_cast<std::size_t>(y * grid.width + x)];
                const double mass = distribution.density(x, y) * cellArea;
                // 2^-53 of a share of 1e-6 in a row, twice.
                CHECK(relativeError(mass, weight / total) < 1e-9);
                integral += mass;
                expected.insert(expected.end(), bins * bins, count * mass / (bins * bins));
            }
        CHECK(integral == doctest::Approx(1.0).epsilon(1e-14));
        const ChiSquareResult result = chiSquareTest(observed, expected);
        CHECK(result.countInEmptyCells == 0.0);
        CHECK(result.pValue > sidakLevel(falseAlarmLevel, grids.size()));
    }
}

TEST_CASE("Distribution2D: edge random numbers land in cells with weight; black draws nothing") {
    const Distribution2D distribution(3, 2, std::vector<double>{0, 1, 0, 0, 0, 0});
    for (const double x : {0.0, 0x1p-32, 1.0 - 0x1p-24, largestBelowOne})
        for (const double y : {0.0, 0x1p-32, 1.0 - 0x1p-24, largestBelowOne}) {
            const auto s = distribution.sample({x, y});
            REQUIRE(s);
            CHECK(s->x == 1);
            CHECK(s->y == 0);
            CHECK(s->density == 6.0);
        }
    CHECK_FALSE(Distribution2D(2, 2, std::vector<double>(4, 0.0)).sample({0.5, 0.5}));
}
