#include "tools/bench_summary.h"

#include <algorithm>
#include <cmath>

#include "statistics/convergence.h"
#include "statistics/statistics.h"

namespace etendue {

namespace {

constexpr double confidence = 0.95;
constexpr int resamples = 2000;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

using Runs = std::vector<const BenchRun*>;

/// A statistic of runs, and its interval when they are drawn again. The same draws for every
/// statistic of as many runs: figures that belong together move together.
template <class Statistic>
BenchFigure figureOf(std::size_t count, const Statistic& statistic) {
    std::vector<std::size_t> all(count);
    for (std::size_t i = 0; i < count; ++i) all[i] = i;
    return {statistic(std::span<const std::size_t>(all)),
            bootstrapInterval(count, statistic, smallSampleConfidence(confidence, count), resamples,
                              1)};
}

const BenchCheckpoint* checkpointAt(const BenchRun& run, std::uint32_t samples) {
    for (const BenchCheckpoint& c : run.checkpoints)
        if (c.samples == samples) return &c;
    return nullptr;
}

/// Counts that every run has a checkpoint at.
std::vector<std::uint32_t> commonCounts(const Runs& runs) {
    std::vector<std::uint32_t> counts;
    for (const BenchCheckpoint& c : runs.front()->checkpoints)
        if (std::all_of(runs.begin(), runs.end(),
                        [&](const BenchRun* run) { return checkpointAt(*run, c.samples); }))
            counts.push_back(c.samples);
    return counts;
}

template <class Value>
double medianOver(std::span<const std::size_t> chosen, const Value& value) {
    std::vector<double> values;
    for (const std::size_t i : chosen) values.push_back(value(i));
    return median(std::move(values));
}

template <class Value>
double meanOver(std::span<const std::size_t> chosen, const Value& value) {
    double sum = 0.0;
    for (const std::size_t i : chosen) sum += value(i);
    return sum / static_cast<double>(chosen.size());
}

/// Independent runs of one configuration.
class Configuration {
public:
    /// `referenceRelMse`: what the reference's noise adds to each error on the average.
    Configuration(Runs runs, double referenceRelMse)
        : runs_(std::move(runs)), referenceRelMse_(referenceRelMse) {}

    std::size_t size() const { return runs_.size(); }
    const BenchCheckpoint& last(std::size_t i) const { return runs_[i]->checkpoints.back(); }

    /// relMse · seconds at the end of the runs: the error of one sample, which a run that got
    /// little of the machine tells as well as another, times the time for one, whose median such a
    /// run does not touch.
    double cost(std::span<const std::size_t> chosen) const {
        const double errorOfOne = meanOver(chosen, [&](std::size_t i) {
            return (last(i).errors.relMse - referenceRelMse_) * last(i).samples;
        });
        return errorOfOne *
               medianOver(chosen, [&](std::size_t i) { return last(i).seconds / last(i).samples; });
    }

    BenchResult summarize(double targetRelMse) const {
        BenchResult result;
        result.configuration = runs_.front()->configuration;
        for (const std::uint32_t samples : commonCounts(runs_))
            result.curve.push_back(pointAt(samples));
        std::vector<double> samples, seconds;
        for (const BenchRun* run : runs_) {
            samples.push_back(run->checkpoints.back().samples);
            seconds.push_back(run->checkpoints.back().seconds);
            result.flip += run->flip / static_cast<double>(size());
            result.badSamples += run->badSamples;
        }
        result.samples = median(samples);
        result.seconds = median(seconds);
        result.relMse = figureOf(size(), [&](std::span<const std::size_t> chosen) {
            return cost(chosen) / result.seconds;
        });
        result.isBelowReference = !(result.relMse.value > 9.0 * referenceRelMse_);
        result.efficiency = figureOf(
            size(), [&](std::span<const std::size_t> chosen) { return 1.0 / cost(chosen); });
        addSlope(result);
        addTimeToTarget(result, targetRelMse);
        return result;
    }

private:
    BenchPoint pointAt(std::uint32_t samples) const {
        BenchPoint point;
        point.samples = samples;
        std::vector<double> seconds, meanErrors;
        ImageErrors& mean = point.errors;
        const double n = static_cast<double>(size());
        for (const BenchRun* run : runs_) {
            const BenchCheckpoint& c = *checkpointAt(*run, samples);
            seconds.push_back(c.seconds);
            meanErrors.push_back(c.errors.meanError);
            mean.mse += c.errors.mse / n;
            mean.relMse += c.errors.relMse / n;
            mean.relMseTrimmed += c.errors.relMseTrimmed / n;
            mean.mae += c.errors.mae / n;
            mean.meanError += c.errors.meanError / n;
        }
        point.seconds = median(seconds);
        point.relMse = figureOf(size(), [&](std::span<const std::size_t> chosen) {
            return meanOver(chosen,
                            [&](std::size_t i) {
                                return checkpointAt(*runs_[i], samples)->errors.relMse;
                            }) -
                   referenceRelMse_;
        });
        point.meanErrorHalfWidth =
            studentQuantile(confidence, n - 1.0) * etendue::summarize(meanErrors).standardError;
        return point;
    }

