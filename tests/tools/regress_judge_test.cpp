// The judge of regression tests is judged: it finds what is wrong, and passes what is right.
#include "tools/regress_judge.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "tools/agreement_judge.h"

using namespace etendue;

namespace {

const PictureRegions regions{32, 16, 16};  // two tiles

/// Pictures of brightness 1 with noise, all times `factor` in the left tile.
std::vector<Picture> pictures(std::size_t count, std::uint32_t seed, double noise,
                              double factor = 1.0) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal(0.0, noise);
    std::vector<Picture> result(count, Picture(3 * 32 * 16));
    for (Picture& picture : result)
        for (std::size_t i = 0; i < picture.size(); ++i) {
            const double mean = i / 3 % 32 < 16 ? factor : 1.0;
            picture[i] = static_cast<float>(mean + normal(generator));
        }
    return result;
}

RegionMeans regionMeansOf(const std::vector<Picture>& of) {
    RegionMeans result;
    for (const Picture& picture : of) result.means.push_back(regions.meansOf(picture));
    return result;
}

HeldAgainst held(double factor, double noise = 0.05) {
    return {regions, regionMeansOf(pictures(32, 1, noise, factor)),
            regionMeansOf(pictures(16, 2, 0.02))};
}

/// Eight samples of each seed around brightness 1, as a film holds them; three seeds have met a
/// bright one. `isShared`: two samples are one each time.
SeedPictures progressive(std::uint32_t seeds, double noise, double brightness,
                         bool isShared = false) {
    SeedPictures result;
    result.pictures.resize(8);
    for (std::uint32_t seed = 0; seed < seeds; ++seed) {
        std::vector<Picture> samples = pictures(8, 100 + seed, noise);
        if (isShared)
            for (std::size_t i = 0; i < 8; i += 2) samples[i + 1] = samples[i];
        if (seed < 3) samples[2 + seed][300 * seed] += static_cast<float>(brightness);
        std::vector<double> sums(samples[0].size());
        for (std::size_t n = 0; n < samples.size(); ++n) {
            Picture mean;
            for (std::size_t i = 0; i < sums.size(); ++i) {
                sums[i] += static_cast<double>(samples[n][i]);
                mean.push_back(static_cast<float>(sums[i] / static_cast<double>(n + 1)));
            }
            result.pictures[n].push_back(mean);
        }
    }
    return result;
}

Noise noise(double value, double relativeHalfWidth) {
    return {value, {value / (1.0 + relativeHalfWidth), value * (1.0 + relativeHalfWidth)}};
}

}  // namespace

TEST_CASE("Regress judge: of two means the test is Welch's, guarded as agreement's") {
    const std::vector<double> a{1.0, 1.2, 0.9, 1.1, 1.05}, b{1.3, 1.2, 1.5, 1.25};
    const MeanTerm terms[] = {{1.0, summarize(a), 0.01}, {-1.0, summarize(b), 0.02}};
    const SumTest test = testSum(terms);
    const WelchResult welch = welchTest(a, b);
    CHECK(test.difference == doctest::Approx(welch.difference));
    CHECK(test.p == doctest::Approx(welch.pValue));
    CHECK(test.guardedP == doctest::Approx(guardedP(a, b, 0.01, 0.02)));
    CHECK(test.guardedP > test.p);
    CHECK(test.halfWidth ==
          doctest::Approx(studentQuantile(0.99, welch.degreesOfFreedom) * welch.standardError));
    // What does not vary at all.
    const std::vector<double> one{1.0, 1.0}, two{2.0, 2.0};
    const MeanTerm same[] = {{1.0, summarize(one)}, {-1.0, summarize(one)}};
    const MeanTerm other[] = {{1.0, summarize(one)}, {-1.0, summarize(two)}};
    CHECK(testSum(same).guardedP == 1.0);
    CHECK(testSum(other).guardedP == 0.0);
}

