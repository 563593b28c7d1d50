// How regression tests judge: bias against a stored reference, the rate at which errors fall, and
// the noise against a stored baseline. docs/regression.md.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "statistics/convergence.h"
#include "statistics/statistics.h"
#include "tools/regress_baseline.h"
#include "tools/regress_pictures.h"
#include "tools/regress_reference.h"

namespace etendue {

/// A mean that takes part in a sum that ought to be zero.
struct MeanTerm {
    double sign = 1.0;
    Summary summary;
    double step = 0.0;  // that one of its brightest samples brings to the mean
};

/// Welch's t of the sum, and guarded as guardedP (agreement_judge.h) is.
struct SumTest {
    double difference = 0.0;
    double halfWidth = 0.0;  // of its 99 % interval
    double p = 1.0;
    double guardedP = 1.0;
};
SumTest testSum(std::span<const MeanTerm> terms);

enum class BiasVerdict {
    unbiased,   // no test rejects, and the bias is known to be below its bound
    unbounded,  // no test rejects, and there is no bound to hold it against
    tooNoisy,   // no test rejects, but the bias is not known to be below its bound
    biased,     // a test rejects, or samples had to be left out
};

struct BiasJudgement {
    double smallestP = 1.0;  // over all regions, guarded; to be compared with `level`
    double level = 0.0;
    int testsInDoubt = 0;                        // that Welch's t alone would have rejected
    double relativeBias = 0.0, halfWidth = 0.0;  // of the whole picture; 99 %
    BiasVerdict verdict = BiasVerdict::unbounded;
};

/// Means of independent pictures of one kind.
struct RegionMeans {
    std::vector<std::vector<double>> means;  // [picture][region], see PictureRegions
    double largest = 0.0;                    // that a sample brought to a pixel, in any colour
    std::uint32_t samples = 1;               // per pixel of each picture
};
/// What an estimator has rendered, and what it is held against.
struct HeldAgainst {
    PictureRegions regions;
    RegionMeans tested, reference;
    std::uint64_t badSamples = 0;
};
HeldAgainst holdAgainst(const SeedPictures& rendered, std::uint32_t samples,
                        const ReferencePicture& reference, const PictureRegions& regions);

/// Against the reference. `tests`: how many of the run share the chance of 1 % of any false alarm.
BiasJudgement judgeBias(const HeldAgainst& tested, std::optional<double> bound, std::size_t tests);
/// Whether two estimators are equally far from their references: those cancel where they are one.
/// The relative bias is that of `a` over `b`.
BiasJudgement judgeBetween(const HeldAgainst& a, const HeldAgainst& b, std::size_t tests);

/// Errors of blocks of samples, each block by itself.
struct BlockErrors {
    std::vector<double> samples;                // per pixel of each block, doubling
    std::vector<std::vector<double>> errorsOf;  // [seed][step]: mean over the seed's blocks
};
/// Of pictures at checkpoints that are evenly spaced, a power of two of them: relMSE against the
/// reference less that picture's own. Every sample is in one block of each size, so that one bright
/// sample raises all errors of its seed alike, and leaves their slope as it is.
BlockErrors blockErrors(const SeedPictures& rendered, std::uint32_t samples,
                        const ReferencePicture& reference);

/// relMSE × samples, and its interval of 99 % over the seeds.
struct Noise {
    double value = 0.0;
    Interval interval;
};
/// From the largest blocks.
Noise noiseOf(const BlockErrors& errors);

/// As `slope.verdict` says, but that it fails only if no slope within 0.01 of −1 lies in its
/// interval, and that widened to the level at which chance makes a cell fail in 1 % of runs of so
/// many cells.
SlopeVerdict judgeRate(const ConvergenceSlope& slope, std::size_t cells, int seeds);

enum class NoiseVerdict { same, worse, better };
/// Whether two intervals can be those of one noise. `cells`: as `tests`; `seeds`: of each.
NoiseVerdict judgeNoise(const Noise& before, const Noise& now, std::size_t cells, int seeds);

/// A render of a cell is looked at so many times; its samples are a multiple of that.
inline constexpr std::uint32_t checkpointCount = 16;
/// Of `samples` per pixel, evenly spaced.
std::vector<std::uint32_t> checkpointsUpTo(std::uint32_t samples);

/// The smallest of 0.5, 1, 2, 5 … 50 % that leaves chance some room; none if noise hides more.
std::optional<double> boundFor(const BiasJudgement& bias);

}  // namespace etendue
