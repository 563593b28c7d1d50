// Means of random quantities, and how surprising they are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "renderer/random.h"
#include "statistics/statistics.h"

namespace etendue {

/// The chance that a correct program fails a test case by bad luck of its (fixed) seeds.
inline constexpr double falseAlarmLevel = 1e-3;

/// Summary of `value(random)` over `count` independent streams of numbers.
template <class Value>
Summary estimate(std::uint32_t count, std::uint64_t seed, Value value) {
    std::vector<double> values;
    values.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        RandomStream random(seed, i, 0, RandomDomain::test);
        values.push_back(value(random));
    }
    return summarize(values);
}

/// How likely a mean at least so far from `expected` is if that is the true one, when each value is
/// rounded by up to `relativeRounding` of it.
inline double meanPValue(const Summary& summary, double expected, double relativeRounding) {
    const double excess = std::abs(summary.mean - expected) - relativeRounding * std::abs(expected);
    if (excess <= 0.0) return 1.0;
    return summary.standardError > 0.0 ? normalTwoSidedP(excess / summary.standardError) : 0.0;
}

/// Of `value` against an expectation; 0 when both are zero.
inline double relativeError(double value, double expected) {
    return value == expected ? 0.0 : std::abs((value - expected) / expected);
}

}  // namespace etendue