TEST_CASE("Regress judge: a bias of one tile is found, and none where there is none") {
    // Of a tile's mean the standard error is 0.05 / √(32 · 256) = 0.055 %, of the reference's
    // 0.031 %: 1 % is sixteen of the two together.
    const BiasJudgement right = judgeBias(held(1.0), 0.005, 7);
    CHECK(right.verdict == BiasVerdict::unbiased);
    CHECK(right.smallestP > right.level);
    const BiasJudgement wrong = judgeBias(held(1.01), 0.5, 7);
    CHECK(wrong.verdict == BiasVerdict::biased);
    CHECK(wrong.relativeBias == doctest::Approx(0.005).epsilon(0.3));
    CHECK(judgeBias(held(0.99), 0.5, 7).verdict == BiasVerdict::biased);
}

TEST_CASE("Regress judge: noise does not pass for the lack of a bias") {
    const HeldAgainst noisy = held(1.0, 2.0);
    CHECK(judgeBias(noisy, 0.005, 7).verdict == BiasVerdict::tooNoisy);
    CHECK(judgeBias(noisy, 0.2, 7).verdict == BiasVerdict::unbiased);
    CHECK(judgeBias(noisy, {}, 7).verdict == BiasVerdict::unbounded);
    HeldAgainst bad = held(1.0);
    bad.badSamples = 1;
    CHECK(judgeBias(bad, 0.5, 7).verdict == BiasVerdict::biased);
    // The bound that a new cell gets is one that it keeps.
    const BiasJudgement bias = judgeBias(noisy, {}, 7);
    const auto bound = boundFor(bias);
    REQUIRE(bound);
    CHECK(*bound > 2.5 * bias.halfWidth);
    CHECK(judgeBias(noisy, bound, 7).verdict == BiasVerdict::unbiased);
    CHECK(!boundFor({.relativeBias = 0.0, .halfWidth = 0.3}));
    CHECK(boundFor({.relativeBias = 0.0, .halfWidth = 0.0005}) == 0.005);
}

TEST_CASE("Regress judge: two estimators are compared by what each is beside its reference") {
    // One reference cancels, though it is wrong.
    HeldAgainst a = held(1.0), b = held(1.0);
    b.tested = regionMeansOf(pictures(32, 3, 0.05));
    for (std::vector<double>& means : a.reference.means)
        for (double& mean : means) mean *= 1.3;
    b.reference = a.reference;
    CHECK(judgeBetween(a, b, 7).verdict == BiasVerdict::unbounded);
    b.tested = regionMeansOf(pictures(32, 3, 0.05, 1.01));
    CHECK(judgeBetween(a, b, 7).verdict == BiasVerdict::biased);
    // Two do not, and stand for the paths that only one of the two makes.
    HeldAgainst half = held(0.5), whole = held(1.0);
    half.reference = regionMeansOf(pictures(16, 4, 0.02, 0.5));
    whole.tested = regionMeansOf(pictures(32, 3, 0.05));
    CHECK(judgeBetween(half, whole, 7).verdict == BiasVerdict::unbounded);
    half.reference = regionMeansOf(pictures(16, 4, 0.02, 0.505));
    CHECK(judgeBetween(half, whole, 7).verdict == BiasVerdict::biased);
}

TEST_CASE("Regress judge: errors are those of the picture, without the reference's own") {
    // Around brightness 1 relMSE is the variance over 1.01.
    const double variance = 0.01;
    const SeedPictures rendered = progressive(8, std::sqrt(variance), 0.0);
    ReferencePicture reference;
    reference.pixels = pictures(1, 2, 0.1)[0];  // as noisy as one sample of what it judges
    reference.noise = variance / 1.01;
    const BlockErrors errors = blockErrors(rendered, 32, reference);
    CHECK(errors.samples == std::vector<double>{4, 8, 16, 32});
    REQUIRE(errors.errorsOf.size() == 8);
    REQUIRE(errors.errorsOf[0].size() == 4);
    // The variance of one sample's mean is known to √(2 / (64 · 1536)), 0.5 %. The reference's
    // noise is what it is expected to be but for √(2 / 1536), 3.6 %, and relMSE at its pixels is
    // that at 1 but for the curvature, 3 · 0.01.
    double first = 0.0;
    for (const auto& of : errors.errorsOf) first += of[0] / 8.0;
    CHECK(first == doctest::Approx(variance / 1.01).epsilon(0.15));
    const Noise noise = noiseOf(errors);
    CHECK(noise.interval.contains(noise.value));
    // At eight samples the reference's share is eight times as large beside the picture's.
    CHECK(noise.value == doctest::Approx(32 * variance / 8.0 / 1.01).epsilon(0.7));
}

