// How fast errors fall: the slope over samples, and the time to an error.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "statistics/bootstrap.h"

namespace etendue {

/// Whether a mean squared error falls like 1 / samples.
enum class SlopeVerdict {
    pass,          // the 99 % interval of the slope contains −1 and is narrower than 0.1
    inconclusive,  // it is no narrower: no pass
    fail,          // it is narrow and lacks −1
};
std::string_view name(SlopeVerdict verdict);

struct ConvergenceSlope {
    double slope = 0.0;  // of log(mean error over the seeds) over log(samples), least squares
    Interval interval;   // 99 %, by a bootstrap over the seeds
    SlopeVerdict verdict = SlopeVerdict::inconclusive;
};

/// `errorsBySeed[seed][step]`: a mean squared error (any that falls like a variance) after
/// `samples[step]` samples; at least two different steps. Seeds are independent, the steps of one
/// seed need not be. NaN, hence inconclusive, where a mean error is not above 0;
/// std::invalid_argument for seeds of different lengths.
ConvergenceSlope convergenceSlope(std::span<const double> samples,
                                  const std::vector<std::vector<double>>& errorsBySeed,
                                  int resamples = 10'000, std::uint64_t bootstrapSeed = 0);

/// Where a curve of errors crosses a target for the last time.
struct TimeToError {
    double seconds = 0.0;
    /// The target lies beyond the last checkpoint (or before the first): `seconds` supposes that
    /// errors fall like 1 / time.
    bool isExtrapolated = false;
};

/// `errors[i]` after `seconds[i]`, ascending; log error is taken linear in log time between them.
/// All above 0; otherwise std::invalid_argument.
TimeToError timeToError(std::span<const double> seconds, std::span<const double> errors,
                        double target);

}  // namespace etendue
