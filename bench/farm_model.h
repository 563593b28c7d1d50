// How long a picture takes a farm, by what its work costs: computed and simulated.
#pragma once

#include <cstdint>

#include "bench/farm_costs.h"
#include "bench/farm_simulation.h"

namespace etendue {

/// How a picture is dealt out.
struct DealtOut {
    std::uint32_t tasks = 1;
    int nodes = 1;
    std::uint32_t groups = 1;  // merged to parts first, side by side
};

/// What a simulation takes into account.
struct FarmEffects {
    bool start = true, spread = true, writing = true;
};

class FarmModel {
public:
    /// `samples`: of the picture. `seed`: of the tasks' durations.
    FarmModel(const FarmCosts& costs, std::uint32_t samples, double bytesPerSecond,
              std::uint64_t seed)
        : costs_(costs), samples_(samples), bandwidth_(bytesPerSecond), seed_(seed) {}

    /// Until the last task is done: the mean over draws of all durations.
    FarmRun render(const DealtOut& plan, const FarmEffects& effects) const;
    FarmRun merge(const DealtOut& plan) const;
    /// Both, without spread, and as if all tasks wrote at the same time.
    double formulaSeconds(const DealtOut& plan) const;

    double bytesOfParts(const DealtOut& plan) const;
    double samplesOfTask(const DealtOut& plan) const { return 1.0 * samples_ / plan.tasks; }
    /// So many nodes render as long as the parts of all are written and merged; and as long as they
    /// would be merged if the file system took no time.
    double nodesAtBend() const;
    double nodesAtBendOfMerge() const;

private:
    double taskSeconds(const DealtOut& plan) const;
    double transferSeconds() const { return costs_.partBytes / bandwidth_; }
    /// A part, while all nodes write one.
    double writeSeconds(const DealtOut& plan) const;
    /// From one checkpoint to the next, as if every time all nodes wrote theirs together.
    double checkpointIntervalSeconds(const DealtOut& plan) const;
    /// On the way of a task that renders so long.
    int checkpointsIn(const DealtOut& plan, double seconds) const;
    FarmJob task(const DealtOut& plan, double seconds, const FarmEffects& effects) const;
    FarmJob mergeJob(std::uint32_t parts, bool writesPart) const;

    FarmCosts costs_;
    std::uint32_t samples_;
    double bandwidth_;
    std::uint64_t seed_;
};

}  // namespace etendue
