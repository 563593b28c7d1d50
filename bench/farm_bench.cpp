// How far one picture can be dealt out: the costs of a farm's work, measured on this machine, and
// farms of other sizes computed and simulated from them. The tables of docs/farm.md ("Scaling") and
// the cost of checkpoints in docs/part-files.md.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

#include "bench/farm_costs.h"
#include "bench/farm_model.h"
#include "renderer/parallel.h"
#include "tools/machine.h"
#include "tools/part_keeper.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

struct Options {
    FarmScene scene;
    fs::path folder = fs::temp_directory_path() / fmt::format("etendue-farm-bench-{}", getpid());
    int mostParts = 32;           // that are merged, measuring
    double bytesPerSecond = 1e9;  // of the file system that the nodes share
    std::uint64_t seed = 0;       // of the tasks' durations
};

Options parse(int argc, char** argv) {
    Options o;
    const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
    o.scene.program = here.parent_path() / "tools/etendue";
    o.scene.scene = "scenes/still-life/scene.toml";
    o.scene.threads = hardwareThreads();
    for (int i = 1; i < argc; i += 2) {
        const std::string_view name = argv[i];
        if (i + 1 == argc) throw std::runtime_error(fmt::format("{}: needs a value", name));
        const std::string value = argv[i + 1];
        if (name == "--scene")
            o.scene.scene = value;
        else if (name == "--estimator")
            o.scene.estimator = value;
        else if (name == "--width")
            o.scene.width = std::stoi(value);
        else if (name == "--height")
            o.scene.height = std::stoi(value);
        else if (name == "--threads")
            o.scene.threads = std::stoi(value);
        else if (name == "--samples")
            o.scene.samples = static_cast<std::uint32_t>(std::stoul(value));
        else if (name == "--parts")
            o.mostParts = std::stoi(value);
        else if (name == "--bandwidth")
            o.bytesPerSecond = 1e6 * std::stod(value);
        else if (name == "--folder")
            o.folder = value;
        else if (name == "--seed")
            o.seed = std::stoull(value);
        else
            throw std::runtime_error(fmt::format("{}: no such option", name));
    }
    return o;
}

void printCosts(const Options& o, const FarmCosts& c) {
    const Machine machine = thisMachine();
    fmt::print("{}, {}, {} × {}; {}, {} threads, load {:.1f}\n\n", o.scene.scene.string(),
               o.scene.estimator, o.scene.width, o.scene.height, machine.processor, o.scene.threads,
               machineLoad());
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
    const double plain = farm.render(plan, {false, false, false}).wallSeconds;
    const double started = farm.render(plan, {true, false, false}).wallSeconds;
    const double spread = farm.render(plan, {true, true, false}).wallSeconds;
    const FarmRun tasks = farm.render(plan, {}), merge = farm.merge(plan);
    const double wall = tasks.wallSeconds + merge.wallSeconds;
    const double speedUp = secondsOfOne / wall;
    const std::string groups =
        plan.groups > 1 ? fmt::format(", merged by {}", plan.groups) : std::string();
    fmt::print(
        "| {}{} | {} | {} | {:.0f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.0f} | {:.0f} | "
        "{:.2f} | {:.1f} | {:.1f} | {:.0f} % |\n",
        plan.tasks, groups, plan.nodes, farm.samplesOfTask(plan), plain, started - plain,
        spread - started, tasks.wallSeconds - spread, merge.wallSeconds, wall,
        farm.formulaSeconds(plan), (tasks.nodeSeconds + merge.nodeSeconds) / 3600.0,
        1e-9 * farm.bytesOfParts(plan), speedUp, 100.0 * speedUp / plan.nodes);
}

void printFarms(const Options& o, const FarmCosts& costs) {
    const FarmModel farm(costs, o.scene.samples, o.bytesPerSecond, o.seed);
    const FarmRun one = farm.render({}, {}), oneMerge = farm.merge({});
    fmt::print("\n{} samples per pixel; a file system of {:.0f} MB/s for all nodes\n\n",
               o.scene.samples, 1e-6 * o.bytesPerSecond);
    fmt::print(
        "| tasks | nodes | samples of a task | render s | start-up s | slowest task s | "
        "writing s | merge s | wall s | by formula | node hours | GB of parts | speed-up | "
        "efficiency |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
        "\n");
    const double bend = farm.nodesAtBend(), merging = farm.nodesAtBendOfMerge();
    const auto asManyNodes = [](double tasks) {
        return DealtOut{static_cast<std::uint32_t>(tasks), static_cast<int>(tasks)};
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
        const etendue::Options options = etendue::parse(argc, argv);
        const etendue::FarmCosts costs =
            etendue::measureFarmCosts(options.scene, options.folder, options.mostParts);
        etendue::printCosts(options, costs);
        etendue::printFarms(options, costs);
    } catch (const std::exception& error) {
        fmt::print(stderr, "farm_bench: {}\n", error.what());
        return 1;
    }
}
