#include "tools/regress_command.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/content_hash.h"
#include "renderer/parallel.h"
#include "tools/progress.h"
#include "tools/regress_report.h"
#include "tools/scene_names.h"
#include "tools/stop_request.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

constexpr int seedCount = 32;
constexpr int tileSize = 16;            // pixels
constexpr int width = 48, height = 32;  // of a reference that is made
constexpr std::uint32_t usualSamples = 16;

/// Every cell has random numbers of its own, and none those of a reference; which they are depends
/// on its names alone.
std::uint64_t firstSeedOf(const RegressCell& cell) {
    const std::string hash = contentHash({}, {cell.scene, cell.camera, cell.estimator});
    return (std::uint64_t{1} << 40) + seedCount * std::stoull(hash.substr(0, 8), nullptr, 16);
}

/// Of estimators that are held against one another.
const std::pair<const char*, const char*> pairs[] = {{"pt", "bdpt"}, {"lt", "bdpt"}, {"lt", "pt"}};

std::filesystem::path baselineFile(const RegressCommand& c) { return c.data / "baseline.toml"; }

/// A run over all scenes and cameras.
class RegressRun {
public:
    explicit RegressRun(const RegressCommand& command)
        : command_(command),
          scenes_(scenesCalled(command.scenes, command.folder)),
          threads_(command.threads.value_or(hardwareThreads())) {
        for (const std::string& name : command.cameras)
            cameras_.push_back(cameraCalled(name, command.folder));
        std::error_code error;
        if (!command.makesReferences &&
            !(command.rebaselines && !std::filesystem::exists(baselineFile(command), error)))
            baseline_ = readBaseline(baselineFile(command));
    }

    void makeReferences() {
        JobBar bar(scenes_.size() * cameras_.size(), 40.0);
        forEachView(bar, [&](const NamedFile& scene, const NamedFile& camera) {
            const std::string title = titleOf(scene, camera);
            const LoadedScene loaded = load(scene, camera, width, height, bar);
            RegressReferenceSettings settings;
            settings.threads = threads_;
            settings.tileSize = tileSize;
            if (command_.samples) settings.samples = static_cast<std::uint32_t>(*command_.samples);
            auto reference = makeReference(loaded, settings, goOn(bar, title));
            if (!reference) return;
            reference->scene = scene.name;
            reference->camera = camera.name;
            writeWholeFile(fileOf(scene, camera), referenceText(*reference));
            bar.finishJob(title);
        });
    }

    void test() {
        JobBar bar(scenes_.size() * cameras_.size() * command_.estimators.size(), 3.0);
        forEachView(bar, [&](const NamedFile& scene, const NamedFile& camera) {
            testThrough(scene, camera, bar);
        });
    }

    const RegressResults& results() const { return results_; }

    /// Takes up what was measured, but for cells that are wrong: their noise is no standard.
    Baseline newBaseline() const {
        Baseline baseline = baseline_;
        for (const CellResult& result : results_.cells) {
            if (!result.isSound()) continue;
            const BaselineRow* before = baseline_.of(result.cell);
            BaselineRow row = before ? *before : BaselineRow{};
            if (!before) {
                row.cell = result.cell;
                row.biasBound = boundFor(result.bias);
                row.judgesRate = result.rate != SlopeVerdict::inconclusive;
            }
            row.samples = result.samples;
            row.noise = result.noise.value;
            row.interval = result.noise.interval;
            baseline.put(row);
        }
        return baseline;
    }

private:
    template <typename Body>
    void forEachView(JobBar& bar, const Body& body) {
        for (const NamedFile& scene : scenes_)
            for (const NamedFile& camera : cameras_) {
                if (isStopRequested()) results_.isComplete = false;
                if (!results_.isComplete) break;
                try {
                    body(scene, camera);
                } catch (const InputError& error) {
                    results_.failures.push_back(
                        {titleOf(scene, camera), error.what(), error.code()});
                }
            }
        bar.clear();
    }

    std::filesystem::path fileOf(const NamedFile& scene, const NamedFile& camera) const {
        return referenceFile(command_.data / "references", scene.name, camera.name);
    }

    std::function<bool()> goOn(JobBar& bar, const std::string& title) {
        return [this, &bar, title] {
            bar.update(title, 0.0);
            if (isStopRequested()) results_.isComplete = false;
            return results_.isComplete;
        };
    }

    void testThrough(const NamedFile& scene, const NamedFile& camera, JobBar& bar) {
        const std::filesystem::path file = fileOf(scene, camera);
        std::error_code ignored;  // any other failure to look is told by reading
        if (!std::filesystem::exists(file, ignored))
            throw InputError(fmt::format("{}: no such file; etendue bench regress {} --cameras {} "
                                         "--make-references makes it",
                                         file.string(), scene.name, camera.name),
                             ExitCode::missingFile);
        const RegressReference reference = readReference(file);
        const LoadedScene loaded = load(scene, camera, reference.width, reference.height, bar);
        const PictureRegions regions{reference.width, reference.height, tileSize};
        std::vector<std::pair<std::string, HeldAgainst>> all;
        for (const std::string& estimator : command_.estimators) {
            CellResult result;
            result.cell = {scene.name, camera.name, estimator};
            result.isReferenceStale = reference.sceneHash != loaded.hash;
            const ReferencePicture& picture = pictureFor(reference, estimator, regions, file);
            const auto held = testCell(loaded, picture, regions, result, bar);
            if (!held) return;
            bar.finishJob(fmt::format("{}: {}", titleOf(result.cell), outcomeOf(result)));
            results_.cells.push_back(result);
            all.emplace_back(estimator, *held);
        }
        const auto of = [&](const std::string& estimator) {
            return std::ranges::find(all, estimator, &std::pair<std::string, HeldAgainst>::first);
        };
        for (const auto& pair : pairs) {
            const auto a = of(pair.first), b = of(pair.second);
            if (a == all.end() || b == all.end()) continue;
            results_.pairs.push_back({{scene.name, camera.name, pair.first},
                                      pair.second,
                                      judgeBetween(a->second, b->second, testCount(regions))});
        }
    }

