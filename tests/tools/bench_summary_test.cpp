// Summaries of a benchmark, from records whose answers are known.
#include "tools/bench_summary.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "statistics/statistics.h"

using namespace etendue;

namespace {

using doctest::Approx;

/// A run whose error is `errorOfOne` / samples plus `bias`, whose samples take `secondsOfOne`.
BenchRun runOf(const std::string& estimator, int seed, double errorOfOne, double secondsOfOne,
               std::uint32_t last = 64, double bias = 0.0) {
    BenchRun run;
    run.configuration = {"box", "own", "", estimator};
    run.seed = seed;
    run.flip = 0.5;
    for (std::uint32_t n = 1; n <= last; n *= 2) {
        BenchCheckpoint c{n, secondsOfOne * n, {}};
        c.errors.relMse = errorOfOne / n + bias;
        c.errors.mse = 2.0 * c.errors.relMse;
        c.errors.meanError = seed % 2 == 0 ? 0.01 : -0.01;
        run.checkpoints.push_back(c);
    }
    return run;
}

BenchRecords twoEstimators(double bias = 0.0) {
    BenchRecords records;
    for (int seed = 0; seed < 4; ++seed) {
        records.runs.push_back(runOf("pt", seed, 3.2, 0.01, 64, bias));
        records.runs.push_back(runOf("bdpt", seed, 0.8, 0.02, 32, bias));
    }
    return records;
}

}  // namespace

TEST_CASE("Bench summary: slope, efficiency, ratio and time to an error of known curves") {
    const auto results = summarizeBench(twoEstimators(), 0.1);
    REQUIRE(results.size() == 2);
    const BenchResult &pt = results[0], &bdpt = results[1];
    CHECK(pt.configuration.estimator == "pt");
    CHECK(pt.slope.value().value == Approx(-1.0));
    CHECK(pt.slope.value().interval.width() < 1e-9);
    CHECK(pt.efficiency.value == Approx(1.0 / 0.032));
    CHECK(bdpt.efficiency.value == Approx(1.0 / 0.016));
    CHECK(pt.ratio.value == Approx(1.0));
    CHECK(bdpt.ratio.value == Approx(2.0));
    CHECK(pt.secondsToTarget.value().value == Approx(0.32));
    CHECK(!pt.isExtrapolated);
    CHECK(pt.relMse.value == Approx(3.2 / 64));
    CHECK(pt.equalSamples.value().samples == 32);
    CHECK(pt.equalSamples.value().relMse.value == Approx(0.1));
    CHECK(bdpt.equalSamples.value().relMse.value == Approx(0.025));
    CHECK(pt.curve.size() == 7);
    CHECK(pt.curve[3].errors.mse == Approx(2.0 * 3.2 / 8));
    CHECK(pt.curve[3].errors.meanError == Approx(0.0).scale(1.0));
    // Of -0.01, 0.01, -0.01, 0.01: s / √4 = 0.01 √(4/3) / 2, times Student's 3.182 (3 degrees).
    CHECK(pt.curve[3].meanErrorHalfWidth == Approx(3.1824 * 0.01 * std::sqrt(1.0 / 3.0)));
    CHECK(pt.flip == 0.5);
}

TEST_CASE("Bench summary: beyond the runs, the time to an error is extrapolated") {
    const auto results = summarizeBench(twoEstimators(), 0.001);
    CHECK(results[0].isExtrapolated);
    CHECK(results[0].secondsToTarget.value().value == Approx(32.0));
}

TEST_CASE("Bench summary: the reference's own error is taken off, and told where it matters") {
    BenchRecords records = twoEstimators(0.002);
    records.references.push_back({"box", "own", "bdpt", "", 1, 1.0, 0.002});
    auto results = summarizeBench(records, 0.1);
    CHECK(results[0].relMse.value == Approx(3.2 / 64));
    CHECK(results[0].slope.value().value == Approx(-1.0));
    CHECK(!results[0].isBelowReference);
    records = twoEstimators(0.02);
    records.references.push_back({"box", "own", "bdpt", "", 1, 1.0, 0.02});
    results = summarizeBench(records, 0.1);
    CHECK(results[0].isBelowReference);
    CHECK(results[1].isBelowReference);
    records.references.front().scene = "hall";
    CHECK(summarizeBench(records, 0.1)[0].relMse.value == Approx(3.2 / 64 + 0.02));
}

TEST_CASE("Bench summary: a run that got little of the machine does not change the ratio") {
    BenchRecords records = twoEstimators();
    records.runs[2] = runOf("pt", 1, 3.2, 0.1, 4);
    const auto results = summarizeBench(records, 0.1);
    CHECK(results[0].efficiency.value == Approx(1.0 / 0.032));
    CHECK(results[1].ratio.value == Approx(2.0));
}

TEST_CASE("Bench summary: views follow each other whole, and one run alone says nothing") {
    BenchRecords records;
    for (int seed = 0; seed < 2; ++seed)
        for (const char* scene : {"a", "b"}) {
            BenchRun run = runOf("pt", seed, 1.0, 1.0);
            run.configuration.scene = scene;
            records.runs.push_back(run);
        }
    records.runs.push_back(runOf("pt", 0, 1.0, 1.0));
    BenchRun late = runOf("lt", 0, 1.0, 1.0);
    late.configuration.scene = "a";
    records.runs.push_back(late);
    records.runs.push_back(late);
    const auto results = summarizeBench(records, 0.1);
    REQUIRE(results.size() == 3);
    CHECK(results[0].configuration.scene == "a");
    CHECK(results[1].configuration.estimator == "lt");
    CHECK(results[2].configuration.scene == "b");
}

TEST_CASE("Bench summary: intervals of few seeds cover as often as they say") {
    // Means of eight normal numbers; the share of 2000 intervals that cover has a standard error of
    // 0.005. The plain percentile interval covers 90 %.
    constexpr int trials = 2000;
    constexpr std::size_t count = 8;
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    int covered = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<double> values(count);
        for (double& value : values) value = normal(random);
        const Interval interval = bootstrapInterval(
            count,
            [&](std::span<const std::size_t> chosen) {
                double sum = 0.0;
                for (const std::size_t i : chosen) sum += values[i];
                return sum / count;
            },
            smallSampleConfidence(0.95, count), 400, static_cast<std::uint64_t>(trial));
        if (interval.contains(0.0)) ++covered;
    }
    CHECK(covered > 0.93 * trials);
    CHECK(covered < 0.97 * trials);
}

TEST_CASE(
    "Bench summary: of a black scene there is no ratio of efficiencies, and none is printed") {
    BenchRecords records;
    for (const char* estimator : {"pt", "bdpt"})
        for (int seed = 0; seed < 2; ++seed)
            records.runs.push_back(runOf(estimator, seed, 0.0, 0.01));
    const auto results = summarizeBench(records, 0.1);
    REQUIRE(results.size() == 2);
    const std::string text = benchText(results, records, 0.1);
    CHECK(text.find("0 (0 – 0)") != text.npos);
    CHECK(text.find("nan") == text.npos);
}
