// Which samples are whose, when many machines render one picture.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/sample_ranges.h"

namespace etendue {

/// So many samples of every pixel in tasks of so many; the last task may have fewer.
struct FarmPlan {
    std::uint32_t samples = 0, taskSamples = 1;

    std::uint32_t taskCount() const { return (samples - 1) / taskSamples + 1; }
    SampleRange rangeOf(std::uint32_t task) const;
    /// "64-128.part.exr"
    std::string partOf(std::uint32_t task) const;
};

/// As many tasks as a plan may have: a controller of Slurm's keeps 10,000 jobs unless it is told
/// otherwise (MaxJobCount), and the names of as many parts fit on one command line.
inline constexpr std::uint32_t mostFarmTasks = 10'000;

/// Throws InputError for a plan of more tasks.
void checkFarmPlan(const FarmPlan& plan);

/// Ascending numbers as Slurm takes them: "3,7-9".
std::string numbersText(const std::vector<std::uint32_t>& numbers);

/// A job array: its elements are tasks, numbered from `firstTask` on.
struct TaskArray {
    std::uint32_t firstTask = 0;
    std::vector<std::uint32_t> elements;
};

/// Slurm takes no longer list of an array's elements than 4095 characters: numbers up to this one
/// need 2700 at most, whichever are missing.
inline constexpr std::uint32_t mostArrayElements = 1000;

/// Ascending tasks in arrays whose elements are numbered from 0 to less than `mostElements`.
std::vector<TaskArray> taskArrays(const std::vector<std::uint32_t>& tasks,
                                  std::uint32_t mostElements);

}  // namespace etendue
