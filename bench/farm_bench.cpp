// How far one picture can be dealt out: the costs of a farm's work, measured on this machine, and
// farms of other sizes computed and simulated from them. The tables of docs/farm.md ("Scaling") and
// the cost of checkpoints in docs/part-files.md.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

#include "bench/farm_costs.h"
#include "bench/farm_model.h"
#include "renderer/parallel.h"
#include "tools/machine.h"
#include "tools/option_checks.h"
#include "tools/part_keeper.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

struct Options {
    FarmScene scene;
    fs::path folder = fs::temp_directory_path() / fmt::format("etendue-farm-bench-{}", getpid());
    int mostParts = 32;                // that are merged, measuring
    double megabytesPerSecond = 1000;  // of the file system that the nodes share
    std::uint64_t seed = 0;            // of the tasks' durations
};

void addOptions(CLI::App& app, Options& o) {
    const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
    o.scene.program = here.parent_path() / "tools/etendue";
    o.scene.scene = "scenes/still-life/scene.toml";
    o.scene.threads = hardwareThreads();
    const auto count = [&](const std::string& name, auto& value, double lowest, double highest,
                           const std::string& text) {
        app.add_option(name, value, text)->check(numberBetween(lowest, highest));
    };
    app.add_option("--scene", o.scene.scene);
    app.add_option("--estimator", o.scene.estimator);
    count("--width", o.scene.width, 1, 1 << 14, "Pixels");
    count("--height", o.scene.height, 1, 1 << 14, "Pixels");
    count("--threads", o.scene.threads, 1, 1024, "Of a task");
    count("--samples", o.scene.samples, 1, 1 << 24, "Per pixel, of the whole picture");
    count("--parts", o.mostParts, 16, 4096, "As many are merged, a quarter, and a sixteenth");
    count("--bandwidth", o.megabytesPerSecond, 0.001, 1e9, "MB/s, of the file system of all");
    app.add_option("--folder", o.folder, "Made and removed; it has to hold the parts");
    app.add_option("--seed", o.seed, "Of the tasks' durations");
}

void printCosts(const Options& o, const FarmCosts& c) {
    const Machine machine = thisMachine();
    fmt::print("{}, {}, {} × {}; {}, {} threads, load {:.1f}\n", o.scene.scene.string(),
               o.scene.estimator, o.scene.width, o.scene.height, machine.processor, o.scene.threads,
               machineLoad());
    fmt::print("measured with {:.1f} GB in {}\n\n", 1e-9 * c.folderBytes, o.folder.string());
    fmt::print("| | |\n|---|---:|\n");
    fmt::print("| start-up of a task | {:.2f} s |\n", c.startSeconds);
    fmt::print("| a sample of the frame | {:.2f} s, spread {:.1f} % |\n", c.sampleSeconds,
               100.0 * c.spread);
    fmt::print("| a part | {:.1f} MB |\n", 1e-6 * c.partBytes);
    fmt::print("| writing it: into memory; into the folder, synced | {:.2f} s; {:.2f} s |\n",
               c.encodeSeconds, c.writeSeconds);
    fmt::print("| merging n parts, in the page cache | {:.2f} s + n × {:.3f} s |\n", c.mergeSeconds,
               c.mergeSecondsPerPart);
    for (const MergeCost& m : c.merges)
        fmt::print("| merging {}: time; memory at the most | {:.2f} s; {:.0f} MB |\n", m.parts,
                   m.seconds, 1e-6 * m.peakBytes);
    const double interval = defaultCheckpointInterval(c.checkpointWriteSeconds);
    fmt::print(
        "\n| estimator | MB | s to write | s longer | interval s | share | of the first minute |\n"
        "|---|---:|---:|---:|---:|---:|---:|\n"
        "| {} | {:.0f} | {:.2f} | {:.2f} | {:.0f} | {:.2f} % | {:.1f} % |\n",
        o.scene.estimator, 1e-6 * c.partBytes, c.checkpointWriteSeconds, c.checkpointSeconds,
        interval, 100.0 * c.checkpointSeconds / interval,
        100.0 * c.checkpointSeconds / defaultCheckpointInterval(0.0));
}

