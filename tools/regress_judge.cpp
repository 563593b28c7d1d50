#include "tools/regress_judge.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "statistics/image_error.h"
#include "tools/agreement_judge.h"

namespace etendue {

namespace {

constexpr double confidence = 0.99;

MeanTerm termOf(const RegionMeans& pictures, std::size_t region, int pixels, double sign) {
    std::vector<double> values;
    for (const std::vector<double>& means : pictures.means) values.push_back(means[region]);
    const double samples = static_cast<double>(pictures.samples * values.size()) * pixels;
    return {sign, summarize(values), pictures.largest / samples};
}

/// Tested less reference, times `sign`.
std::vector<MeanTerm> termsOf(const HeldAgainst& held, std::size_t region, double sign) {
    const int pixels = held.regions.pixels()[region];
    return {termOf(held.tested, region, pixels, sign),
            termOf(held.reference, region, pixels, -sign)};
}

BiasJudgement judge(const PictureRegions& regions, std::size_t tests, double mean,
                    const std::function<std::vector<MeanTerm>(std::size_t region)>& termsOfRegion) {
    BiasJudgement result;
    result.level = sidakLevel(1.0 - confidence, tests);
    const std::size_t count = regions.count();
    for (std::size_t region = 0; region < count; ++region) {
        const SumTest test = testSum(termsOfRegion(region));
        result.smallestP = std::min(result.smallestP, test.guardedP);
        if (test.p <= result.level && test.guardedP > result.level) ++result.testsInDoubt;
        if (region + 1 < count) continue;
        result.relativeBias = test.difference / mean;
        result.halfWidth = test.halfWidth / std::abs(mean);
    }
    if (result.smallestP <= result.level) result.verdict = BiasVerdict::biased;
    return result;
}

/// What the samples after `begin` up to `end` have brought, in units of the first checkpoint.
Picture blockOf(const Picture& before, std::size_t begin, const Picture& after, std::size_t end) {
    Picture result(after.size());
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] =
            static_cast<float>((static_cast<double>(end) * static_cast<double>(after[i]) -
                                static_cast<double>(begin) * static_cast<double>(before[i])) /
                               static_cast<double>(end - begin));
    return result;
}

/// Of log noise: intervals are even on that scale.
double spreadOf(const Noise& noise) {
    return std::log(noise.interval.high / noise.interval.low) /
           (2.0 * studentQuantile(confidence, 1e6));
}

}  // namespace

SumTest testSum(std::span<const MeanTerm> terms) {
    SumTest result;
    double variance = 0.0, quartic = 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (const MeanTerm& term : terms) {
        const double v = term.summary.standardError * term.summary.standardError;
        const double freedom = static_cast<double>(term.summary.count) - 1.0;
        result.difference += term.sign * term.summary.mean;
        variance += v;
        quartic += v * v / freedom;
        least = std::min(least, freedom);
    }
    const double size = std::abs(result.difference);
    if (!(variance > 0.0)) {
        result.p = result.guardedP = size == 0.0 ? 1.0 : 0.0;
        return result;
    }
    const double freedom = std::max(least, variance * variance / quartic);  // Welch–Satterthwaite
    result.halfWidth = studentQuantile(confidence, freedom) * std::sqrt(variance);
    result.p = studentTwoSidedP(size / std::sqrt(variance), freedom);
    // What one of the means on the darker side may have missed.
    double step = 0.0;
    for (const MeanTerm& term : terms)
        if (term.sign * result.difference < 0.0) step = std::max(step, term.step);
    result.guardedP =
        guardedP(WelchResult{result.difference, std::sqrt(variance), freedom, result.p}, step);
    return result;
}

HeldAgainst holdAgainst(const SeedPictures& rendered, std::uint32_t samples,
                        const ReferencePicture& reference, const PictureRegions& regions) {
    HeldAgainst result{regions,
                       {{}, rendered.largest, samples},
                       {reference.means, reference.largest, reference.samples},
                       rendered.badSamples};
    for (const Picture& picture : rendered.pictures.back())
        result.tested.means.push_back(regions.meansOf(picture));
    return result;
}

BiasJudgement judgeBias(const HeldAgainst& tested, std::optional<double> bound, std::size_t tests) {
    const double mean = termsOf(tested, tested.regions.count() - 1, 1.0)[1].summary.mean;
    BiasJudgement result = judge(tested.regions, tests, mean,
                                 [&](std::size_t region) { return termsOf(tested, region, 1.0); });
    if (tested.badSamples > 0) result.verdict = BiasVerdict::biased;
    if (result.verdict != BiasVerdict::biased && bound)
        result.verdict = std::abs(result.relativeBias) + result.halfWidth < *bound
                             ? BiasVerdict::unbiased
                             : BiasVerdict::tooNoisy;
    return result;
}

