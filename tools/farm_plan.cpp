#include "tools/farm_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/config.h"

namespace etendue {

SampleRange FarmPlan::rangeOf(std::uint32_t task) const {
    const std::uint32_t begin = task * taskSamples;
    return {begin, begin + std::min(taskSamples, samples - begin)};
}

std::string FarmPlan::partOf(std::uint32_t task) const {
    const SampleRange range = rangeOf(task);
    return fmt::format("{}-{}.part.exr", range.begin, range.end);
}

void checkFarmPlan(const FarmPlan& plan) {
    if (plan.taskCount() <= mostFarmTasks) return;
    const std::uint32_t fewest = (plan.samples - 1) / mostFarmTasks + 1;
    throw InputError(
        fmt::format("--task-samples {}: that is {} tasks, and {} are the most; take {} or more",
                    plan.taskSamples, plan.taskCount(), mostFarmTasks, fewest),
        ExitCode::usage);
}

std::string numbersText(const std::vector<std::uint32_t>& numbers) {
    std::string text;
    for (std::size_t i = 0; i < numbers.size();) {
        std::size_t last = i;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
        if (!text.empty()) text += ',';
        text += std::to_string(numbers[i]);
        if (last > i) text += fmt::format("-{}", numbers[last]);
        i = last + 1;
    }
    return text;
}

std::vector<TaskArray> taskArrays(const std::vector<std::uint32_t>& tasks,
                                  std::uint32_t mostElements) {
    std::vector<TaskArray> arrays;
    for (const std::uint32_t task : tasks) {
        const std::uint32_t element = task % mostElements;
        if (arrays.empty() || arrays.back().firstTask != task - element)
            arrays.push_back({task - element, {}});
        arrays.back().elements.push_back(element);
    }
    return arrays;
}

}  // namespace etendue
