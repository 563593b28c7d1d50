#include "statistics/image_error.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace etendue {

namespace {

// Sums in double of floats: 1e-6 is what the floats themselves are worth.
doctest::Approx closeTo(double x) { return doctest::Approx(x).epsilon(1e-6).scale(0.0); }

}  // namespace

TEST_CASE("ImageErrors: two pixels by hand") {
    const Picture reference{1.0F, 2.0F, 0.0F, 0.5F, 0.5F, 4.0F};
    const Picture picture{1.5F, 2.0F, 0.1F, 0.5F, 0.0F, 3.0F};
    const ImageErrors errors = imageErrors(picture, reference);
    CHECK(errors.mse == closeTo((0.25 + 0.01 + 0.25 + 1.0) / 6.0));
    CHECK(errors.mae == closeTo((0.5 + 0.1 + 0.5 + 1.0) / 6.0));
    const double first = 0.25 / 1.01 + 0.01 / 0.01, second = 0.25 / 0.26 + 1.0 / 16.01;
    CHECK(errors.relMse == closeTo((first + second) / 6.0));
    CHECK(errors.relMseTrimmed == errors.relMse);  // there is no 0.1 % of two pixels
    CHECK(errors.meanError == closeTo((7.1 - 8.0) / 8.0));

    const std::vector<float> pixels = relativeSquaredErrors(picture, reference);
    REQUIRE(pixels.size() == 2);
    CHECK(pixels[0] == closeTo(first / 3.0));
    CHECK(pixels[1] == closeTo(second / 3.0));
}

TEST_CASE("ImageErrors: the trimmed error leaves out the worst pixel of a thousand, all of it") {
    const Picture reference(3000, 1.0F);
    Picture picture = reference;
    // The worst value is alone in its pixel; the worst pixel has three that are nearly as bad.
    for (std::size_t i = 300; i < 303; ++i) picture[i] = 11.0F;
    picture[600] = 13.0F;
    const ImageErrors errors = imageErrors(picture, reference);
    CHECK(errors.relMse == closeTo((3.0 * 100.0 + 144.0) / 1.01 / 3000.0));
    CHECK(errors.relMseTrimmed == closeTo(144.0 / 1.01 / (3.0 * 999.0)));

    const Picture few(picture.begin(), picture.end() - 3);
    const ImageErrors ofFew = imageErrors(few, Picture(few.size(), 1.0F));
    CHECK(ofFew.relMseTrimmed == ofFew.relMse);
}

TEST_CASE("ImageErrors: against a black reference relMSE is finite and the mean error no number") {
    const Picture grey(6, 0.1F), black(6, 0.0F);
    const ImageErrors errors = imageErrors(grey, black);
    CHECK(errors.relMse == closeTo(1.0));
    CHECK(std::isnan(errors.meanError));
    CHECK(std::isnan(meanErrorHalfWidth(grey, black, {}, {})));
    CHECK(std::isnan(meanErrorHalfWidthByScatter(grey, black)));
}

TEST_CASE("ImageErrors: a black picture is as bright as a black reference") {
    const Picture black(6, 0.0F);
    CHECK(imageErrors(black, black).meanError == 0.0);
    CHECK(meanErrorHalfWidth(black, black, {}, {}) == 0.0);
    CHECK(meanErrorHalfWidth(black, black, black, black) == 0.0);
    CHECK(meanErrorHalfWidthByScatter(black, black) == 0.0);
}

TEST_CASE("ImageErrors: pictures of two sizes are refused") {
    CHECK_THROWS_AS(imageErrors(Picture(6), Picture(3)), std::invalid_argument);
    CHECK_THROWS_AS(imageErrors({}, {}), std::invalid_argument);
    CHECK_THROWS_AS(relativeSquaredErrors(Picture(4), Picture(4)), std::invalid_argument);
    CHECK_THROWS_AS(biasSquared(Picture(3), Picture(3), Picture(3), Picture(6)),
                    std::invalid_argument);
}