BiasJudgement judgeBetween(const HeldAgainst& a, const HeldAgainst& b, std::size_t tests) {
    const bool isOneReference = a.reference.means == b.reference.means;
    const double mean = termsOf(b, b.regions.count() - 1, 1.0)[0].summary.mean;
    return judge(a.regions, tests, mean, [&](std::size_t region) {
        std::vector<MeanTerm> terms = termsOf(a, region, 1.0);
        const std::vector<MeanTerm> others = termsOf(b, region, -1.0);
        if (isOneReference) return std::vector{terms[0], others[0]};
        terms.insert(terms.end(), others.begin(), others.end());
        return terms;
    });
}

BlockErrors blockErrors(const SeedPictures& rendered, std::uint32_t samples,
                        const ReferencePicture& reference) {
    const std::size_t parts = rendered.pictures.size();
    const Picture none(reference.pixels.size());
    BlockErrors result;
    result.errorsOf.resize(rendered.pictures.front().size());
    for (std::size_t size = 1; size <= parts; size *= 2) {
        result.samples.push_back(static_cast<double>(samples * size) / static_cast<double>(parts));
        for (std::size_t seed = 0; seed < result.errorsOf.size(); ++seed) {
            const auto upTo = [&](std::size_t part) -> const Picture& {
                return part == 0 ? none : rendered.pictures[part - 1][seed];
            };
            double sum = 0.0;
            for (std::size_t end = size; end <= parts; end += size)
                sum += imageErrors(blockOf(upTo(end - size), end - size, upTo(end), end),
                                   reference.pixels)
                           .relMse -
                       reference.noise;
            result.errorsOf[seed].push_back(sum * static_cast<double>(size) /
                                            static_cast<double>(parts));
        }
    }
    return result;
}

Noise noiseOf(const BlockErrors& errors) {
    const auto meanOf = [&](std::span<const std::size_t> seeds) {
        double sum = 0.0;
        for (const std::size_t seed : seeds) sum += errors.errorsOf[seed].back();
        return errors.samples.back() * sum / static_cast<double>(seeds.size());
    };
    std::vector<std::size_t> all(errors.errorsOf.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return {meanOf(all), bootstrapInterval(all.size(), meanOf, confidence, 10'000, 0)};
}

SlopeVerdict judgeRate(const ConvergenceSlope& slope, std::size_t cells, int seeds) {
    if (slope.verdict != SlopeVerdict::fail) return slope.verdict;
    // Where nearly all of the error is a few samples' the interval is narrower than what it does
    // not show: how far their mean is from the reference. 0.01 is 3 % of the error at 16 samples.
    constexpr double tolerance = 0.01;
    const double freedom = seeds - 1.0;
    const double wider = studentQuantile(1.0 - sidakLevel(1.0 - confidence, cells), freedom) /
                         studentQuantile(confidence, freedom);
    const Interval reach{slope.slope - wider * (slope.slope - slope.interval.low),
                         slope.slope + wider * (slope.interval.high - slope.slope)};
    return reach.low <= -1.0 + tolerance && reach.high >= -1.0 - tolerance ? SlopeVerdict::pass
                                                                           : SlopeVerdict::fail;
}

NoiseVerdict judgeNoise(const Noise& before, const Noise& now, std::size_t cells, int seeds) {
    // Without noise there is no logarithm.
    if (!(now.interval.low > 0.0) || !(before.interval.low > 0.0))
        return now.value > before.interval.high ? NoiseVerdict::worse : NoiseVerdict::same;
    const double level = sidakLevel(1.0 - confidence, cells);
    const double reach =
        studentQuantile(1.0 - level, seeds - 1.0) * std::hypot(spreadOf(before), spreadOf(now));
    const double change = std::log(now.value / before.value);
    if (std::abs(change) <= reach) return NoiseVerdict::same;
    return change > 0.0 ? NoiseVerdict::worse : NoiseVerdict::better;
}

std::vector<std::uint32_t> checkpointsUpTo(std::uint32_t samples) {
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 1; i <= checkpointCount; ++i)
        result.push_back(i * (samples / checkpointCount));
    return result;
}

std::optional<double> boundFor(const BiasJudgement& bias) {
    constexpr double room = 1.5;  // of the half width beside the interval
    for (const double bound : {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5})
        if ((1.0 + room) * bias.halfWidth < bound &&
            std::abs(bias.relativeBias) + bias.halfWidth < bound)
            return bound;
    return {};
}

}  // namespace etendue
