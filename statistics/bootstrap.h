// Confidence intervals of statistics whose distribution nobody knows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace etendue {

struct Interval {
    double low = 0.0, high = 0.0;
    bool contains(double x) const { return low <= x && x <= high; }
    double width() const { return high - low; }
};

/// A statistic of those of the independent observations 0 … count − 1 that are chosen, some several
/// times.
using ResampledStatistic = std::function<double(std::span<const std::size_t> chosen)>;

/// Percentile bootstrap (Efron 1979) with `confidence` in (0, 1): draws `count` of the observations
/// with replacement, `resamples` times. The same arguments give the same bits on every platform.
/// NaN where the statistic is NaN for any draw; std::invalid_argument without an observation or a
/// resample.
///
/// Of a few observations intervals come out somewhat narrow (docs/metrics.md).
Interval bootstrapInterval(std::size_t count, const ResampledStatistic& statistic,
                           double confidence, int resamples, std::uint64_t seed);

}  // namespace etendue
