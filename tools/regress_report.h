// The figures and verdicts of regression tests, as text and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/config.h"
#include "tools/json.h"
#include "tools/regress_judge.h"

namespace etendue {

struct CellResult {
    RegressCell cell;
    std::uint32_t samples = 0;
    BiasJudgement bias;
    std::optional<double> biasBound;
    ConvergenceSlope slope;
    SlopeVerdict rate = SlopeVerdict::inconclusive;  // see judgeRate
    bool judgesRate = true;
    Noise noise;
    std::optional<Noise> noiseBefore;  // none: the cell is not in the baseline
    NoiseVerdict noiseVerdict = NoiseVerdict::same;
    LeftOutMeans leftOut{};
    std::uint64_t badSamples = 0;
    bool isReferenceStale = false;  // the scene's files are not those it was made of
    double seconds = 0.0;

    bool isRateBad() const { return judgesRate && rate != SlopeVerdict::pass; }
    bool isBiasBad() const {
        return bias.verdict == BiasVerdict::biased || bias.verdict == BiasVerdict::tooNoisy;
    }
    bool isSound() const { return !isBiasBad() && !isRateBad(); }
    bool passes() const { return isSound() && noiseBefore && noiseVerdict == NoiseVerdict::same; }
};

/// Two estimators of one scene and camera, of which the first is held against the second.
struct PairResult {
    RegressCell cell;  // of the first
    std::string other;
    BiasJudgement bias;
};

/// A scene through a camera that could not be tested.
struct RegressFailure {
    std::string what, why;
    ExitCode code = ExitCode::badInput;
};

struct RegressResults {
    std::vector<CellResult> cells;
    std::vector<PairResult> pairs;
    std::vector<RegressFailure> failures;
    bool isComplete = true;  // false: a signal ended the run
};

/// What is wrong with it: "rate, noise"; "pass" if nothing is.
std::string outcomeOf(const CellResult& cell);

/// The table, what failed and why, and what was not judged.
std::string regressText(const RegressResults& results);
Json regressJson(const RegressResults& results);

/// Old and new noise of each cell that was measured, and what its row in `after` asks of it.
std::string rebaselineText(const std::vector<CellResult>& cells, const Baseline& after);

}  // namespace etendue
