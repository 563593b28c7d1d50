#include "statistics/flip.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "statistics/flip_filters.h"

namespace etendue {

namespace {

constexpr int width = 40, height = 30;

/// Any picture of this size, by a function of x, y and channel.
template <class Function>
Picture pictureOf(const Function& value) {
    Picture picture;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) picture.push_back(static_cast<float>(value(x, y, c)));
    return picture;
}

/// Ten stops, smooth in parts, with the edges of a chess board.
double waves(int x, int y, int c) {
    const double light =
        std::exp2(3.0 * std::sin(0.31 * x + 0.7 * c) + 2.0 * std::cos(0.23 * y - 0.4 * c));
    return (x / 8 + y / 6) % 2 == 1 ? 0.05 * light : light;
}
double disturbedWaves(int x, int y, int c) {
    return waves(x, y, c) * (1.0 + 0.5 * std::sin(1.7 * x + 2.3 * y + c));
}

double meanOf(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

TEST_CASE("FLIP: no picture differs from itself") {
    const Picture picture = pictureOf(waves);
    for (const float error : hdrFlip(picture, picture, width)) REQUIRE(error == 0.0F);
}

TEST_CASE("FLIP: black and white differ by 0.967, on a display and among exposures alike") {
    // |ΔL*| = 100; green and blue, the papers' extremes, have a HyAB distance of 203.3 after Hunt's
    // adjustment: 0.95 + 0.05·(100^0.7 − 0.4·203.3^0.7) / (0.6·203.3^0.7).
    const Picture black(3 * width * height, 0.0F), white(3 * width * height, 1.0F);
    const double greatest = std::pow(203.3, 0.7);
    const double expected =
        0.95 + 0.05 * (std::pow(100.0, 0.7) - 0.4 * greatest) / (0.6 * greatest);
    CHECK(meanOf(ldrFlip(black, white, width)) == doctest::Approx(expected).epsilon(1e-4));
    CHECK(meanOf(ldrFlip(white, black, width)) == doctest::Approx(expected).epsilon(1e-4));
    // HDR-FLIP shows white as 0.85, of which L* = 116·0.85^(1/3) − 16.
    const double distance = 116.0 * std::cbrt(0.85) - 16.0;
    CHECK(
        meanOf(hdrFlip(black, white, width)) ==
        doctest::Approx(0.95 + 0.05 * (std::pow(distance, 0.7) - 0.4 * greatest) / (0.6 * greatest))
            .epsilon(1e-4));
}

TEST_CASE("FLIP: agrees with its definition by convolutions in two dimensions") {
    // These numbers come from a separate program in another language, in double, whose filters are
    // summed over the plane. What is left is the rounding of floats: 1e-7 of a channel of up to
    // 100, which the cube root of L* multiplies by up to 8.
    const std::vector<float> errors = hdrFlip(pictureOf(disturbedWaves), pictureOf(waves), width);
    CHECK(std::abs(meanOf(errors) - 0.107407381) < 2e-6);
    CHECK(std::abs(errors[0] - 0.111460744) < 2e-6);
    CHECK(std::abs(errors[17 * width + 23] - 0.110066344) < 2e-6);
    const FlipExposures exposures = flipExposures(pictureOf(waves));
    CHECK(exposures.start == doctest::Approx(-3.725451899).epsilon(1e-7));
    CHECK(exposures.stop == doctest::Approx(2.876015210).epsilon(1e-7));
    CHECK(exposures.count == 7);
}

TEST_CASE("FLIP: exposures map the brightest and the median luminance to 0.85") {
    Picture reference(3 * 5, 0.25F);
    reference[0] = reference[1] = reference[2] = 20.0F;
    const FlipExposures exposures = flipExposures(reference);
    CHECK(acesToneCurve(std::exp2(exposures.start) * 20.0) == doctest::Approx(0.85).epsilon(1e-12));
    CHECK(acesToneCurve(std::exp2(exposures.stop) * 0.25) == doctest::Approx(0.85).epsilon(1e-12));
    CHECK(exposures.count == 7);  // 6.3 stops apart

    SUBCASE("one brightness has two exposures, which are one") {
        const FlipExposures flat = flipExposures(Picture(9, 3.0F));
        CHECK(flat.start == flat.stop);
        CHECK(flat.count == 2);
    }
    SUBCASE("a picture mostly black takes the median of the rest") {
        Picture dark(3 * 9, -0.5F);
        for (std::size_t i = 0; i < 6; ++i) dark[i] = i < 3 ? 1.0F : 4.0F;
        const FlipExposures ofRest = flipExposures(dark);
        CHECK(acesToneCurve(std::exp2(ofRest.stop) * 2.5) == doctest::Approx(0.85).epsilon(1e-12));
        CHECK(acesToneCurve(std::exp2(ofRest.start) * 4.0) == doctest::Approx(0.85).epsilon(1e-12));
    }
    SUBCASE("a black one has no choice") {
        const FlipExposures black = flipExposures(Picture(9, 0.0F));
        CHECK(black.start == 0.0);
        CHECK(black.stop == 0.0);
        CHECK(meanOf(hdrFlip(Picture(9, 0.0F), Picture(9, 0.0F), 3)) == 0.0);
        CHECK(meanOf(hdrFlip(Picture(9, 10.0F), Picture(9, 0.0F), 3)) > 0.95);
    }
}

TEST_CASE("FLIP: the tone curve is Narkowicz's, and finite for any float") {
    CHECK(acesToneCurve(0.0) == 0.0);
    CHECK(acesToneCurve(-1.0) == 0.0);
    // x·(2.51x + 0.03) / (x·(2.43x + 0.59) + 0.14) at 0.6
    CHECK(acesToneCurve(1.0) == doctest::Approx(0.9216 / 1.3688).epsilon(1e-12));
    CHECK(acesToneCurve(1e120) == 1.0);
    CHECK(flipPixelsPerDegree() == doctest::Approx(67.0206).epsilon(1e-6));
}

TEST_CASE("FLIP: does not depend on the unit of light, and rises with blur") {
    const Picture reference = pictureOf(waves), picture = pictureOf(disturbedWaves);
    const double once = meanOf(hdrFlip(picture, reference, width));
    Picture brightReference = reference, brightPicture = picture;
    for (float& v : brightReference) v *= 64.0F;
    for (float& v : brightPicture) v *= 64.0F;
    CHECK(meanOf(hdrFlip(brightPicture, brightReference, width)) ==
          doctest::Approx(once).epsilon(1e-6));

    double previous = 0.0;
    for (const int radius : {1, 2, 4, 8}) {
        const Picture blurred = pictureOf([&](int x, int y, int c) {
            double sum = 0.0;
            for (int i = -radius; i <= radius; ++i) sum += waves(x + i + 80, y, c);
            return sum / (2 * radius + 1);
        });
        const Picture sharp = pictureOf([](int x, int y, int c) { return waves(x + 80, y, c); });
        const double error = meanOf(hdrFlip(blurred, sharp, width));
        CAPTURE(radius);
        CHECK(error > previous);
        previous = error;
    }
}

TEST_CASE("FLIP: pictures of two sizes, or of no whole rows, are refused") {
    CHECK_THROWS_AS(hdrFlip(Picture(6), Picture(3), 1), std::invalid_argument);
    CHECK_THROWS_AS(hdrFlip(Picture(9), Picture(9), 2), std::invalid_argument);
    CHECK_THROWS_AS(hdrFlip({}, {}, 1), std::invalid_argument);
}

}  // namespace etendue
