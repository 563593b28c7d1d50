// Statistics: the tests by which samplers and pictures are judged. Boost.Math is known to
// statistics.cpp alone.
#pragma once

#include <span>

namespace etendue {

/// Mean and spread of independent values.
struct Summary {
    double mean = 0.0;
    double variance = 0.0;       // unbiased estimate; 0 for fewer than two values
    double standardError = 0.0;  // of the mean
    std::size_t count = 0;
};
Summary summarize(std::span<const double> values);

/// Per-test level that keeps the chance of any false alarm among `tests` independent ones at
/// `level`.
double sidakLevel(double level, std::size_t tests);

/// Two-sided probability of |t| or more under Student's distribution.
double studentTwoSidedP(double t, double degreesOfFreedom);
/// t such that |t| is exceeded with probability 1 − `confidence`.
double studentQuantile(double confidence, double degreesOfFreedom);
/// Two-sided probability of |z| or more under the normal distribution.
double normalTwoSidedP(double z);

/// Welch's t-test of equal means; p = 1 when neither sample varies and the means are equal, 0 when
/// they differ without varying. Each sample needs at least two values.
struct WelchResult {
    double difference = 0.0;     // mean a − mean b
    double standardError = 0.0;  // of the difference
    double degreesOfFreedom = 0.0;
    double pValue = 1.0;
};
WelchResult welchTest(std::span<const double> a, std::span<const double> b);

/// Pearson's χ² of observed counts against expected counts (the same total, up to sampling). Cells
/// that expect fewer than five are pooled. `countInEmptyCells` > 0 is a failure by itself: a sample
/// was drawn where the density is zero.
struct ChiSquareResult {
    double statistic = 0.0;
    double degreesOfFreedom = 0.0;
    double pValue = 1.0;
    double countInEmptyCells = 0.0;
};
ChiSquareResult chiSquareTest(std::span<const double> observed, std::span<const double> expected);

}  // namespace etendue