    void addSlope(BenchResult& result) const {
        std::vector<double> samples;
        std::vector<std::vector<double>> errors(size());
        for (const BenchPoint& point : result.curve) {
            samples.push_back(point.samples);
            for (std::size_t i = 0; i < size(); ++i)
                errors[i].push_back(checkpointAt(*runs_[i], point.samples)->errors.relMse -
                                    referenceRelMse_);
        }
        if (samples.size() < 3) return;
        const ConvergenceSlope slope = convergenceSlope(samples, errors, resamples, 1);
        if (std::isfinite(slope.slope)) result.slope = BenchFigure{slope.slope, slope.interval};
    }

    void addTimeToTarget(BenchResult& result, double target) const {
        const auto timeOf = [&](std::span<const std::size_t> chosen) {
            std::vector<double> seconds, errors;
            for (const BenchPoint& point : result.curve) {
                const auto at = [&](std::size_t i) -> const BenchCheckpoint& {
                    return *checkpointAt(*runs_[i], point.samples);
                };
                seconds.push_back(medianOver(chosen, [&](std::size_t i) { return at(i).seconds; }));
                errors.push_back(
                    meanOver(chosen, [&](std::size_t i) { return at(i).errors.relMse; }) -
                    referenceRelMse_);
            }
            if (std::any_of(errors.begin(), errors.end(), [](double e) { return !(e > 0.0); }))
                return TimeToError{std::numeric_limits<double>::quiet_NaN(), false};
            return timeToError(seconds, errors, target);
        };
        if (result.curve.empty()) return;
        const BenchFigure time = figureOf(
            size(), [&](std::span<const std::size_t> chosen) { return timeOf(chosen).seconds; });
        if (!std::isfinite(time.value)) return;
        std::vector<std::size_t> all(size());
        for (std::size_t i = 0; i < size(); ++i) all[i] = i;
        result.secondsToTarget = time;
        result.isExtrapolated = timeOf(all).isExtrapolated;
    }

    Runs runs_;
    double referenceRelMse_;
};

double referenceRelMseOf(const BenchRecords& records, const BenchConfiguration& configuration) {
    for (const BenchReference& r : records.references)
        if (r.scene == configuration.scene && r.camera == configuration.camera) return r.relMse;
    return 0.0;
}

bool isSameView(const BenchConfiguration& a, const BenchConfiguration& b) {
    return a.scene == b.scene && a.camera == b.camera;
}

/// Runs of each configuration, in the order of their first.
std::vector<Runs> configurationsOf(const BenchRecords& records) {
    std::vector<Runs> all;
    for (const BenchRun& run : records.runs) {
        const auto same = std::find_if(all.begin(), all.end(), [&](const Runs& runs) {
            return runs.front()->configuration == run.configuration;
        });
        if (same == all.end())
            all.push_back({&run});
        else
            same->push_back(&run);
    }
    std::erase_if(all, [](const Runs& runs) { return runs.size() < 2; });
    std::stable_sort(all.begin(), all.end(), [&](const Runs& a, const Runs& b) {
        const auto firstOf = [&](const Runs& runs) {
            return std::find_if(records.runs.begin(), records.runs.end(), [&](const BenchRun& run) {
                return isSameView(run.configuration, runs.front()->configuration);
            });
        };
        return firstOf(a) < firstOf(b);
    });
    return all;
}

/// What only the results of one view together tell.
void relate(std::vector<BenchResult>::iterator begin, std::vector<BenchResult>::iterator end,
            const std::vector<Configuration>& configurations) {
    const Configuration& first = configurations.front();
    for (auto result = begin; result != end; ++result) {
        const Configuration& own = configurations[static_cast<std::size_t>(result - begin)];
        // Runs of one seed are neighbours in time, but their samples have nothing in common.
        result->ratio =
            figureOf(std::min(own.size(), first.size()), [&](std::span<const std::size_t> chosen) {
                return first.cost(chosen) / own.cost(chosen);
            });
    }
    for (auto point = begin->curve.rbegin(); point != begin->curve.rend(); ++point) {
        const auto at = [&](const BenchResult& result) -> const BenchPoint* {
            for (const BenchPoint& p : result.curve)
                if (p.samples == point->samples) return &p;
            return nullptr;
        };
        if (!std::all_of(begin, end, at)) continue;
        for (auto result = begin; result != end; ++result) result->equalSamples = *at(*result);
        return;
    }
}

}  // namespace

double smallSampleConfidence(double wanted, std::size_t count) {
    const double n = static_cast<double>(count);
    const double t = studentQuantile(wanted, n - 1.0) * std::sqrt(n / (n - 1.0));
    constexpr double wholeRange = 1.0 - 1e-6;  // of the draws: few observations have no more
    return std::min(1.0 - normalTwoSidedP(t), wholeRange);
}

std::vector<BenchResult> summarizeBench(const BenchRecords& records, double targetRelMse) {
    std::vector<BenchResult> results;
    std::vector<Configuration> configurations;
    for (Runs& runs : configurationsOf(records)) {
        const double noise = referenceRelMseOf(records, runs.front()->configuration);
        configurations.emplace_back(std::move(runs), noise);
        results.push_back(configurations.back().summarize(targetRelMse));
    }
    for (auto begin = results.begin(); begin != results.end();) {
        const auto end = std::find_if(begin, results.end(), [&](const BenchResult& result) {
            return !isSameView(result.configuration, begin->configuration);
        });
        const auto at = configurations.begin() + (begin - results.begin());
        relate(begin, end, {at, at + (end - begin)});
        begin = end;
    }
    return results;
}

}  // namespace etendue
