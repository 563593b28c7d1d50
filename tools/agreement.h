// Agreement: whether two estimators make one picture, by statistics that noise cannot fake.
// docs/agreement.md has the method.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/render.h"
#include "renderer/scene_loader.h"
#include "tools/agreement_judge.h"
#include "tools/path_classes.h"

namespace etendue {

struct AgreementSettings {
    int seeds = 16;              // pictures of each estimator
    std::optional<int> samples;  // per pixel of each picture; else as many as time allows
    double seconds = 20.0;       // for one comparison, about
    bool reckonsTime = false;    // by a table and not by the clock: always the same samples
    std::optional<Sampler> sampler = Sampler::sobol;  // none: the scene's
    bool keepsByChance = false;   // compares what path tracing meets only by chance, too
    double bound = 0.002;         // of the relative bias
    int tileSize = 16;            // pixels
    std::size_t comparisons = 1;  // that share the chance of 1 % of any false alarm
    std::uint64_t firstSeed = 0;  // of as many as agreementSeeds() says
    int threads = 1;
};

/// How many seeds in a row a comparison takes.
std::uint64_t agreementSeeds(const AgreementSettings& settings);

enum class Verdict {
    agree,          // no test rejects, and the bias is below the bound with 99 % confidence
    differ,         // a test rejects, or samples had to be left out
    tooNoisy,       // no test rejects, but the interval reaches beyond the bound, or a tile's
                    // samples are too few to test it
    nothingCommon,  // both pictures are black
};
std::string nameOf(Verdict verdict);

/// Samples that were not finite, or negative.
struct BadSamples {
    std::uint64_t count = 0, refusedRays = 0;
    std::uint64_t seed = 0;  // of the first
    BadSample first;
};

/// One of the two estimators.
struct AgreementSide {
    std::string estimator;
    std::uint32_t samples = 0;  // per pixel of each picture
    LeftOutMeans leftOut{};     // shares of all that this estimator sees
    BadSamples bad;
};

struct Agreement {
    AgreementSide tested, reference;
    PictureComparison comparison;
    std::size_t testsInDoubt = 0;  // see Judgement
    Verdict verdict = Verdict::nothingCommon;
    double seconds = 0.0;
};

/// An estimator to compare; `make` is called once for each picture.
struct Contestant {
    std::string name;
    std::function<std::unique_ptr<CommonPaths>()> make;
    double reckonedSeconds = 1e-6;  // for a sample of a pixel
};

/// Renders the scene by both and compares. `goOn`: hears from any thread, one at a time, the
/// seconds that it took so far, and returns false to give up; then the result is empty.
std::optional<Agreement> comparePicturesOf(const LoadedScene& loaded, const Contestant& tested,
                                           const Contestant& reference,
                                           const AgreementSettings& settings,
                                           const std::function<bool(double)>& goOn);

/// The same for two estimators, on the paths that both make.
std::optional<Agreement> compareEstimators(const LoadedScene& loaded, const Contender& tested,
                                           const Contender& reference,
                                           const AgreementSettings& settings,
                                           const std::function<bool(double)>& goOn);

/// What pictures of an estimator cost, as a first few have shown.
struct PictureCost {
    std::uint32_t samples = 1;      // per pixel, of those first
    double variance = 0.0;          // of one picture's mean, times its samples per pixel
    double secondsPerSample = 1.0;  // per pixel, of all pictures together; positive
};

/// Samples per pixel of the pictures on both sides with which the difference of the means of
/// `seeds` pictures each has an interval (99 %) of ± `halfWidth`, at the least cost; or as many as
/// `seconds` allow, if those are fewer. Not fewer than the first pictures had.
struct SamplePlan {
    std::uint32_t tested = 1, reference = 1;
};
SamplePlan planSamples(PictureCost tested, PictureCost reference, int seeds, double halfWidth,
                       double seconds);

/// About how long the same comparison would take to tell whether the means agree within `bound`,
/// from the interval that it has now: its square is in proportion to one over the time.
double secondsToTell(const Agreement& agreement, double bound);

Verdict verdictOf(const Judgement& judgement, double bound, bool isBlack, bool hasBadSamples);

}  // namespace etendue