TEST_CASE("Regress judge: the slope is −1 though a few samples are bright") {
    ReferencePicture reference;
    reference.pixels = Picture(3 * 32 * 16, 1.0f);
    const auto slopeOf = [&](double brightness, bool isShared) {
        const BlockErrors errors =
            blockErrors(progressive(32, 0.1, brightness, isShared), 16, reference);
        return convergenceSlope(errors.samples, errors.errorsOf, 1000);
    };
    const ConvergenceSlope even = slopeOf(0.0, false), bright = slopeOf(300.0, false);
    CHECK(even.verdict == SlopeVerdict::pass);
    // One sample in each of three seeds is most of all of the noise.
    CHECK(bright.verdict == SlopeVerdict::pass);
    CHECK(bright.interval.width() < 0.03);
    // Pairs of samples that are one: the first octave gains nothing.
    CHECK(slopeOf(0.0, true).verdict == SlopeVerdict::fail);
    CHECK(slopeOf(0.0, true).slope > -0.95);
}

TEST_CASE("Regress judge: noise is told from noise by both intervals") {
    // Intervals of ± 5 % are about 1.9 % of standard error each, 2.7 % together; at a level of
    // 0.01 / 100 Student's t of 31 is 4.4, so that 12 % is what can be told.
    CHECK(judgeNoise(noise(1.0, 0.05), noise(1.1, 0.05), 100, 32) == NoiseVerdict::same);
    CHECK(judgeNoise(noise(1.0, 0.05), noise(1.15, 0.05), 100, 32) == NoiseVerdict::worse);
    CHECK(judgeNoise(noise(1.0, 0.05), noise(0.85, 0.05), 100, 32) == NoiseVerdict::better);
    CHECK(judgeNoise(noise(1.0, 0.05), noise(1.1, 0.05), 1, 32) == NoiseVerdict::worse);
    CHECK(judgeNoise(noise(1.0, 0.5), noise(1.15, 0.05), 100, 32) == NoiseVerdict::same);
    // Errors below the reference's noise have no logarithm.
    CHECK(judgeNoise(noise(1.0, 0.05), {-0.1, {-0.2, 0.1}}, 100, 32) == NoiseVerdict::same);
    CHECK(judgeNoise(noise(1.0, 0.05), {5.0, {-0.2, 9.0}}, 100, 32) == NoiseVerdict::worse);
}

TEST_CASE("Regress judge: a slope is wrong by the level of all cells") {
    const auto verdict = [](double slope, double halfWidth, std::size_t cells) {
        const Interval interval{slope - halfWidth, slope + halfWidth};
        const bool isNarrow = interval.width() < 0.1, isRight = interval.contains(-1.0);
        return judgeRate({slope, interval,
                          !isNarrow ? SlopeVerdict::inconclusive
                          : isRight ? SlopeVerdict::pass
                                    : SlopeVerdict::fail},
                         cells, 32);
    };
    // Student's t of 31 is 2.74 at 99 %, 4.4 at a level of 0.01 / 100: 1.6 times as wide.
    CHECK(verdict(-0.98, 0.03, 100) == SlopeVerdict::pass);
    CHECK(verdict(-0.95, 0.03, 1) == SlopeVerdict::fail);
    CHECK(verdict(-0.95, 0.03, 100) == SlopeVerdict::pass);
    CHECK(verdict(-0.94, 0.03, 100) == SlopeVerdict::fail);
    CHECK(verdict(-1.06, 0.03, 100) == SlopeVerdict::fail);
    // However narrow, a slope that is as good as −1 is not wrong.
    CHECK(verdict(-1.009, 0.0001, 1) == SlopeVerdict::pass);
    CHECK(verdict(-1.011, 0.0001, 1) == SlopeVerdict::fail);
    CHECK(verdict(-1.0, 0.06, 100) == SlopeVerdict::inconclusive);
    CHECK(verdict(-0.5, 0.06, 100) == SlopeVerdict::inconclusive);
}

TEST_CASE("Regress judge: checkpoints are sixteen, evenly spaced") {
    CHECK(checkpointsUpTo(16) ==
          std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16});
    CHECK(checkpointsUpTo(64).front() == 4);
    CHECK(checkpointsUpTo(64).back() == 64);
}
