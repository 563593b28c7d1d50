#include "statistics/convergence.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace etendue {

namespace {

constexpr double slopeOfVariance = -1.0;
constexpr double widestPassing = 0.1;

/// Weights w with Σ w·y the slope of the least-squares line through (x, y).
std::vector<double> slopeWeights(std::span<const double> x) {
    const double mean = std::reduce(x.begin(), x.end()) / static_cast<double>(x.size());
    double spread = 0.0;
    for (const double value : x) spread += (value - mean) * (value - mean);
    if (!(spread > 0.0)) throw std::invalid_argument("a slope needs two different steps");
    std::vector<double> weights;
    for (const double value : x) weights.push_back((value - mean) / spread);
    return weights;
}

SlopeVerdict judge(const Interval& interval) {
    if (!(interval.width() < widestPassing)) return SlopeVerdict::inconclusive;
    return interval.contains(slopeOfVariance) ? SlopeVerdict::pass : SlopeVerdict::fail;
}

bool areAllPositive(std::span<const double> values) {
    return std::ranges::all_of(values, [](double v) { return v > 0.0 && std::isfinite(v); });
}

}  // namespace

std::string_view name(SlopeVerdict verdict) {
    switch (verdict) {
        case SlopeVerdict::pass:
            return "pass";
        case SlopeVerdict::inconclusive:
            return "inconclusive";
        case SlopeVerdict::fail:
            break;
    }
    return "fail";
}

ConvergenceSlope convergenceSlope(std::span<const double> samples,
                                  const std::vector<std::vector<double>>& errorsBySeed,
                                  int resamples, std::uint64_t bootstrapSeed) {
    const std::size_t steps = samples.size();
    const auto hasAllSteps = [steps](const auto& errors) { return errors.size() == steps; };
    if (errorsBySeed.empty() || !areAllPositive(samples) ||
        !std::ranges::all_of(errorsBySeed, hasAllSteps))
        throw std::invalid_argument("a slope needs seeds, each with an error for every step");
    std::vector<double> logSamples;
    for (const double n : samples) logSamples.push_back(std::log(n));
    const std::vector<double> weights = slopeWeights(logSamples);

    const auto slopeOf = [&](std::span<const std::size_t> seeds) {
        double slope = 0.0;
        for (std::size_t step = 0; step < steps; ++step) {
            double sum = 0.0;
            for (const std::size_t seed : seeds) sum += errorsBySeed[seed][step];
            // log of a negative number is NaN, which is wanted, that of 0 is not.
            slope += weights[step] * (sum > 0.0 ? std::log(sum) : std::nan(""));
        }
        return slope;
    };
    std::vector<std::size_t> all(errorsBySeed.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    ConvergenceSlope result;
    result.slope = slopeOf(all);
    result.interval = bootstrapInterval(all.size(), slopeOf, 0.99, resamples, bootstrapSeed);
    result.verdict = judge(result.interval);
    return result;
}

TimeToError timeToError(std::span<const double> seconds, std::span<const double> errors,
                        double target) {
    if (seconds.empty() || seconds.size() != errors.size() || !areAllPositive(seconds) ||
        !areAllPositive(errors) || !(target > 0.0) || !std::ranges::is_sorted(seconds))
        throw std::invalid_argument("a time to an error needs ascending times and errors above 0");
    // Noise may carry a curve over the target more than once: the last crossing is the honest one.
    std::size_t reached = errors.size();
    while (reached > 0 && errors[reached - 1] <= target) --reached;
    if (reached == errors.size()) return {seconds.back() * errors.back() / target, true};
    if (reached == 0) return {seconds.front() * errors.front() / target, true};
    const double before = std::log(errors[reached - 1]), after = std::log(errors[reached]);
    const double fraction = (before - std::log(target)) / (before - after);
    const double logTime =
        std::lerp(std::log(seconds[reached - 1]), std::log(seconds[reached]), fraction);
    return {std::exp(logTime), false};
}

}  // namespace etendue
