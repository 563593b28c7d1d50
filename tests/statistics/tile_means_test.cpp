#include "statistics/tile_means.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "statistics/statistics.h"

namespace etendue {

namespace {

constexpr int width = 40, height = 20, tileSize = 10;
constexpr std::size_t values = std::size_t{3} * width * height;

std::size_t indexOf(int x, int y, int color) {
    return static_cast<std::size_t>(3 * (y * width + x) + color);
}

}  // namespace

TEST_CASE("Tile z-test: pictures of one mean are told apart as often as the level says") {
    // 8 tiles and the whole in 3 colours. Half the pictures have a p below the level of 0.5 if all
    // 27 tests are independent, 1 − 0.5^(24/27) = 46 % if the whole adds nothing to the tiles.
    std::mt19937_64 generator(4);
    std::normal_distribution<float> normal;
    constexpr int trials = 400;
    int below = 0;
    for (int trial = 0; trial < trials; ++trial) {
        Picture picture(values, 1.0F), variance(values);
        for (std::size_t i = 0; i < values; ++i) {
            const float deviation = 0.01F * static_cast<float>(1 + i % 7);
            picture[i] += deviation * normal(generator);
            variance[i] = deviation * deviation;
        }
        const TileZTest z = zTestOfTiles(picture, Picture(values, 1.0F), variance, width, tileSize);
        REQUIRE(z.tests == 27);
        REQUIRE(z.level == sidakLevel(0.01, 27));
        below += z.smallestP <= sidakLevel(0.5, 27) ? 1 : 0;
    }
    const double standardError = 0.5 / std::sqrt(trials);
    CHECK(below / static_cast<double>(trials) > 0.46 - 4.0 * standardError);
    CHECK(below / static_cast<double>(trials) < 0.50 + 4.0 * standardError);
}

TEST_CASE("Tile z-test: the tile and colour that differ are named") {
    const Picture reference(values, 1.0F), variance(values, 0.01F);
    Picture picture = reference;
    for (int y = 10; y < 20; ++y)
        for (int x = 30; x < 40; ++x) picture[indexOf(x, y, 2)] -= 0.06F;
    const TileZTest z = zTestOfTiles(picture, reference, variance, width, tileSize);
    CHECK_FALSE(z.agree());
    CHECK(z.x == 30);
    CHECK(z.y == 10);
    CHECK(z.width == tileSize);
    CHECK(z.height == tileSize);
    CHECK(z.color == 2);
    CHECK(z.difference == doctest::Approx(-0.06).epsilon(1e-5));
    CHECK(z.standardError == doctest::Approx(0.01).epsilon(1e-5));  // √(0.01 / 100)
    CHECK(z.smallestP == doctest::Approx(normalTwoSidedP(6.0)).epsilon(1e-3).scale(0.0));
    // The same difference of one pixel hides in the noise.
    Picture little = reference;
    little[indexOf(35, 15, 2)] -= 0.06F;
    CHECK(zTestOfTiles(little, reference, variance, width, tileSize).agree());
}

TEST_CASE("Tile z-test: what no tile shows, the whole does; tiles at the edges are smaller") {
    const Picture reference(values, 1.0F), variance(values, 0.01F);
    // A standard error of 0.1 / √800 = 0.0035 of the whole, of 0.033 of the largest tile.
    const TileZTest z = zTestOfTiles(Picture(values, 1.02F), reference, variance, width, 3);
    CHECK_FALSE(z.agree());
    CHECK(z.width == width);
    CHECK(z.height == height);
    CHECK(z.tests == 3 * (14 * 7 + 1));
}

TEST_CASE("Tile z-test: without noise, rounding is no difference and anything else is one") {
    const Picture reference(values, 1.0F), none(values, 0.0F);
    CHECK(zTestOfTiles(Picture(values, 1.0F + 5e-7F), reference, none, width, tileSize).agree());
    const TileZTest z = zTestOfTiles(Picture(values, 1.00001F), reference, none, width, tileSize);
    CHECK(z.smallestP == 0.0);
    CHECK_FALSE(z.agree());
}

TEST_CASE("Tile z-test: pictures and variances of two sizes are refused") {
    const Picture a(values), b(values - 3);
    CHECK_THROWS_AS(zTestOfTiles(a, b, a, width, tileSize), std::invalid_argument);
    CHECK_THROWS_AS(zTestOfTiles(a, a, b, width, tileSize), std::invalid_argument);
    CHECK_THROWS_AS(zTestOfTiles(b, b, b, width, tileSize), std::invalid_argument);
    CHECK_THROWS_AS(zTestOfTiles(a, a, a, width, 0), std::invalid_argument);
}

}  // namespace etendue
