// Pictures as one number: the mean over all pixels, once for each of several seeds, and how it is
// held against another estimator's, or against what is known in closed form.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "statistics/statistics.h"
#include "tests/support/estimate.h"
#include "tests/support/scenes.h"

namespace etendue {

struct PictureMeans {
    std::vector<double> means;  // one for each seed
    std::uint64_t badSamples = 0, refusedRays = 0;
};

inline PictureMeans pictureMeans(const LoadedScene& loaded, const EstimatorSettings& estimator,
                                 std::uint32_t samples, std::uint64_t seeds = 12,
                                 std::uint64_t firstSeed = 1) {
    PictureMeans result;
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    const auto made = makeEstimator(estimator);
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        Film film(
            {loaded.film.width, loaded.film.height, 0, 0, loaded.film.width, loaded.film.height},
            {}, loaded.film.color);
        RenderSettings settings;
        settings.samples = samples;
        settings.seed = firstSeed + seed;
        settings.threads = 2;
        const RenderResult done =
            render(*loaded.scene, *loaded.camera, *made, filter, film, settings, {});
        result.badSamples += done.badSampleCount;
        result.refusedRays += done.refusedRays;
        result.means.push_back(meansOf({film.channels().front().pixels}).front());
    }
    return result;
}

/// …by the estimator of that kind, which must take every sample and see something.
inline std::vector<double> goodMeans(const LoadedScene& loaded, const std::string& kind,
                                     std::uint32_t samples, std::uint64_t seeds = 12,
                                     std::uint64_t firstSeed = 1) {
    CAPTURE(kind);
    EstimatorSettings settings = loaded.estimator;
    settings.kind = kind;
    const PictureMeans result = pictureMeans(loaded, settings, samples, seeds, firstSeed);
    CHECK(result.badSamples == 0);
    CHECK(result.refusedRays == 0);
    CHECK(summarize(result.means).mean > 0.0);
    return result.means;
}

/// The picture of a field of radiance 1 all around: the mean of the rays' weights over film and
/// aperture, in as many independent batches. `samples` in each, of a lattice shifted at random.
inline std::vector<double> uniformField(const LoadedScene& loaded, int samples = 4096,
                                        std::uint32_t batches = 12) {
    std::vector<double> means;
    for (std::uint32_t batch = 0; batch < batches; ++batch) {
        RandomStream random(5, batch, 0, RandomDomain::test);
        // Roots of x⁵ = x + 1 (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
        // Sequences"): evenly spread in four dimensions.
        constexpr double root = 1.1673039782614187;
        double step = 1.0, point[4] = {random.next(), random.next(), random.next(), random.next()};
        double steps[4];
        for (double& s : steps) s = step /= root;
        double sum = 0.0;
        for (int i = 0; i < samples; ++i) {
            for (std::size_t k = 0; k < 4; ++k) point[k] = std::fmod(point[k] + steps[k], 1.0);
            const Vec2 film{static_cast<float>(point[0] * loaded.film.width),
                            static_cast<float>(point[1] * loaded.film.height)};
            const Vec2 aperture{unitFloat(point[2]), unitFloat(point[3])};
            const auto ray = loaded.camera->sampleRay(film, aperture, {});
            if (ray) sum += static_cast<double>(ray->weight);
        }
        means.push_back(sum / samples);
    }
    return means;
}

/// How likely a difference is by chance, when floats may have rounded it by ten roundings, all one
/// way.
inline double chanceOf(double difference, double scale, double standardError,
                       double degreesOfFreedom) {
    const double excess = std::abs(difference) - 10.0 * 0x1p-24 * scale;
    if (excess <= 0.0) return 1.0;
    if (standardError <= 0.0) return 0.0;
    return studentTwoSidedP(excess / standardError, degreesOfFreedom);
}

/// a = factor · b: not further apart than by chance at `level`, and known to `bound`, so that noise
/// hides nothing larger.
inline void checkRatio(const std::vector<double>& a, std::vector<double> b, double factor,
                       double bound, double level = falseAlarmLevel) {
    for (double& v : b) v *= factor;
    const WelchResult welch = welchTest(a, b);
    const double ofA = summarize(a).mean, mean = summarize(b).mean;
    const double relativeError = welch.standardError / mean;
    CAPTURE(ofA);
    CAPTURE(mean);
    CAPTURE(relativeError);
    CHECK(chanceOf(welch.difference, mean, welch.standardError, welch.degreesOfFreedom) > level);
    CHECK(std::abs(welch.difference) + 3.0 * welch.standardError < bound * mean);
}

/// a = `expected`, a number that is wrong by `systematic` of it at most.
inline void checkMean(const std::vector<double>& a, double expected, double bound,
                      double level = falseAlarmLevel, double systematic = 0.0) {
    const Summary summary = summarize(a);
    CAPTURE(expected);
    CAPTURE(summary.mean);
    CAPTURE(summary.standardError);
    const double difference = summary.mean - expected;
    const double excess = std::max(0.0, std::abs(difference) - systematic * expected);
    CHECK(chanceOf(excess, expected, summary.standardError,
                   static_cast<double>(summary.count) - 1.0) > level);
    CHECK(std::abs(difference) + 3.0 * summary.standardError < bound * expected);
}

}  // namespace etendue
