#include "statistics/bootstrap.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "statistics/statistics.h"

namespace etendue {

namespace {

/// Of `values`, for a bootstrap.
ResampledStatistic meanOf(const std::vector<double>& values) {
    return [&values](std::span<const std::size_t> chosen) {
        double sum = 0.0;
        for (const std::size_t i : chosen) sum += values[i];
        return sum / static_cast<double>(chosen.size());
    };
}

}  // namespace

TEST_CASE("bootstrapInterval: the mean of a coin's throws has the binomial quantiles") {
    // Of 16 throws, 8 heads: a resample has as many heads as a fair coin in 16 throws, 2 or fewer
    // with 0.0021 and 3 or fewer with 0.0106. Of 20,000 resamples the share of either tail varies
    // by 0.0005, so that the 0.5 % quantile is 3, and 13 on the other side.
    std::vector<double> throws(16, 0.0);
    for (std::size_t i = 0; i < 8; ++i) throws[2 * i] = 1.0;
    const Interval interval = bootstrapInterval(16, meanOf(throws), 0.99, 20'000, 1);
    CHECK(interval.low == 3.0 / 16.0);
    CHECK(interval.high == 13.0 / 16.0);
    CHECK(interval.width() == 10.0 / 16.0);
    CHECK(interval.contains(0.5));
    CHECK_FALSE(interval.contains(0.15));
    CHECK_FALSE(interval.contains(0.85));
}

TEST_CASE("bootstrapInterval: every observation is drawn equally often") {
    constexpr std::size_t count = 7;
    std::vector<double> drawn(count, 0.0);
    const auto tally = [&](std::span<const std::size_t> chosen) {
        for (const std::size_t i : chosen) drawn.at(i) += 1.0;
        return 0.0;
    };
    bootstrapInterval(count, tally, 0.5, 10'000, 2);
    CHECK(chiSquareTest(drawn, std::vector<double>(count, 10'000.0)).pValue > 1e-4);
}

TEST_CASE("bootstrapInterval: the same seed gives the same bits, another seed others") {
    std::vector<double> values;
    for (int i = 0; i < 32; ++i) values.push_back(std::sqrt(i));
    const Interval a = bootstrapInterval(32, meanOf(values), 0.9, 500, 5);
    const Interval b = bootstrapInterval(32, meanOf(values), 0.9, 500, 5);
    const Interval c = bootstrapInterval(32, meanOf(values), 0.9, 500, 6);
    CHECK(a.low == b.low);
    CHECK(a.high == b.high);
    CHECK(a.low != c.low);
}

TEST_CASE(
    "bootstrapInterval: of 32 normal values, 95 % intervals hold the mean as often as theory "
    "says") {
    // The resampled mean varies by s·√(31/32)/√32, s the sample's deviation: the interval holds the
    // true mean when |t| < 1.96·√(31/32) under Student's distribution, 93.7 % of the time.
    constexpr int trials = 1000, count = 32;
    const double expected = 1.0 - studentTwoSidedP(1.959964 * std::sqrt(31.0 / 32.0), count - 1);
    std::mt19937_64 generator(7);
    std::normal_distribution<double> normal;
    int held = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<double> values;
        for (int i = 0; i < count; ++i) values.push_back(normal(generator));
        held +=
            bootstrapInterval(count, meanOf(values), 0.95, 400, generator()).contains(0.0) ? 1 : 0;
    }
    const double standardError = std::sqrt(expected * (1.0 - expected) / trials);
    // Quantiles of 400 resamples are off by themselves, which costs some 0.3 % of coverage.
    CHECK(std::abs(held / static_cast<double>(trials) - expected) < 4.0 * standardError + 0.003);
}

TEST_CASE(
    "bootstrapInterval: what is no number gives no interval, and nothing to draw is refused") {
    const Interval interval = bootstrapInterval(
        3, [](auto) { return std::nan(""); }, 0.9, 10, 1);
    CHECK(std::isnan(interval.low));
    CHECK(std::isnan(interval.high));
    // Nor does what is one for most draws.
    const auto sometimes = [](std::span<const std::size_t> chosen) {
        return chosen[0] == 2 ? std::nan("") : 1.0;
    };
    CHECK(std::isnan(bootstrapInterval(30, sometimes, 0.9, 100, 1).low));
    const auto zero = [](auto) { return 0.0; };
    CHECK_THROWS_AS(bootstrapInterval(0, zero, 0.9, 10, 1), std::invalid_argument);
    CHECK_THROWS_AS(bootstrapInterval(3, zero, 0.9, 0, 1), std::invalid_argument);
    CHECK_THROWS_AS(bootstrapInterval(3, zero, 99.0, 10, 1), std::invalid_argument);
}

}  // namespace etendue