TEST_CASE("Mean error: its interval from variances is of the ratio of both pictures") {
    // Four pixels, means 1.1 and 1; a pixel's channels of deviation 0.1 move together by as much.
    const Picture picture(12, 1.1F), reference(12, 1.0F), variance(12, 0.01F), none;
    const double quantile = 2.5758293;
    CHECK(meanErrorHalfWidth(picture, reference, variance, none) ==
          closeTo(quantile * 0.1 / std::sqrt(4.0)));
    CHECK(meanErrorHalfWidth(picture, reference, none, variance) ==
          closeTo(quantile * 1.1 * 0.1 / std::sqrt(4.0)));
    CHECK(meanErrorHalfWidth(picture, reference, variance, variance) ==
          closeTo(quantile * std::sqrt(1.0 + 1.21) * 0.1 / std::sqrt(4.0)));
    CHECK(meanErrorHalfWidth(picture, reference, none, none) == 0.0);
    CHECK_THROWS_AS(meanErrorHalfWidth(picture, reference, Picture(3), none),
                    std::invalid_argument);
}

TEST_CASE("Mean error: its intervals hold the truth as often as they say") {
    // Pixels of brightness 1 and noise of deviation 0.2, the same in all channels, where both ways
    // know the noise: 1 % of the intervals miss, give or take 0.3 %.
    constexpr int trials = 1000;
    constexpr std::size_t pixels = 100;
    const Picture reference(3 * pixels, 1.0F), variance(3 * pixels, 0.04F);
    std::mt19937_64 generator(8);
    std::normal_distribution<float> noise(0.0F, 0.2F);
    int missed = 0, missedByScatter = 0;
    for (int trial = 0; trial < trials; ++trial) {
        Picture picture;
        for (std::size_t i = 0; i < pixels; ++i)
            picture.insert(picture.end(), 3, 1.0F + noise(generator));
        const double error = std::abs(imageErrors(picture, reference).meanError);
        missed += error > meanErrorHalfWidth(picture, reference, variance, {}) ? 1 : 0;
        missedByScatter += error > meanErrorHalfWidthByScatter(picture, reference) ? 1 : 0;
    }
    const double expected = 0.01 * trials, deviation = std::sqrt(0.01 * 0.99 * trials);
    CHECK(std::abs(missed - expected) < 4.0 * deviation);
    CHECK(std::abs(missedByScatter - expected) < 4.0 * deviation);
    CHECK(missed > 0);
    CHECK(missedByScatter > 0);
    CHECK(std::isnan(meanErrorHalfWidthByScatter(Picture(3, 1.0F), Picture(3, 1.0F))));
}

TEST_CASE("biasSquared: finds the bias beneath noise, and none where there is none") {
    // Unit noise: the product of two differences varies by 2 where there is no bias, and a bias b
    // adds 2·√2·b at most; over 90,000 values that is a standard error of 0.0067 and 0.0094.
    constexpr std::size_t values = 90'000;
    std::mt19937_64 generator(1);
    std::normal_distribution<float> noise;
    const auto picture = [&](float mean) {
        Picture p(values);
        for (float& v : p) v = mean + noise(generator);
        return p;
    };
    const Picture reference1 = picture(1.0F), reference2 = picture(1.0F);
    const Picture biased1 = picture(1.5F), biased2 = picture(1.5F);
    const Picture right1 = picture(1.0F), right2 = picture(1.0F);
    CHECK(std::abs(biasSquared(right1, right2, reference1, reference2)) < 4.0 * 0.0067);
    CHECK(std::abs(biasSquared(biased1, biased2, reference1, reference2) - 0.25) < 4.0 * 0.0094);
    // What a single pair says: the noise of both.
    CHECK(imageErrors(right1, reference1).mse == doctest::Approx(2.0).epsilon(0.05));
}

}  // namespace etendue

TEST_CASE("Image error: of independent pictures the mean, its variance, and the relMSE to expect") {
    // Values 1, 3 and 2, 2: means 2, variances of the means 1 and 0.
    const etendue::MeanPicture mean =
        etendue::meanPicture({{1.0f, 2.0f, 2.0f}, {3.0f, 2.0f, 2.0f}});
    CHECK(mean.pixels == etendue::Picture{2.0f, 2.0f, 2.0f});
    CHECK(mean.variance == etendue::Picture{1.0f, 0.0f, 0.0f});
    CHECK(mean.relMse == doctest::Approx(1.0 / 4.01 / 3.0));
}
