#include "statistics/picture_comparison.h"

#include <doctest/doctest.h>

#include <random>

#include "statistics/statistics.h"

using namespace etendue;

namespace {

constexpr int width = 8, height = 4, tileSize = 4;

/// Sixteen pictures of mean `mean`, the left tile brighter by `left`.
std::vector<Picture> noisyPictures(double mean, double left, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> noise(mean, 0.1);
    std::vector<Picture> pictures(16);
    for (Picture& p : pictures)
        for (int i = 0; i < width * height; ++i)
            for (int c = 0; c < 3; ++c)
                p.push_back(static_cast<float>(noise(engine) + (i % width < tileSize ? left : 0)));
    return pictures;
}

}  // namespace

TEST_CASE("Picture comparison: pictures of one mean agree, and the bias is known to its interval") {
    const PictureComparison c =
        comparePictures(noisyPictures(1, 0, 1), noisyPictures(1, 0, 2), width, tileSize);
    CHECK(c.agree());
    CHECK(c.level == sidakLevel(0.01, 7));  // two tiles of three colours, the whole
    // Each of 2 · 16 means has the standard error 0.1 / √96; t of 30 degrees of freedom is 2.75.
    // The spread of 16 values is known to 18 %.
    CHECK(c.relativeBiasHalfWidth / (2.75 * 0.1 / std::sqrt(96 * 8)) ==
          doctest::Approx(1).epsilon(0.2));
    CHECK(std::abs(c.relativeBias) < 2 * c.relativeBiasHalfWidth);
    CHECK(c.isEquivalent(0.05));
    CHECK_FALSE(c.isEquivalent(0.5 * c.relativeBiasHalfWidth));
}

TEST_CASE("Picture comparison: a bias of one tile is found where the mean of the whole hides it") {
    const auto shifted = noisyPictures(1 - 0.025, 0.05, 1), even = noisyPictures(1, 0, 2);
    const PictureComparison c = comparePictures(shifted, even, width, tileSize);
    CHECK_FALSE(c.agree());
    CHECK(c.isEquivalent(0.02));
}

TEST_CASE("Picture comparison: a bias of the whole is found that no tile shows, and its sign") {
    // A tile of one pixel has a standard error of 0.1 / √3 / 4 = 0.014 of a difference of 0.02.
    const PictureComparison c =
        comparePictures(noisyPictures(1.02, 0, 1), noisyPictures(1, 0, 2), width, 1);
    CHECK_FALSE(c.agree());
    CHECK(std::abs(c.relativeBias - 0.02) < 0.01);
}

TEST_CASE("Picture comparison: a shift of colour is found that leaves the brightness as it was") {
    std::vector<Picture> tinted = noisyPictures(1, 0, 1);
    for (Picture& p : tinted)
        for (std::size_t i = 0; i < p.size(); i += 3) {
            p[i] += 0.05f;
            p[i + 2] -= 0.05f;
        }
    const PictureComparison c = comparePictures(tinted, noisyPictures(1, 0, 2), width, tileSize);
    CHECK_FALSE(c.agree());
    CHECK(c.isEquivalent(0.02));
}

TEST_CASE("Picture comparison: many comparisons share one chance of a false alarm") {
    const auto a = noisyPictures(1, 0, 1), b = noisyPictures(1, 0, 2);
    CHECK(comparePictures(a, b, width, tileSize, 10).level == sidakLevel(0.01, 70));
}
