// What a benchmark's records say: means over seeds with their intervals, slopes, efficiencies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "statistics/bootstrap.h"
#include "tools/bench_records.h"

namespace etendue {

struct BenchFigure {
    double value = 0.0;
    Interval interval;  // 95 %, by a bootstrap over the seeds; see smallSampleConfidence
};

/// After so many samples; errors less what the reference's own noise adds to them.
struct BenchPoint {
    std::uint32_t samples = 0;
    double seconds = 0.0;  // median over the seeds
    BenchFigure relMse;
    ImageErrors errors;               // means over the seeds
    double meanErrorHalfWidth = 0.0;  // 95 %, Student's
};

/// Of one estimator under one variant.
struct BenchResult {
    BenchConfiguration configuration;
    std::vector<BenchPoint> curve;        // after counts that every seed reached
    std::optional<BenchFigure> slope;     // of log relMse over log samples
    double samples = 0.0, seconds = 0.0;  // medians at the end of the runs
    BenchFigure relMse;                   // after that time, at the median speed
    BenchFigure efficiency;               // 1 / (relMse · seconds), at the end of the runs
    BenchFigure ratio;  // of efficiency, to the first of the same scene and camera
    std::optional<BenchFigure> secondsToTarget;
    bool isExtrapolated = false;             // secondsToTarget
    std::optional<BenchPoint> equalSamples;  // at the most that all of the same scene and camera
                                             // reached
    double flip = 0.0;                       // mean over the seeds, at the end of the runs
    std::uint64_t badSamples = 0;
    /// The reference's expected error is above a tenth of this result's: what is left after taking
    /// it off is not to be trusted.
    bool isBelowReference = false;
};

/// Of the runs that are there; those of one scene and camera follow each other, in the order in
/// which they were run. A configuration with fewer than two runs is left out.
std::vector<BenchResult> summarizeBench(const BenchRecords& records, double targetRelMse);

/// The confidence to ask a percentile bootstrap of `count` observations for, so that the mean of
/// normal ones is covered with `confidence`: the expanded percentile interval of Hesterberg 2015,
/// "What Teachers Should Know About the Bootstrap", section 4.4.
double smallSampleConfidence(double confidence, std::size_t count);

/// A table for the terminal.
std::string benchText(const std::vector<BenchResult>& results, const BenchRecords& records,
                      double targetRelMse);

}  // namespace etendue
