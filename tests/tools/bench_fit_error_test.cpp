// What a fit does to a picture, from pairs whose difference is known.
#include "tools/bench_fit_error.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/scenes.h"

using namespace etendue;

namespace {

const auto patiently = [] { return true; };

FitImageError errorOf(const LoadedScene& exact, const LoadedScene& fitted,
                      const FitErrorSettings& settings) {
    return fitImageError(fitErrorPictures(exact, settings, patiently).value(),
                         fitErrorPictures(fitted, settings, patiently).value(), settings);
}

LoadedScene brighterBy(double percent) {
    const std::string stops = std::to_string(std::log2(1.0 + 0.01 * percent));
    return sceneFromText(ballScene, {"camera.exposure=" + stops});
}

}  // namespace

TEST_CASE("Fit error: a picture brighter by a known share, free of the noise of both") {
    const LoadedScene exact = sceneFromText(ballScene);
    for (const double percent : {0.1, 1.0, 10.0}) {
        CAPTURE(percent);
        const FitImageError error = errorOf(exact, brighterBy(percent), {8, 16, 1});
        // The picture is about 1 outside of the sphere and between 0.5 and 0.7 on it, where
        // r² / (r² + 0.01) is between 0.96 and 0.99.
        const double share = 1e-4 * percent * percent;
        CHECK(error.relMse > 0.95 * share);
        CHECK(error.relMse < 1.00 * share);
        CHECK(error.interval.contains(error.relMse));
        CHECK(error.interval.width() < 0.05 * share);
    }
}

TEST_CASE("Fit error: of one lens by itself there is none") {
    const LoadedScene exact = sceneFromText(ballScene);
    const FitImageError error = errorOf(exact, exact, {3, 1, 1});
    CHECK(error.relMse == 0.0);
    CHECK(error.interval.width() == 0.0);
}

TEST_CASE("Fit error: pictures with numbers of their own differ by noise, which is no error") {
    // Roulette from the first bounce on: the same picture, with other noise.
    const LoadedScene a = sceneFromText(
        ballScene, {"camera.model=thin-lens", "camera.f_number=8", "camera.focus_distance=3"});
    const LoadedScene b =
        sceneFromText(ballScene, {"camera.model=thin-lens", "camera.f_number=8",
                                  "camera.focus_distance=3", "estimator.russian_roulette_depth=1"});
    const FitImageError error = errorOf(a, b, {8, 4, 1});
    CHECK(error.interval.contains(0.0));
    CHECK(error.interval.width() > 0.0);
}

TEST_CASE("Fit error: the noise of one sample is told, whatever the samples") {
    const LoadedScene exact = sceneFromText(ballScene);
    const auto noiseOf = [&](std::uint32_t samples) {
        return errorOf(exact, exact, {8, samples, 1}).noiseOfOneSample;
    };
    // Means over 600 pixels and eight seeds of squares: known to some 5 %.
    const double noise = noiseOf(1);
    CHECK(noise > 0.0);
    CHECK(noiseOf(16) == doctest::Approx(noise).epsilon(0.25));
}

TEST_CASE("Fit error: given up, there is none") {
    const LoadedScene exact = sceneFromText(ballScene);
    CHECK(!fitErrorPictures(exact, {}, [] { return false; }));
}