void printRow(const FarmModel& farm, const DealtOut& plan, double secondsOfOne) {
    const double renderSeconds = farm.render(plan, {false, false, false}).wallSeconds;
    const double startedSeconds = farm.render(plan, {true, false, false}).wallSeconds;
    const double unevenSeconds = farm.render(plan, {true, true, false}).wallSeconds;
    const FarmRun tasks = farm.render(plan, {}), merge = farm.merge(plan);
    const double wall = tasks.wallSeconds + merge.wallSeconds;
    const double speedUp = secondsOfOne / wall;
    const std::string groups =
        plan.groups > 1 ? fmt::format(", merged in {} groups", plan.groups) : std::string();
    fmt::print(
        "| {}{} | {} | {:.0f} | {:.0f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.0f} | {:.0f} | "
        "{:.2f} | {:.1f} | {:.1f} | {:.0f} % |\n",
        plan.tasks, groups, plan.nodes, std::round(farm.samplesOfTask(plan)), renderSeconds,
        startedSeconds - renderSeconds, unevenSeconds - startedSeconds,
        tasks.wallSeconds - unevenSeconds, merge.wallSeconds, wall, farm.formulaSeconds(plan),
        (tasks.nodeSeconds + merge.nodeSeconds) / 3600.0, 1e-9 * farm.bytesOfParts(plan), speedUp,
        100.0 * speedUp / plan.nodes);
}

void printFarms(const Options& o, const FarmCosts& costs) {
    const FarmModel farm(costs, o.scene.samples, 1e6 * o.megabytesPerSecond, o.seed);
    const FarmRun one = farm.render({}, {}), oneMerge = farm.merge({});
    fmt::print("\n{} samples per pixel; a file system of {:.0f} MB/s for all nodes\n\n",
               o.scene.samples, o.megabytesPerSecond);
    fmt::print(
        "| tasks | nodes | samples of a task | render s | start-up s | slowest task s | "
        "writing s | merge s | wall s | by formula | node hours | GB of parts | speed-up | "
        "efficiency |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
        "\n");
    const double bend = farm.nodesAtBend(), merging = farm.nodesAtBendOfMerge();
    const auto asManyNodes = [](double nodes) {
        const int tasks = std::max(1, static_cast<int>(std::lround(nodes)));
        return DealtOut{static_cast<std::uint32_t>(tasks), tasks};
    };
    const DealtOut plans[] = {{1, 1},
                              {8, 8},
                              {64, 64},
                              {512, 512},
                              {512, 512, 22},
                              asManyNodes(bend / 3.0),
                              asManyNodes(bend),
                              {128, 64},
                              {512, 64},
                              {4096, 64},
                              {4096, 64, 64}};
    for (const DealtOut& plan : plans)
        if (plan.tasks <= o.scene.samples)
            printRow(farm, plan, one.wallSeconds + oneMerge.wallSeconds);
    fmt::print(
        "\nbends at {:.0f} nodes, {:.0f} samples a task; were the file system no limit, at "
        "{:.0f} nodes, {:.0f} samples\n",
        bend, o.scene.samples / bend, merging, o.scene.samples / merging);
}

}  // namespace
}  // namespace etendue

int main(int argc, char** argv) {
    try {
        etendue::Options options;
        CLI::App app("What a farm's tasks cost on this machine, and farms simulated from that");
        etendue::addOptions(app, options);
        CLI11_PARSE(app, argc, argv);
        const etendue::FarmCosts costs =
            etendue::measureFarmCosts(options.scene, options.folder, options.mostParts);
        etendue::printCosts(options, costs);
        etendue::printFarms(options, costs);
    } catch (const std::exception& error) {
        fmt::print(stderr, "farm_bench: {}\n", error.what());
        return 1;
    }
}
