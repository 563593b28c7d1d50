#include "statistics/convergence.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace etendue {

namespace {

const std::vector<double> octaves{4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0};

/// Of each seed, errors that fall like samples^slope, times 1 ± `scatter` of its own.
std::vector<std::vector<double>> powerLaw(double slope, double scatter) {
    std::mt19937_64 generator(3);
    std::uniform_real_distribution<double> factor(1.0 - scatter, 1.0 + scatter);
    std::vector<std::vector<double>> errors(32);
    for (auto& ofSeed : errors)
        for (const double n : octaves)
            ofSeed.push_back(5.0 * std::pow(n, slope) * factor(generator));
    return errors;
}

}  // namespace

TEST_CASE("convergenceSlope: of a power law, its exponent") {
    const ConvergenceSlope slope = convergenceSlope(octaves, powerLaw(-0.7, 0.0), 100);
    CHECK(slope.slope == doctest::Approx(-0.7).epsilon(1e-12));
    CHECK(slope.interval.width() < 1e-12);
}

TEST_CASE("convergenceSlope: verdicts by the interval, its width first") {
    CHECK(convergenceSlope(octaves, powerLaw(-1.0, 0.1), 2000).verdict == SlopeVerdict::pass);
    // A scatter of 10 % over 32 seeds is known to some 0.01: slopes that are off by 0.05 show.
    CHECK(convergenceSlope(octaves, powerLaw(-0.95, 0.1), 2000).verdict == SlopeVerdict::fail);
    CHECK(convergenceSlope(octaves, powerLaw(-1.05, 0.1), 2000).verdict == SlopeVerdict::fail);
    const ConvergenceSlope noisy = convergenceSlope(octaves, powerLaw(-1.0, 1.0), 2000);
    CHECK(noisy.interval.width() > 0.1);
    CHECK(noisy.verdict == SlopeVerdict::inconclusive);
    CHECK(name(SlopeVerdict::pass) == "pass");
    CHECK(name(SlopeVerdict::inconclusive) == "inconclusive");
    CHECK(name(SlopeVerdict::fail) == "fail");
}

TEST_CASE("convergenceSlope: means of independent samples pass") {
    // 32 seeds of 400 pixels, each the mean of `n` values: the mean squared error of a step is
    // known to √(2 / 12,800) = 1.25 %, the slope over six octaves to some 0.005.
    constexpr int pixels = 400;
    std::mt19937_64 generator(11);
    std::normal_distribution<double> normal;
    std::vector<std::vector<double>> errors(32);
    for (auto& ofSeed : errors)
        for (const double n : octaves) {
            double sum = 0.0;
            for (int pixel = 0; pixel < pixels; ++pixel) {
                const double error = normal(generator) / std::sqrt(n);
                sum += error * error;
            }
            ofSeed.push_back(sum / pixels);
        }
    const ConvergenceSlope slope = convergenceSlope(octaves, errors, 2000);
    CHECK(slope.verdict == SlopeVerdict::pass);
    CHECK(slope.interval.contains(slope.slope));
}

TEST_CASE("convergenceSlope: it is the mean of the seeds that falls, not each seed") {
    // One seed has all the error of each step: a mean of logarithms would be none of a number.
    const std::vector<std::vector<double>> errors{{2.0, 0.0}, {0.0, 1.0}};
    const std::vector<double> samples{1.0, 2.0};
    const ConvergenceSlope slope = convergenceSlope(samples, errors, 1);
    CHECK(slope.slope == doctest::Approx(-1.0).epsilon(1e-12));
}

TEST_CASE(
    "convergenceSlope: an error not above 0 is inconclusive, seeds of two lengths are refused") {
    std::vector<std::vector<double>> errors = powerLaw(-1.0, 0.0);
    for (auto& ofSeed : errors) ofSeed[3] = 0.0;
    const ConvergenceSlope slope = convergenceSlope(octaves, errors, 10);
    CHECK(std::isnan(slope.slope));
    CHECK(slope.verdict == SlopeVerdict::inconclusive);
    errors[5].pop_back();
    CHECK_THROWS_AS(convergenceSlope(octaves, errors, 10), std::invalid_argument);
    CHECK_THROWS_AS(convergenceSlope(octaves, {}, 10), std::invalid_argument);
    CHECK_THROWS_AS(convergenceSlope(std::vector{4.0, 4.0}, {{1.0, 1.0}}, 10),
                    std::invalid_argument);
}

TEST_CASE("timeToError: log-log between checkpoints, 1 / time beyond them") {
    // Errors that fall like 1/√time, which between checkpoints is met exactly.
    const std::vector<double> seconds{1.0, 4.0, 16.0}, errors{8.0, 4.0, 2.0};
    const TimeToError between = timeToError(seconds, errors, 8.0 / 3.0);
    CHECK(between.seconds == doctest::Approx(9.0).epsilon(1e-12));
    CHECK_FALSE(between.isExtrapolated);
    const TimeToError beyond = timeToError(seconds, errors, 1.0);
    CHECK(beyond.seconds == doctest::Approx(32.0).epsilon(1e-12));
    CHECK(beyond.isExtrapolated);
    const TimeToError before = timeToError(seconds, errors, 16.0);
    CHECK(before.seconds == doctest::Approx(0.5).epsilon(1e-12));
    CHECK(before.isExtrapolated);
    const TimeToError atCheckpoint = timeToError(seconds, errors, 4.0);
    CHECK(atCheckpoint.seconds == doctest::Approx(4.0).epsilon(1e-12));
    CHECK_FALSE(atCheckpoint.isExtrapolated);
    CHECK_FALSE(timeToError(seconds, errors, 2.0).isExtrapolated);
}

TEST_CASE("timeToError: a target crossed several times is reached the last time") {
    const std::vector<double> seconds{1.0, 2.0, 4.0, 8.0}, errors{4.0, 1.0, 3.0, 1.0};
    const double time = timeToError(seconds, errors, 2.0).seconds;
    CHECK(time > 4.0);
    CHECK(time < 8.0);
}

TEST_CASE("timeToError: what no logarithm can take is refused") {
    const std::vector<double> two{1.0, 2.0}, bad{1.0, 0.0}, falling{2.0, 1.0};
    CHECK_THROWS_AS(timeToError(two, bad, 1.0), std::invalid_argument);
    CHECK_THROWS_AS(timeToError(bad, two, 1.0), std::invalid_argument);
    CHECK_THROWS_AS(timeToError(falling, two, 1.0), std::invalid_argument);
    CHECK_THROWS_AS(timeToError(two, two, 0.0), std::invalid_argument);
    CHECK_THROWS_AS(timeToError(two, std::vector{1.0}, 1.0), std::invalid_argument);
}

}  // namespace etendue
