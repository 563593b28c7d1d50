// Which samples are whose.
#include "tools/farm_plan.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "config/config.h"

using namespace etendue;

TEST_CASE("Farm plan: the tasks have every sample once, and the last one what is left") {
    const std::vector<std::array<std::uint32_t, 4>> cases{{4096, 64, 64, 64},
                                                          {100, 30, 4, 10},
                                                          {5, 64, 1, 5},
                                                          {1, 1, 1, 1},
                                                          {1u << 30, 1u << 29, 2, 1u << 29},
                                                          {1u << 30, 999'999'999, 2, 73'741'825}};
    for (const auto& [samples, each, count, last] : cases) {
        const FarmPlan plan{samples, each};
        CAPTURE(plan.samples);
        REQUIRE(plan.taskCount() == count);
        SampleRanges all;
        for (std::uint32_t task = 0; task < count; ++task) all.add(plan.rangeOf(task));
        CHECK(all.ranges() == std::vector<SampleRange>{{0, samples}});
        CHECK(plan.rangeOf(0).size() == std::min(each, samples));
        CHECK(plan.rangeOf(count - 1).size() == last);
    }
    CHECK(FarmPlan{100, 30}.partOf(3) == "90-100.part.exr");
}

TEST_CASE("Farm plan: too many tasks are refused, with how many samples a task must have") {
    CHECK_NOTHROW(checkFarmPlan({10'000, 1}));
    CHECK_THROWS_WITH_AS(
        checkFarmPlan({1'000'001, 1}),
        "--task-samples 1: that is 1000001 tasks, and 10000 are the most; take 101 or more",
        InputError);
    CHECK_NOTHROW(checkFarmPlan({1'000'001, 101}));
}

TEST_CASE("Farm plan: numbers are written as Slurm takes them") {
    CHECK(numbersText({3}) == "3");
    CHECK(numbersText({0, 1, 2}) == "0-2");
    CHECK(numbersText({3, 7, 8, 9}) == "3,7-9");
    CHECK(numbersText({0, 2, 3, 5, 9, 10}) == "0,2-3,5,9-10");
    CHECK(numbersText({}).empty());
}

TEST_CASE("Farm plan: no array's elements reach the limit, and each is its task") {
    const std::vector<std::uint32_t> tasks{0, 3, 4, 5, 9, 16, 19};
    const std::vector<TaskArray> arrays = taskArrays(tasks, 5);
    REQUIRE(arrays.size() == 3);
    CHECK(arrays[0].firstTask == 0);
    CHECK(arrays[0].elements == std::vector<std::uint32_t>{0, 3, 4});
    CHECK(arrays[1].firstTask == 5);
    CHECK(arrays[1].elements == std::vector<std::uint32_t>{0, 4});
    CHECK(arrays[2].firstTask == 15);
    CHECK(arrays[2].elements == std::vector<std::uint32_t>{1, 4});
    CHECK(taskArrays(tasks, 1001).size() == 1);
    CHECK(taskArrays({}, 1001).empty());
}

TEST_CASE("Farm plan: whichever tasks are missing, the list of them is one that Slurm takes") {
    for (const std::uint32_t every : {2u, 3u, 4u}) {
        std::vector<std::uint32_t> tasks;
        for (std::uint32_t task = 0; task < mostFarmTasks; ++task)
            if (task % every != 0) tasks.push_back(task);
        for (const TaskArray& array : taskArrays(tasks, mostArrayElements))
            CHECK(numbersText(array.elements).size() < 4096);
    }
}
