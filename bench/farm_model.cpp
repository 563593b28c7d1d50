#include "bench/farm_model.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tools/part_keeper.h"

namespace etendue {
namespace {

/// Nothing is known of writing yet.
double firstCheckpointSeconds() { return defaultCheckpointInterval(0.0); }

}  // namespace

FarmRun FarmModel::render(const DealtOut& plan, const FarmEffects& effects) const {
    const int draws = effects.spread ? 32 : 1;
    FarmRun mean;
    for (int draw = 0; draw < draws; ++draw) {
        // In pairs, slow for fast: so that few draws of long tasks do not miss the mean.
        std::mt19937_64 random(seed_ + static_cast<std::uint64_t>(draw / 2));
        std::normal_distribution<double> normal;
        const double scale =
            effects.spread ? (draw % 2 == 0 ? costs_.spread : -costs_.spread) : 0.0;
        std::vector<FarmJob> jobs;
        jobs.reserve(plan.tasks);
        for (std::uint32_t i = 0; i < plan.tasks; ++i)
            jobs.push_back(
                task(plan, taskSeconds(plan) * std::exp(scale * normal(random)), effects));
        const FarmRun run = simulateFarm(jobs, plan.nodes, bandwidth_);
        mean.wallSeconds += run.wallSeconds / draws;
        mean.nodeSeconds += run.nodeSeconds / draws;
    }
    return mean;
}

FarmRun FarmModel::merge(const DealtOut& plan) const {
    std::vector<FarmJob> jobs;
    for (std::uint32_t g = 0; g < plan.groups && plan.groups > 1; ++g)
        jobs.push_back(mergeJob((plan.tasks + g) / plan.groups, true));
    const FarmRun groups = simulateFarm(jobs, plan.nodes, bandwidth_);
    const std::uint32_t parts = plan.groups > 1 ? plan.groups : plan.tasks;
    const FarmRun last = simulateFarm({mergeJob(parts, false)}, 1, bandwidth_);
    return {groups.wallSeconds + last.wallSeconds, groups.nodeSeconds + last.nodeSeconds};
}

double FarmModel::formulaSeconds(const DealtOut& plan) const {
    const double rounds = std::ceil(1.0 * plan.tasks / plan.nodes);
    const double task = costs_.startSeconds + taskSeconds(plan) +
                        (1 + checkpointsIn(plan, taskSeconds(plan))) * writeSeconds(plan);
    // Transfers of parts that are merged side by side add up, the rest does not.
    double merge = costs_.mergeSeconds + plan.tasks * transferSeconds();
    if (plan.groups == 1)
        merge += plan.tasks * costs_.mergeSecondsPerPart;
    else
        merge += costs_.mergeSeconds + costs_.encodeSeconds +
                 2.0 * plan.groups * transferSeconds() +
                 (1.0 * plan.tasks / plan.groups + plan.groups) * costs_.mergeSecondsPerPart;
    return rounds * task + merge;
}

double FarmModel::bytesOfParts(const DealtOut& plan) const {
    // The part before the last one stays beside it.
    return costs_.partBytes * plan.tasks * (checkpointsIn(plan, taskSeconds(plan)) > 0 ? 2.0 : 1.0);
}

double FarmModel::nodesAtBend() const {
    return std::sqrt(costs_.sampleSeconds * samples_ /
                     (costs_.mergeSecondsPerPart + 2.0 * transferSeconds()));
}

double FarmModel::nodesAtBendOfMerge() const {
    return std::sqrt(costs_.sampleSeconds * samples_ / costs_.mergeSecondsPerPart);
}

double FarmModel::taskSeconds(const DealtOut& plan) const {
    return costs_.sampleSeconds * samples_ / plan.tasks;
}

double FarmModel::writeSeconds(const DealtOut& plan) const {
    return costs_.encodeSeconds + std::min<double>(plan.tasks, plan.nodes) * transferSeconds();
}

double FarmModel::checkpointIntervalSeconds(const DealtOut& plan) const {
    return defaultCheckpointInterval(writeSeconds(plan));
}

int FarmModel::checkpointsIn(const DealtOut& plan, double seconds) const {
    const double afterFirst = seconds - firstCheckpointSeconds();
    return std::max(0, static_cast<int>(std::ceil(afterFirst / checkpointIntervalSeconds(plan))));
}

FarmJob FarmModel::task(const DealtOut& plan, double seconds, const FarmEffects& effects) const {
    double before = effects.start ? costs_.startSeconds : 0.0;
    if (!effects.writing) return {{before + seconds, 0.0}};
    FarmJob job;
    double left = seconds;
    const int checkpoints = checkpointsIn(plan, seconds);
    for (int i = 0; i < checkpoints; ++i) {
        const double until = i == 0 ? firstCheckpointSeconds() : checkpointIntervalSeconds(plan);
        job.push_back({before + until + costs_.encodeSeconds, costs_.partBytes});
        left -= until;
        before = 0.0;
    }
    job.push_back({before + left + costs_.encodeSeconds, costs_.partBytes});
    return job;
}

/// It reads a part, adds it, and so on.
FarmJob FarmModel::mergeJob(std::uint32_t parts, bool writesPart) const {
    FarmJob job{{costs_.mergeSeconds, costs_.partBytes}};
    for (std::uint32_t i = 1; i < parts; ++i)
        job.push_back({costs_.mergeSecondsPerPart, costs_.partBytes});
    job.push_back({costs_.mergeSecondsPerPart + (writesPart ? costs_.encodeSeconds : 0.0),
                   writesPart ? costs_.partBytes : 0.0});
    return job;
}

}  // namespace etendue
