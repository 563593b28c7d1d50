#include "statistics/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace etendue {

namespace {

/// Uniform in [0, count). std::uniform_int_distribution differs between standard libraries.
std::size_t drawIndex(std::mt19937_64& generator, std::size_t count) {
    const std::uint64_t accepted =
        std::mt19937_64::max() - std::mt19937_64::max() % static_cast<std::uint64_t>(count);
    std::uint64_t drawn = generator();
    while (drawn >= accepted) drawn = generator();
    return static_cast<std::size_t>(drawn % count);
}

/// `values` ascending; linear between neighbours.
double quantile(std::span<const double> values, double fraction) {
    const double position = fraction * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(position);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], position - static_cast<double>(below));
}

}  // namespace

Interval bootstrapInterval(std::size_t count, const ResampledStatistic& statistic,
                           double confidence, int resamples, std::uint64_t seed) {
    if (count == 0 || resamples < 1 || !(confidence > 0.0 && confidence < 1.0))
        throw std::invalid_argument("a bootstrap needs observations, resamples and a confidence");
    std::mt19937_64 generator(seed);
    std::vector<std::size_t> chosen(count);
    std::vector<double> values(static_cast<std::size_t>(resamples));
    for (double& value : values) {
        for (std::size_t& index : chosen) index = drawIndex(generator, count);
        value = statistic(chosen);
        if (std::isnan(value)) return {value, value};
    }
    std::ranges::sort(values);
    const double tail = (1.0 - confidence) / 2.0;
    return {quantile(values, tail), quantile(values, 1.0 - tail)};
}

}  // namespace etendue
