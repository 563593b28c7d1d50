#include "statistics/statistics.h"

#include <doctest/doctest.h>

#include <random>
#include <vector>

using namespace etendue;

TEST_CASE("Statistics: summary of a short list") {
    const std::vector<double> values{1, 2, 3, 4};
    const Summary s = summarize(values);
    CHECK(s.mean == doctest::Approx(2.5));
    CHECK(s.variance == doctest::Approx(5.0 / 3.0));
    CHECK(s.standardError == doctest::Approx(std::sqrt(5.0 / 12.0)));
}

TEST_CASE("Statistics: tabulated quantiles") {
    // Any table of Student's distribution: 2.262 for 9 degrees of freedom, 95 % two-sided.
    CHECK(studentTwoSidedP(2.2622, 9) == doctest::Approx(0.05).epsilon(1e-3));
    CHECK(studentQuantile(0.95, 9) == doctest::Approx(2.2622).epsilon(1e-4));
    CHECK(normalTwoSidedP(1.959964) == doctest::Approx(0.05).epsilon(1e-5));
    CHECK(1 - std::pow(1 - sidakLevel(0.01, 50), 50) == doctest::Approx(0.01));
}

TEST_CASE("Statistics: Welch's test on a worked example") {
    // a: mean 20.82, b: mean 23.0, computed by hand from the definitions.
    const std::vector<double> a{19, 21, 20, 22, 22.1}, b{23, 25, 22, 22, 23};
    const WelchResult w = welchTest(a, b);
    const double va = summarize(a).variance / 5, vb = summarize(b).variance / 5;
    CHECK(w.difference == doctest::Approx(20.82 - 23.0));
    CHECK(w.standardError == doctest::Approx(std::sqrt(va + vb)));
    CHECK(w.degreesOfFreedom ==
          doctest::Approx((va + vb) * (va + vb) / (va * va / 4 + vb * vb / 4)));
    const std::vector<double> same{1, 1}, other{2, 2};
    CHECK(welchTest(same, same).pValue == 1.0);
    CHECK(welchTest(same, other).pValue == 0.0);
}

TEST_CASE(
    "Statistics: under the null hypothesis both tests raise false alarms at their nominal level") {
    std::mt19937_64 engine(3);
    std::normal_distribution<double> normal;
    constexpr int trials = 4000;
    int welchAlarms = 0, chiAlarms = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<double> a(16), b(16);
        for (double& v : a) v = normal(engine);
        for (double& v : b) v = 3.0 * normal(engine);
        welchAlarms += welchTest(a, b).pValue < 0.05;
        std::vector<double> observed(10), expected(10, 100.0);
        std::uniform_int_distribution<std::size_t> cell(0, 9);
        for (int i = 0; i < 1000; ++i) ++observed[cell(engine)];
        chiAlarms += chiSquareTest(observed, expected).pValue < 0.05;
    }
    // Four standard errors of a share of 5 % in 4000 trials: 0.0138.
    CHECK(std::abs(welchAlarms / static_cast<double>(trials) - 0.05) < 0.0138);
    CHECK(std::abs(chiAlarms / static_cast<double>(trials) - 0.05) < 0.0138);
}

TEST_CASE("Statistics: chi-square pools thin cells and counts what falls where nothing may") {
    const std::vector<double> expected{100, 2, 2, 2, 0}, observed{98, 3, 1, 2, 1};
    const ChiSquareResult r = chiSquareTest(observed, expected);
    CHECK(r.degreesOfFreedom == 1);
    CHECK(r.countInEmptyCells == 1);
    CHECK(r.statistic == doctest::Approx(4.0 / 100));
}
