#include "tools/agreement.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>

#include "renderer/parallel.h"
#include "statistics/statistics.h"
#include "tools/watched_estimator.h"

namespace etendue {

namespace {

/// Of the time for a comparison, for the pictures that tell how many samples it takes.
constexpr double pilotShare = 0.15;
constexpr std::uint32_t mostPilotSamples = 1u << 16;
constexpr double mostSamples = 1 << 24;
/// Half an interval's width: below half the bound, so that chance leaves room for it beside the
/// bias.
constexpr double intervalPerBound = 0.45;

/// For a sample of a pixel on one core, about: `AgreementSettings::reckonsTime`. Through a lens of
/// glass it is two to five times as much.
double reckonedSeconds(const Contender& contender) {
    if (contender.kind == "bdpt" && !contender.technique) return 8e-6;
    return 2e-6;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Pictures of one estimator, each with a seed of its own.
struct Pictures {
    std::vector<Picture> pixels;
    std::vector<LeftOutMeans> leftOut;
    BadSamples bad;
    double largest = 0.0;  // see SampleSizes
    double seconds = 0.0;
};

class Comparison {
public:
    Comparison(const LoadedScene& loaded, const AgreementSettings& settings,
               const std::function<bool(double)>& goOn)
        : loaded_(loaded),
          settings_(settings),
          goOn_(goOn),
          nextSeed_(settings.firstSeed),
          filter_(loaded.film.filter, loaded.film.filterRadius) {}

    std::optional<Agreement> compare(const Contestant& tested, const Contestant& reference) {
        std::optional<SamplePlan> plan;
        if (settings_.samples) {
            const auto samples = static_cast<std::uint32_t>(*settings_.samples);
            plan = SamplePlan{samples, samples};
        } else {
            plan = planFor(tested, reference);
        }
        if (!plan) return {};
        const auto a = render(tested, plan->tested);
        const auto b = a ? render(reference, plan->reference) : std::nullopt;
        if (!b) return {};
        const auto sizes = [&](const Pictures& pictures, std::uint32_t samples) {
            return SampleSizes{static_cast<double>(samples) * settings_.seeds, pictures.largest};
        };
        const Judgement judgement =
            judgePictures(a->pixels, b->pixels, sizes(*a, plan->tested), sizes(*b, plan->reference),
                          loaded_.film.width, settings_.tileSize, settings_.comparisons);
        Agreement result{sideOf(tested.name, plan->tested, *a),
                         sideOf(reference.name, plan->reference, *b), judgement.comparison,
                         judgement.testsInDoubt};
        const bool isBlack =
            summarize(meansOf(a->pixels)).mean == 0.0 && summarize(meansOf(b->pixels)).mean == 0.0;
        result.verdict = verdictOf(judgement, settings_.bound, isBlack,
                                   result.tested.bad.count + result.reference.bad.count > 0);
        result.seconds = secondsSince(start_);
        return result;
    }

private:
    /// The samples are planned by pictures that are thrown away: stopping by the noise of the very
    /// pictures that are compared would favour those that have missed their brightest paths.
    std::optional<SamplePlan> planFor(const Contestant& tested, const Contestant& reference) {
        double mean = 0.0;
        const auto a = costOf(tested, mean);
        const auto b = a ? costOf(reference, mean) : std::nullopt;
        if (!b) return {};
        const double halfWidth = intervalPerBound * settings_.bound * mean;
        const double left = settings_.reckonsTime ? (1.0 - pilotShare) * settings_.seconds
                                                  : settings_.seconds - secondsSince(start_);
        return planSamples(*a, *b, settings_.seeds, halfWidth, left);
    }

    /// By as many samples as fit in half the time for pilots.
    std::optional<PictureCost> costOf(const Contestant& contestant, double& mean) {
        const auto begin = std::chrono::steady_clock::now();
        double reckoned = 0.0;
        for (std::uint32_t samples = 1;; samples *= 2) {
            const std::uint64_t seed = nextSeed_;
            const auto pictures = render(contestant, samples);
            if (!pictures) return {};
            const Summary summary = summarize(meansOf(pictures->pixels));
            mean = std::max(mean, summary.mean);
            const double took =
                settings_.reckonsTime ? reckonedSeconds(contestant) * samples : pictures->seconds;
            reckoned += took;
            // The next one would take twice as long.
            const double spent =
                (settings_.reckonsTime ? reckoned : secondsSince(begin)) + 2.0 * took;
            if (spent > 0.5 * pilotShare * settings_.seconds || samples >= mostPilotSamples)
                return PictureCost{samples, summary.variance * samples,
                                   std::max(took, 1e-9) / samples};
            nextSeed_ = seed;  // Those before are forgotten.
        }
    }

    /// For a sample of each pixel of all pictures.
    double reckonedSeconds(const Contestant& contestant) const {
        return contestant.reckonedSeconds * settings_.seeds * loaded_.film.width *
               loaded_.film.height;
    }

    std::optional<Pictures> render(const Contestant& contestant, std::uint32_t samples) {
        const auto begin = std::chrono::steady_clock::now();
        const auto count = static_cast<std::size_t>(settings_.seeds);
        Pictures result;
        result.pixels.resize(count);
        result.leftOut.resize(count);
        std::vector<double> largest(count);
        std::vector<RenderResult> renders(count);
        std::atomic<bool> isOver{false};
        const std::uint64_t refusedBefore = loaded_.scene->refusedRays();
        parallelFor(count, settings_.threads, [&](std::size_t i) {
            if (!isOver)
                renders[i] = renderOne(contestant, samples, nextSeed_ + i, i, result, largest[i]);
            if (renders[i].wasInterrupted) isOver = true;
        });
        if (isOver) return {};
        result.largest = *std::max_element(largest.begin(), largest.end());
        for (std::size_t i = 0; i < count; ++i) {
            if (renders[i].badSampleCount == 0) continue;
            if (result.bad.count == 0) {
                result.bad.seed = nextSeed_ + i;
                result.bad.first = renders[i].badSamples.front();
            }
            result.bad.count += renders[i].badSampleCount;
        }
        result.bad.refusedRays = loaded_.scene->refusedRays() - refusedBefore;
        nextSeed_ += count;
        result.seconds = secondsSince(begin);
        return result;
    }

    RenderResult renderOne(const Contestant& contestant, std::uint32_t samples, std::uint64_t seed,
                           std::size_t i, Pictures& pictures, double& largest) {
        const FilmSettings& frame = loaded_.film;
        Film film(frame.fullFrame(), {}, frame.color);
        const std::unique_ptr<CommonPaths> estimator = contestant.make();
        RenderSettings settings;
        settings.samples = samples;
        settings.seed = seed;
        settings.sampler = settings_.sampler.value_or(loaded_.sampler);
        const WatchedEstimator watched(*estimator, loaded_);
        const RenderResult result =
            etendue::render(*loaded_.scene, *loaded_.camera, watched, filter_, film, settings,
                            [&](const RenderProgress&) {
                                const std::lock_guard lock(progress_);
                                return !goOn_ || goOn_(secondsSince(start_));
                            });
        largest = watched.largest();
        pictures.pixels[i] = film.channels().front().pixels;
        pictures.leftOut[i] =
            estimator->leftOut(samples, pictures.pixels[i].size() / 3, frame.color);
        return result;
    }

    static AgreementSide sideOf(const std::string& name, std::uint32_t samples,
                                const Pictures& pictures) {
        AgreementSide side{name, samples, {}, pictures.bad};
        double all = 0.0;
        for (const double mean : meansOf(pictures.pixels)) all += mean;
        for (const LeftOutMeans& means : pictures.leftOut)
            for (std::size_t c = 0; c < pathClassCount; ++c) {
                side.leftOut[c] += means[c];
                all += means[c];
            }
        for (double& share : side.leftOut) share = all > 0.0 ? share / all : 0.0;
        return side;
    }

    const LoadedScene& loaded_;
    const AgreementSettings& settings_;
    const std::function<bool(double)>& goOn_;
    std::uint64_t nextSeed_;
    Filter filter_;
    std::mutex progress_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

std::uint64_t agreementSeeds(const AgreementSettings& settings) {
    return 4 * static_cast<std::uint64_t>(settings.seeds);  // two sides, their pilots and pictures
}

std::string nameOf(Verdict verdict) {
    switch (verdict) {
        case Verdict::agree:
            return "agree";
        case Verdict::differ:
            return "DIFFER";
        case Verdict::tooNoisy:
            return "too noisy to tell";
        case Verdict::nothingCommon:
            break;
    }
    return "nothing in common";
}

std::optional<Agreement> comparePicturesOf(const LoadedScene& loaded, const Contestant& tested,
                                           const Contestant& reference,
                                           const AgreementSettings& settings,
                                           const std::function<bool(double)>& goOn) {
    return Comparison(loaded, settings, goOn).compare(tested, reference);
}

std::optional<Agreement> compareEstimators(const LoadedScene& loaded, const Contender& tested,
                                           const Contender& reference,
                                           const AgreementSettings& settings,
                                           const std::function<bool(double)>& goOn) {
    const auto contestant = [&](const Contender& self, const Contender& other) {
        const CommonPathsSettings paths{loaded.estimator, self, other, settings.keepsByChance};
        return Contestant{
            nameOf(self),
            [&loaded, paths] { return makeCommonPaths(*loaded.scene, *loaded.camera, paths); },
            reckonedSeconds(self)};
    };
    return comparePicturesOf(loaded, contestant(tested, reference), contestant(reference, tested),
                             settings, goOn);
}

SamplePlan planSamples(PictureCost tested, PictureCost reference, int seeds, double halfWidth,
                       double seconds) {
    // At cost c n and variance v / n a side, the variance of the difference is least for its cost
    // where n is in proportion to √(v / c). A side without spread is as good with few samples.
    const auto effort = [](PictureCost cost) {
        return std::sqrt(cost.variance * cost.secondsPerSample);
    };
    const double all = effort(tested) + effort(reference);
    if (!(all > 0.0)) return {tested.samples, reference.samples};
    const double t = studentQuantile(0.99, std::max(1, seeds - 1));
    const double enough = all * t * t / (seeds * halfWidth * halfWidth);
    const double scale = std::min(std::max(seconds, 0.0) / all, enough);
    const auto samples = [&](PictureCost cost) {
        const double n = scale * std::sqrt(cost.variance / cost.secondsPerSample);
        return std::max(cost.samples, static_cast<std::uint32_t>(std::min(n, mostSamples)));
    };
    return {samples(tested), samples(reference)};
}

double secondsToTell(const Agreement& agreement, double bound) {
    const double ratio = agreement.comparison.relativeBiasHalfWidth / (intervalPerBound * bound);
    return agreement.seconds * ratio * ratio;
}

Verdict verdictOf(const Judgement& judgement, double bound, bool isBlack, bool hasBadSamples) {
    if (hasBadSamples || !judgement.comparison.agree()) return Verdict::differ;
    if (isBlack) return Verdict::nothingCommon;
    return judgement.comparison.isEquivalent(bound) && judgement.testsInDoubt == 0
               ? Verdict::agree
               : Verdict::tooNoisy;
}

}  // namespace etendue
