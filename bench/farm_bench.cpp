// How far one picture can be dealt out: the costs of a farm's work, measured on this machine, and
// farms of other sizes computed and simulated from them. The tables of docs/farm.md ("Scaling") and
// the cost of checkpoints in docs/part-files.md.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bench/farm_costs.h"
#include "bench/farm_simulation.h"
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

struct Plan {
    std::uint32_t tasks = 1;
    int nodes = 1;
    std::uint32_t groups = 1;  // merged to parts first, side by side
};

/// What a simulation takes into account.
struct Effects {
    bool start = true, spread = true, writing = true;
};

class Farm {
public:
    Farm(const FarmCosts& costs, const Options& options)
        : c_(costs),
          samples_(options.scene.samples),
          bandwidth_(options.bytesPerSecond),
          seed_(options.seed) {}

    /// Until the last task is done: the mean over draws of all durations.
    FarmRun render(const Plan& plan, const Effects& effects) const {
        const int draws = effects.spread ? 32 : 1;
        const double s = effects.spread ? c_.spread : 0.0;
        FarmRun mean;
        for (int draw = 0; draw < draws; ++draw) {
            // In pairs, slow for fast: so that few draws of long tasks do not miss the mean.
            std::mt19937_64 random(seed_ + static_cast<std::uint64_t>(draw / 2));
            std::normal_distribution<double> normal;
            const double scale = draw % 2 == 0 ? s : -s;
            std::vector<FarmJob> jobs;
            for (std::uint32_t i = 0; i < plan.tasks; ++i) {
                const double slower = std::exp(scale * normal(random));
                jobs.push_back(task(taskSeconds(plan) * slower, effects));
            }
            const FarmRun run = simulateFarm(jobs, plan.nodes, bandwidth_);
            mean.wallSeconds += run.wallSeconds / draws;
            mean.nodeSeconds += run.nodeSeconds / draws;
        }
        return mean;
    }
    FarmRun merge(const Plan& plan) const {
        std::vector<FarmJob> jobs;
        for (std::uint32_t g = 0; g < plan.groups && plan.groups > 1; ++g)
            jobs.push_back(mergeJob((plan.tasks + g) / plan.groups, true));
        const FarmRun groups = simulateFarm(jobs, plan.nodes, bandwidth_);
        const std::uint32_t parts = plan.groups > 1 ? plan.groups : plan.tasks;
        const FarmRun last = simulateFarm({mergeJob(parts, false)}, 1, bandwidth_);
        return {groups.wallSeconds + last.wallSeconds, groups.nodeSeconds + last.nodeSeconds};
    }

    /// The same without spread, and as if all wrote at the same time.
    double formulaSeconds(const Plan& p) const {
        const double rounds = std::ceil(1.0 * p.tasks / p.nodes);
        const double writers = std::min<double>(p.tasks, p.nodes);
        const double write = c_.encodeSeconds + writers * transferSeconds();
        double merge = c_.mergeSeconds + p.tasks * mergeSecondsPerPart();
        if (p.groups > 1)
            merge = 2.0 * c_.mergeSeconds + c_.mergeSecondsPerPart * p.tasks / p.groups +
                    p.tasks * transferSeconds() + c_.encodeSeconds +
                    p.groups * (mergeSecondsPerPart() + transferSeconds());
        return rounds * (c_.startSeconds + taskSeconds(p) + (1 + checkpoints(p)) * write) + merge;
    }
    double taskSeconds(const Plan& p) const { return c_.sampleSeconds * samples_ / p.tasks; }
    /// On the way of a task.
    int checkpoints(const Plan& p) const {
        return static_cast<int>(std::ceil(taskSeconds(p) / interval())) - 1;
    }
    double bytesOfParts(const Plan& p) const {
        return c_.partBytes * p.tasks * (checkpoints(p) > 0 ? 2.0 : 1.0);
    }
    /// As many nodes as this render as long as their parts are written and merged.
    double nodesAtBend() const {
        return std::sqrt(c_.sampleSeconds * samples_ / (mergeSecondsPerPart() + transferSeconds()));
    }
    std::uint32_t samplesOfTask(const Plan& p) const { return samples_ / p.tasks; }

private:
    double transferSeconds() const { return c_.partBytes / bandwidth_; }
    /// It is read, then added.
    double mergeSecondsPerPart() const { return c_.mergeSecondsPerPart + transferSeconds(); }
    double interval() const {
        return defaultCheckpointInterval(c_.encodeSeconds + transferSeconds());
    }
    FarmJob task(double seconds, const Effects& effects) const {
        double before = effects.start ? c_.startSeconds : 0.0;
        if (!effects.writing) return {{before + seconds, 0.0}};
        FarmJob job;
        for (; seconds > interval(); seconds -= interval(), before = 0.0)
            job.push_back({before + interval() + c_.encodeSeconds, c_.partBytes});
        job.push_back({before + seconds + c_.encodeSeconds, c_.partBytes});
        return job;
    }
    FarmJob mergeJob(std::uint32_t parts, bool writesPart) const {
        FarmJob job{{c_.mergeSeconds, c_.partBytes}};
        for (std::uint32_t i = 1; i < parts; ++i)
            job.push_back({c_.mergeSecondsPerPart, c_.partBytes});
        job.push_back({c_.mergeSecondsPerPart + (writesPart ? c_.encodeSeconds : 0.0),
                       writesPart ? c_.partBytes : 0.0});
        return job;
    }

    FarmCosts c_;
    std::uint32_t samples_;
    double bandwidth_;
    std::uint64_t seed_;
};

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

void printRow(const Farm& farm, const Plan& plan, double secondsOfOne) {
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
    const Farm farm(costs, o);
    const FarmRun one = farm.render({}, {}), oneMerge = farm.merge({});
    fmt::print("\n{} samples per pixel; a file system of {:.0f} MB/s for all nodes\n\n",
               o.scene.samples, 1e-6 * o.bytesPerSecond);
    fmt::print(
        "| tasks | nodes | samples of a task | render s | start-up s | slowest task s | "
        "writing s | merge s | wall s | by formula | node hours | GB of parts | speed-up | "
        "efficiency |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
        "\n");
    const Plan plans[] = {{1, 1},    {8, 8},    {64, 64},   {512, 512},    {512, 512, 22},
                          {128, 64}, {512, 64}, {4096, 64}, {4096, 64, 64}};
    for (const Plan& plan : plans)
        if (plan.tasks <= o.scene.samples)
            printRow(farm, plan, one.wallSeconds + oneMerge.wallSeconds);
    const double bend = farm.nodesAtBend();
    fmt::print("\nbends at {:.0f} nodes, {:.0f} samples a task\n", bend, o.scene.samples / bend);
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
