// False alarms of rare bright samples, and what the guard against them costs.
#include "tools/agreement_judge.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "statistics/statistics.h"

using namespace etendue;

namespace {

constexpr int seeds = 16;

/// Means of pictures of `samples` samples each: 0.5 to 1.5 and, with probability λ / (all samples
/// of all pictures), `flash` more.
std::vector<double> meansWithFlashes(std::mt19937& random, int samples, double lambda,
                                     double flash) {
    std::vector<double> means;
    std::poisson_distribution<int> flashes(lambda / seeds);
    std::normal_distribution<double> rest(1.0, std::sqrt(1.0 / 12.0 / samples));
    for (int i = 0; i < seeds; ++i)
        means.push_back(rest(random) + flashes(random) * flash / samples);
    return means;
}

struct Alarms {
    int welch = 0, guarded = 0;
};

/// Of `trials` comparisons of equal means, at that level; the reference knows the flashes well.
Alarms falseAlarms(double lambda, double flash, double level, int trials) {
    std::mt19937 random(20261128);
    constexpr int samples = 1000, referenceSamples = 100000;
    Alarms alarms;
    for (int i = 0; i < trials; ++i) {
        const auto a = meansWithFlashes(random, samples, lambda, flash);
        const auto b =
            meansWithFlashes(random, referenceSamples, lambda * referenceSamples / samples, flash);
        alarms.welch += welchTest(a, b).pValue <= level;
        alarms.guarded +=
            guardedP(a, b, flash / (samples * seeds), flash / (referenceSamples * seeds)) <= level;
    }
    return alarms;
}

}  // namespace

TEST_CASE("Agreement judge: rare bright samples raise no more false alarms than the level says") {
    constexpr int trials = 4000;
    constexpr double level = 0.005;
    // A count of four standard errors above the level, and the next whole number.
    const int most = static_cast<int>(std::ceil(trials * level + 4.0 * std::sqrt(trials * level)));
    int welchAlarms = 0;
    for (const double lambda : {0.3, 1.0, 3.0, 10.0, 30.0}) {
        for (const double flash : {100.0, 1000.0}) {
            CAPTURE(lambda);
            CAPTURE(flash);
            const Alarms alarms = falseAlarms(lambda, flash, level, trials);
            CHECK(alarms.guarded <= most);
            welchAlarms = std::max(welchAlarms, alarms.welch);
        }
    }
    // Which Welch's t alone does: all the pictures without a flash.
    CHECK(welchAlarms > 20 * most);
}

TEST_CASE("Agreement judge: a difference of many of the brightest samples is found") {
    const std::vector<double> a{1.0, 1.1, 0.9, 1.05, 0.95, 1.0, 1.1, 0.9};
    std::vector<double> b = a;
    for (double& v : b) v += 1.0;
    CHECK(guardedP(a, b, 0.0, 0.0) == welchTest(a, b).pValue);
    CHECK(guardedP(a, b, 0.001, 0.001) < 1e-9);
    CHECK(guardedP(a, b, 0.5, 0.001) > 0.1);
    // What the brighter side may have missed does not bring them nearer.
    CHECK(guardedP(a, b, 0.001, 0.5) < 1e-9);
    CHECK(guardedP(b, a, 0.001, 0.5) > 0.1);
    // Means that do not vary, and do not differ.
    const std::vector<double> still(8, 1.0);
    CHECK(guardedP(still, still, 1.0, 1.0) == 1.0);
    CHECK(guardedP(still, std::vector<double>(8, 2.0), 1.0, 1.0) > 0.1);
    CHECK(guardedP(still, std::vector<double>(8, 2.0), 0.0, 0.0) == 0.0);
}

TEST_CASE("Agreement judge: tiles in doubt are counted, and the rest is as without the guard") {
    std::mt19937 random(7);
    std::normal_distribution<float> noise(1.0f, 0.01f);
    std::vector<Picture> a, b;
    for (int i = 0; i < seeds; ++i) {
        Picture p(3 * 8 * 4), q(3 * 8 * 4);
        for (float& v : p) v = noise(random);
        for (float& v : q) v = noise(random);
        // The left half of b is brighter by far more than the noise.
        for (std::size_t k = 0; k < q.size(); ++k)
            if (k / 3 % 8 < 4) q[k] += 0.1f;
        a.push_back(p);
        b.push_back(q);
    }
    const SampleSizes many{160.0, 1.0}, rare{160.0, 100.0};
    const Judgement sure = judgePictures(a, b, many, many, 8, 4, 1);
    CHECK(sure.testsInDoubt == 0);
    CHECK_FALSE(sure.comparison.agree());
    const PictureComparison plain = comparePictures(a, b, 8, 4);
    CHECK(sure.comparison.level == plain.level);
    CHECK(sure.comparison.relativeBias == plain.relativeBias);
    CHECK(sure.comparison.relativeBiasHalfWidth == plain.relativeBiasHalfWidth);
    const Judgement doubtful = judgePictures(a, b, rare, many, 8, 4, 1);
    CHECK(doubtful.testsInDoubt == 4);  // one tile in three colours, and the whole
    CHECK(doubtful.comparison.agree());
}
