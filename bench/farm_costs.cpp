#include "bench/farm_costs.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "bench/bench_scene.h"
#include "renderer/part_file.h"
#include "statistics/statistics.h"
#include "tools/part_keeper.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

constexpr int taskRuns = 9, mergeRounds = 3, checkpointRounds = 3;
/// So dense that what they cost stands out.
constexpr double secondsToCheckpoint = 1.5;

class Stopwatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct ProcessRun {
    double seconds = 0.0, peakBytes = 0.0;
};

/// Its memory counts from what this process holds when it begins.
ProcessRun runProcess(const std::vector<std::string>& words) {
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    malloc_trim(0);
    const Stopwatch watch;
    const pid_t child = fork();
    if (child == 0) {
        dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
        execv(arguments.front(), arguments.data());
        _exit(127);
    }
    int status = 0;
    rusage usage{};
    if (child < 0 || wait4(child, &status, 0, &usage) != child || status != 0)
        throw std::runtime_error(fmt::format("{}: failed", fmt::join(words, " ")));
    return {watch.seconds(), 1024.0 * static_cast<double>(usage.ru_maxrss)};
}

/// A folder that is gone afterwards.
class TemporaryFolder {
public:
    explicit TemporaryFolder(fs::path path) : path_(std::move(path)) {
        if (!fs::create_directories(path_))
            throw std::runtime_error(path_.string() + ": is there already");
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    fs::path operator/(const std::string& name) const { return path_ / name; }

private:
    fs::path path_;
};

/// Tasks of one sample as a farm runs them. Returns the seconds of each that were not rendering,
/// and leaves the last one's part.
std::vector<double> measureTasks(const FarmScene& scene, const fs::path& part, FarmCosts& costs) {
    std::vector<double> besides, samples, logs;
    for (int i = 0; i < taskRuns; ++i) {
        const ProcessRun run = runProcess({scene.program.string(), "render", scene.scene.string(),
                                           "--samples", std::to_string(scene.samples), "--size",
                                           fmt::format("{},{}", scene.width, scene.height), "-s",
                                           "estimator.kind=" + scene.estimator, "--threads",
                                           std::to_string(scene.threads), "--quiet", "--restart",
                                           "--range", fmt::format("{}:{}", i, i + 1), "-o", part});
        const double rendering = readPartInfo(part).seconds;
        if (i == 0) continue;  // may have fitted a lens, as a farm does before its tasks
        besides.push_back(run.seconds - rendering);
        samples.push_back(rendering);
        logs.push_back(std::log(rendering));
    }
    costs.sampleSeconds = median(samples);
    costs.partBytes = static_cast<double>(fs::file_size(part));
    costs.spread = std::sqrt(summarize(logs).variance);
    return besides;
}

fs::path partOf(const TemporaryFolder& folder, int i) {
    return folder / fmt::format("{}.part.exr", i);
}

/// Writes the part's sums again and again, as of one sample after the other.
void measureWrites(const fs::path& original, const TemporaryFolder& folder, int parts,
                   FarmCosts& costs) {
    Part part = readPart(original);
    PartInfo& info = part.info;
    Film film(info.window, info.layers, info.color);
    film.restore(std::move(part.state));
    const auto secondsOf = [&](const fs::path& file, std::uint32_t sample) {
        info.ranges = {};
        info.ranges.add({sample, sample + 1});
        const Stopwatch watch;
        writePart(file, info, film, {});
        return watch.seconds();
    };
    const TemporaryFolder memory(fmt::format("/dev/shm/etendue-farm-bench-{}", getpid()));
    std::vector<double> writes, encodes;
    for (int i = 0; i < parts; ++i) {
        writes.push_back(secondsOf(partOf(folder, i), static_cast<std::uint32_t>(i)));
        if (i % 4 == 0) encodes.push_back(secondsOf(partOf(memory, 0), 0));
    }
    costs.writeSeconds = median(writes);
    costs.encodeSeconds = median(encodes);
}

/// Least squares.
void fitMergeLine(FarmCosts& costs) {
    const auto count = static_cast<double>(costs.merges.size());
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (const MergeCost& m : costs.merges) {
        x += m.parts / count;
        y += m.seconds / count;
        xx += 1.0 * m.parts * m.parts / count;
        xy += m.parts * m.seconds / count;
    }
    costs.mergeSecondsPerPart = (xy - x * y) / (xx - x * x);
    costs.mergeSeconds = y - costs.mergeSecondsPerPart * x;
}

void measureMerges(const FarmScene& scene, const TemporaryFolder& folder, int mostParts,
                   FarmCosts& costs) {
    const std::vector<int> counts{mostParts / 16, mostParts / 4, mostParts};
    std::vector<std::vector<double>> seconds(counts.size()), bytes(counts.size());
    for (int round = 0; round < mergeRounds; ++round)
        for (std::size_t i = 0; i < counts.size(); ++i) {
            std::vector<std::string> words{scene.program, "merge", "-o", folder / "picture.exr"};
            for (int k = 0; k < counts[i]; ++k) words.push_back(partOf(folder, k));
            const ProcessRun run = runProcess(words);
            seconds[i].push_back(run.seconds);
            bytes[i].push_back(run.peakBytes);
        }
    for (std::size_t i = 0; i < counts.size(); ++i)
        costs.merges.push_back({counts[i], median(seconds[i]), median(bytes[i])});
    fitMergeLine(costs);
}

/// Renders with and without checkpoints in turn, many of them, as `etendue render` does.
void measureCheckpoints(const FarmScene& scene, const fs::path& file, FarmCosts& costs) {
    const LoadedScene loaded = loadForBench(scene.scene, scene.width, scene.height,
                                            {"estimator.kind=" + scene.estimator}, scene.threads);
    const FilmLayers layers{.luminanceVariance = true};
    RenderSettings settings;
    settings.samples =
        static_cast<std::uint32_t>(std::ceil(4.0 * secondsToCheckpoint / costs.sampleSeconds));
    settings.threads = scene.threads;
    settings.sampler = loaded.sampler;
    const auto secondsOf = [&](std::optional<PartKeeper> keeper, std::vector<double>& writes) {
        Film film(loaded.film.fullFrame(), layers, loaded.film.color);
        const auto onBatch = [&](const RenderProgress& p) {
            if (!keeper || !keeper->isDue()) return true;
            const Stopwatch watch;
            keeper->write(film, p.samplesDone, p.seconds, {});
            writes.push_back(watch.seconds());
            return true;
        };
        const Stopwatch watch;
        render(*loaded.scene, *loaded.camera, *makeEstimator(loaded.estimator), filterOf(loaded),
               film, settings, onBatch);
        return watch.seconds();
    };
    PartInfo info;
    info.window = loaded.film.fullFrame();
    info.layers = layers;
    info.color = loaded.film.color;
    std::vector<double> seconds, writes, none;
    for (int round = 0; round < checkpointRounds; ++round) {
        const std::size_t before = writes.size();
        const double with = secondsOf(PartKeeper(file, info, 0, secondsToCheckpoint), writes);
        const auto count = static_cast<double>(writes.size() - before);
        seconds.push_back((with - secondsOf({}, none)) / count);
    }
    costs.checkpointWriteSeconds = median(writes);
    costs.checkpointSeconds = median(seconds);
}

}  // namespace

FarmCosts measureFarmCosts(const FarmScene& scene, const fs::path& path, int mostParts) {
    const TemporaryFolder folder(path);
    FarmCosts costs;
    const std::vector<double> besides = measureTasks(scene, folder / "task.part.exr", costs);
    measureWrites(folder / "task.part.exr", folder, mostParts, costs);
    costs.startSeconds = median(besides) - costs.writeSeconds;
    measureMerges(scene, folder, mostParts, costs);
    measureCheckpoints(scene, folder / "checkpoint.part.exr", costs);
    for (const fs::directory_entry& file : fs::directory_iterator(path))
        costs.folderBytes += static_cast<double>(file.file_size());
    return costs;
}

}  // namespace etendue
