#include "tools/picture_noise.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "statistics/statistics.h"

using namespace etendue;

namespace {

constexpr int size = 64;

/// `samples` of each pixel of a grey picture, uniform from 0 to 2.
Film greyNoise(int samples, unsigned seed, float brightness = 1.0f) {
    FilmLayers layers;
    layers.luminanceVariance = true;
    Film film({size, size, 0, 0, size, size}, layers);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 2.0f);
    for (int s = 0; s < samples; ++s) {
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const float value = brightness * uniform(random);
                film.add(x, y, rgb(value, value, value));
            }
        film.addSamples(1);
    }
    return film;
}

}  // namespace

TEST_CASE("Picture noise: is the error to be expected, and its bound has the estimate's spread") {
    constexpr int samples = 64;
    // A uniform number from 0 to 2 has the variance 1/3.
    const double expected = std::sqrt(1.0 / 3.0 / samples / 1.01);
    std::vector<double> squares;
    double statedError = 0.0;
    constexpr unsigned seeds = 100;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        const PictureNoise noise = pictureNoise(greyNoise(samples, seed));
        // To divide by the pixels' estimates adds 3 / (2 · 3 · 64), 0.8 %.
        CHECK(noise.relativeError == doctest::Approx(expected).epsilon(0.02));
        squares.push_back(noise.relativeError * noise.relativeError);
        statedError +=
            (noise.upperBound * noise.upperBound - squares.back()) / 1.96 / double{seeds};
    }
    // 100 values tell their spread to 7 %.
    CHECK(statedError == doctest::Approx(std::sqrt(summarize(squares).variance)).epsilon(0.25));
}

TEST_CASE("Picture noise: does not depend on the brightness, and falls as one over the root") {
    const double error = pictureNoise(greyNoise(16, 1)).relativeError;
    CHECK(pictureNoise(greyNoise(16, 1, 1e-6f)).relativeError ==
          doctest::Approx(error).epsilon(1e-3));
    CHECK(pictureNoise(greyNoise(256, 1)).relativeError ==
          doctest::Approx(error / 4).epsilon(0.08));
}

TEST_CASE("Picture noise: is infinite while nothing can be told") {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    CHECK(pictureNoise(greyNoise(1, 1)).relativeError == infinity);
    CHECK(pictureNoise(greyNoise(8, 1, 0.0f)).upperBound == infinity);
}
