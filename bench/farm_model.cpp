#include "bench/farm_model.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tools/part_keeper.h"

namespace etendue {

FarmRun FarmModel::render(const DealtOut& plan, const FarmEffects& effects) const {
    const int draws = effects.spread ? 32 : 1;
    FarmRun mean;
    for (int draw = 0; draw < draws; ++draw) {
        // In pairs, slow for fast: so that few draws of long tasks do not miss the mean.
        std::mt19937_64 random(seed_ + static_cast<std::uint64_t>(draw / 2));
        std::normal_distribution<double> normal;
        const double scale = effects.spread ? (draw % 2 == 0 ? c_.spread : -c_.spread) : 0.0;
        std::vector<FarmJob> jobs;
        jobs.reserve(plan.tasks);
        for (std::uint32_t i = 0; i < plan.tasks; ++i)
            jobs.push_back(task(taskSeconds(plan) * std::exp(scale * normal(random)), effects));
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
    const double writers = std::min<double>(plan.tasks, plan.nodes);
    const double write = c_.encodeSeconds + writers * transferSeconds();
    const double task =
        c_.startSeconds + taskSeconds(plan) + (1 + checkpointsIn(taskSeconds(plan))) * write;
    // Transfers of parts that are merged side by side add up, the rest does not.
    double merge = c_.mergeSeconds + plan.tasks * transferSeconds();
    if (plan.groups == 1)
        merge += plan.tasks * c_.mergeSecondsPerPart;
    else
        merge += c_.mergeSeconds + c_.encodeSeconds + 2.0 * plan.groups * transferSeconds() +
                 (1.0 * plan.tasks / plan.groups + plan.groups) * c_.mergeSecondsPerPart;
    return rounds * task + merge;
}

double FarmModel::bytesOfParts(const DealtOut& plan) const {
    // The part before the last one stays beside it.
    return c_.partBytes * plan.tasks * (checkpointsIn(taskSeconds(plan)) > 0 ? 2.0 : 1.0);
}

double FarmModel::nodesAtBend() const {
    return std::sqrt(c_.sampleSeconds * samples_ /
                     (c_.mergeSecondsPerPart + 2.0 * transferSeconds()));
}

double FarmModel::nodesAtBendOfMerge() const {
    return std::sqrt(c_.sampleSeconds * samples_ / c_.mergeSecondsPerPart);
}

double FarmModel::taskSeconds(const DealtOut& plan) const {
    return c_.sampleSeconds * samples_ / plan.tasks;
}

double FarmModel::interval() const {
    return defaultCheckpointInterval(c_.encodeSeconds + transferSeconds());
}

int FarmModel::checkpointsIn(double seconds) const {
    return static_cast<int>(std::ceil(seconds / interval())) - 1;
}

FarmJob FarmModel::task(double seconds, const FarmEffects& effects) const {
    double before = effects.start ? c_.startSeconds : 0.0;
    if (!effects.writing) return {{before + seconds, 0.0}};
    FarmJob job;
    const int checkpoints = checkpointsIn(seconds);
    for (int i = 0; i < checkpoints; ++i) {
        job.push_back({before + interval() + c_.encodeSeconds, c_.partBytes});
        before = 0.0;
    }
    job.push_back({before + seconds - checkpoints * interval() + c_.encodeSeconds, c_.partBytes});
    return job;
}

/// It reads a part, adds it, and so on.
FarmJob FarmModel::mergeJob(std::uint32_t parts, bool writesPart) const {
    FarmJob job{{c_.mergeSeconds, c_.partBytes}};
    for (std::uint32_t i = 1; i < parts; ++i) job.push_back({c_.mergeSecondsPerPart, c_.partBytes});
    job.push_back({c_.mergeSecondsPerPart + (writesPart ? c_.encodeSeconds : 0.0),
                   writesPart ? c_.partBytes : 0.0});
    return job;
}

}  // namespace etendue