    std::optional<HeldAgainst> testCell(const LoadedScene& loaded, const ReferencePicture& picture,
                                        const PictureRegions& regions, CellResult& result,
                                        JobBar& bar) {
        const BaselineRow* row = baseline_.of(result.cell);
        result.samples = row ? row->samples : usualSamples;
        if (command_.samples) result.samples = static_cast<std::uint32_t>(*command_.samples);
        SeedSettings settings;
        settings.checkpoints = checkpointsUpTo(result.samples);
        settings.seeds = seedCount;
        settings.firstSeed = command_.firstSeed + firstSeedOf(result.cell);
        settings.threads = threads_;
        const auto rendered = renderSeeds(
            loaded, testedPaths(loaded.estimator, result.cell.estimator, picture.leavesOut),
            settings, goOn(bar, titleOf(result.cell)));
        if (!rendered) return {};
        result.seconds = rendered->seconds;
        result.badSamples = rendered->badSamples;
        const HeldAgainst held = holdAgainst(*rendered, result.samples, picture, regions);
        if (row) result.biasBound = row->biasBound;
        result.bias = judgeBias(held, result.biasBound, testCount(regions));
        const BlockErrors errors = blockErrors(*rendered, result.samples, picture);
        result.slope = convergenceSlope(errors.samples, errors.errorsOf);
        result.rate = judgeRate(result.slope, cellCount(), seedCount);
        result.judgesRate = row && row->judgesRate;
        result.noise = noiseOf(errors);
        if (!row) return held;
        result.noiseBefore = {row->noise, row->interval};
        result.noiseVerdict = judgeNoise(*result.noiseBefore, result.noise, cellCount(), seedCount);
        return held;
    }

    static const ReferencePicture& pictureFor(const RegressReference& reference,
                                              const std::string& estimator,
                                              const PictureRegions& regions,
                                              const std::filesystem::path& file) {
        const ReferencePicture* picture = reference.of(estimator);
        if (!picture)
            throw InputError(fmt::format("{}: no picture for {}", file.string(), estimator));
        if (picture->means.front().size() != regions.count())
            throw InputError(fmt::format("{}: {} regions a batch, expected {}", file.string(),
                                         picture->means.front().size(), regions.count()));
        return *picture;
    }

    std::size_t cellCount() const {
        return scenes_.size() * cameras_.size() * command_.estimators.size();
    }
    /// Of cells, and of pairs: there are as many of either.
    std::size_t testCount(const PictureRegions& regions) const {
        return 2 * cellCount() * regions.count();
    }

    LoadedScene load(const NamedFile& scene, const NamedFile& camera, int across, int down,
                     JobBar& bar) const {
        return loadView(scene, camera, {{}, across, down, threads_}, bar);
    }

    const RegressCommand& command_;
    std::vector<NamedFile> scenes_, cameras_;
    int threads_;
    Baseline baseline_;
    RegressResults results_;
};

ExitCode exitCodeOf(const RegressResults& results, bool mustPass) {
    if (mustPass && !std::ranges::all_of(results.cells, &CellResult::passes))
        return ExitCode::failure;
    if (mustPass && std::ranges::any_of(results.pairs, [](const PairResult& pair) {
            return pair.bias.verdict == BiasVerdict::biased;
        }))
        return ExitCode::failure;
    if (!results.failures.empty()) return results.failures.front().code;
    return results.isComplete ? ExitCode::success : ExitCode::stoppedEarly;
}

void sayFailures(const RegressResults& results) {
    for (const RegressFailure& failure : results.failures)
        say(fmt::format("etendue: {}: {}\n", failure.what, failure.why));
}

}  // namespace

ExitCode runRegress(const RegressCommand& command) {
    heedStopRequests();
    RegressRun run(command);
    if (command.makesReferences) {
        run.makeReferences();
        sayFailures(run.results());
        return exitCodeOf(run.results(), false);
    }
    run.test();
    const RegressResults& results = run.results();
    const Baseline after = command.rebaselines ? run.newBaseline() : Baseline();
    // On disk before it is printed: nobody has seen what was not kept.
    if (command.rebaselines) writeWholeFile(baselineFile(command), baselineText(after));
    if (command.asJson)
        fmt::print("{}\n", regressJson(results).text());
    else
        fmt::print("{}", command.rebaselines ? rebaselineText(results.cells, after)
                                             : regressText(results));
    sayFailures(results);
    if (!command.rebaselines) return exitCodeOf(results, true);
    // That the noise has changed is what was asked about; what is wrong in itself was not taken.
    if (!std::ranges::all_of(results.cells, &CellResult::isSound)) return ExitCode::failure;
    return exitCodeOf(results, false);
}

}  // namespace etendue
