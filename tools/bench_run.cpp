#include "tools/bench_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/render.h"
#include "renderer/scene_loader.h"
#include "tools/bench_fit_error.h"
#include "tools/bench_lens.h"
#include "tools/bench_reference.h"
#include "tools/machine.h"
#include "tools/progress.h"
#include "tools/progressive_render.h"
#include "tools/stop_request.h"
#include "tools/version.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

/// One suite's run over one folder.
class BenchRunner {
public:
    BenchRunner(const BenchSuite& suite, const BenchRunSettings& settings,
                const BenchFolder& folder)
        : suite_(suite),
          settings_(settings),
          folder_(folder),
          records_(readBenchRecords(folder.records())),
          bar_(suite.runCount(), suite.seconds) {
        makeFolder(folder.path / "pictures");
        if (records_.header)
            checkHeader();
        else
            header_ = newHeader();
    }

    bool run() {
        if (!checkAll()) return false;
        if (header_) appendRecord(folder_.records(), *header_);
        for (const BenchView& view : suite_.views)
            if (isDone(view))
                skip(view);
            else if (!runView(view))
                return false;
        bar_.clear();
        return true;
    }

private:
    BenchHeader newHeader() const {
        const Machine machine = thisMachine();
        BenchHeader header;
        header.title = suite_.title;
        header.key = suite_.key();
        header.command = settings_.command;
        header.version = version;
        header.started = utcNow();
        header.processor = machine.processor;
        header.cores = machine.cores;
        header.isa = machine.isa;
        header.compiler = machine.compiler;
        header.build = machine.build;
        header.system = machine.system;
        header.threads = settings_.threads;
        header.load = machineLoad();
        return header;
    }

    void checkHeader() const {
        const BenchHeader& header = *records_.header;
        const auto refuse = [&](const std::string& what) {
            throw InputError(
                fmt::format("{}: holds results of {}; take another folder or remove this one",
                            folder_.records().string(), what));
        };
        if (header.key != suite_.key()) refuse("another suite, or of this one with other settings");
        if (header.version != version) refuse("etendue " + header.version);
        if (header.threads != settings_.threads) refuse(fmt::format("{} threads", header.threads));
    }

    template <class Visit>
    void forEachRun(const BenchView& view, const Visit& visit) const {
        for (int seed = 0; seed < suite_.seeds; ++seed)
            for (std::size_t v = 0; v < view.variants.size(); ++v)
                for (const std::string& estimator : view.estimators)
                    visit(BenchConfiguration{view.scene.name, view.camera.name,
                                             view.variants[v].name, estimator},
                          v, seed);
    }

    bool isDone(const BenchView& view) const {
        std::size_t done = 0, all = 0;
        forEachRun(view, [&](const BenchConfiguration& configuration, std::size_t, int seed) {
            ++all;
            if (records_.find(configuration, seed)) ++done;
        });
        const bool wantsTechniques = hasTechniques(view);
        return all > 0 && done == all &&
               (!wantsTechniques ||
                std::filesystem::exists(folder_.techniques(view.scene.name, view.camera.name)));
    }

    void skip(const BenchView& view) {
        forEachRun(view, [&](const BenchConfiguration&, std::size_t, int) { bar_.skipJobs(1); });
    }

    /// Loads all that is to be measured or was, so that a mistake in the last view is told before
    /// the first one is measured. One at a time, since scenes may be large. False if a signal came.
    bool checkAll() {
        for (const BenchView& view : suite_.views) {
            bar_.update(titleOf(view.scene, view.camera) + ": is loaded, to check it", 0.0);
            const std::string hash = load(view, {}).hash;
            for (const BenchVariant& variant : view.variants) {
                if (isStopRequested()) return false;
                checkUnchanged(view, variant,
                               variant.overrides.empty() ? hash : load(view, variant).hash);
            }
        }
        return true;
    }

    void checkUnchanged(const BenchView& view, const BenchVariant& variant,
                        const std::string& hash) const {
        for (const BenchRun& run : records_.runs) {
            const BenchConfiguration& c = run.configuration;
            if (c.scene == view.scene.name && c.camera == view.camera.name &&
                c.variant == variant.name && run.sceneHash != hash)
                throw InputError(fmt::format(
                    "{}: holds results of {} as it was before it was changed; take another "
                    "folder or remove this one",
                    folder_.records().string(), view.scene.file.string()));
        }
    }

    bool hasTechniques(const BenchView& view) const {
        return suite_.wantsTechniques && std::find(view.estimators.begin(), view.estimators.end(),
                                                   "bdpt") != view.estimators.end();
    }

    LoadedScene load(const BenchView& view, const BenchVariant& variant) {
        ViewOptions options{view.overrides, suite_.width, suite_.height, settings_.threads, true};
        options.overrides.insert(options.overrides.end(), variant.overrides.begin(),
                                 variant.overrides.end());
        try {
            return loadView(view.scene, view.camera, options, bar_);
        } catch (const InputError& error) {
            bar_.clear();
            failLoading(view, variant, error);
        }
    }

    bool runView(const BenchView& view) {
        std::vector<LoadedScene> variants;
        for (const BenchVariant& variant : view.variants) {
            variants.push_back(load(view, variant));
            checkUnchanged(view, variant, variants.back().hash);
            recordLens(view, variant, variants.back());
        }
        // The scene as it is, which often is the first variant; a lens of glass by its exact trace.
        std::optional<LoadedScene> other;
        if (!view.variants.front().overrides.empty()) other = load(view, {});
        const bool isFitted = (other ? *other : variants.front()).fit.has_value();
        if (isFitted) other = load(view, {"", {"camera.representation=traced"}});
        const LoadedScene& truth = other ? *other : variants.front();
        if (suite_.wantsFitErrors && isFitted && !recordFitErrors(view, truth, variants))
            return false;
        if (view.estimators.empty()) return true;
        const std::optional<Picture> reference = referenceOf(view, truth);
        if (!reference) return false;
        bool goesOn = true;
        forEachRun(view, [&](const BenchConfiguration& configuration, std::size_t v, int seed) {
            if (!goesOn) return;
            if (records_.find(configuration, seed))
                bar_.skipJobs(1);
            else
                goesOn = runOne(configuration, seed, variants[v], *reference);
        });
        if (goesOn && hasTechniques(view)) goesOn = renderTechniques(view, variants.front());
        return goesOn;
    }

    void recordLens(const BenchView& view, const BenchVariant& variant, const LoadedScene& loaded) {
        const auto isSame = [&](const BenchLens& lens) {
            return lens.camera == lensName(view) && lens.variant == variant.name;
        };
        if (std::any_of(records_.lenses.begin(), records_.lenses.end(), isSame)) return;
        BenchLens lens = measureLens(loaded);
        lens.camera = lensName(view);
        lens.variant = variant.name;
        appendRecord(folder_.records(), lens);
        records_.lenses.push_back(lens);
    }

    /// A scene's own camera is no other scene's.
    static std::string lensName(const BenchView& view) {
        return view.camera.name == "own" ? view.scene.name + ", own" : view.camera.name;
    }

    bool hasFitError(const BenchView& view, const BenchVariant& variant) const {
        return std::any_of(records_.fitErrors.begin(), records_.fitErrors.end(),
                           [&](const BenchFitError& e) {
                               return e.scene == view.scene.name && e.camera == view.camera.name &&
                                      e.variant == variant.name;
                           });
    }

    bool recordFitErrors(const BenchView& view, const LoadedScene& traced,
                         const std::vector<LoadedScene>& variants) {
        FitErrorSettings settings;
        settings.threads = settings_.threads;
        std::optional<std::vector<Picture>> exact, fitted;
        for (std::size_t v = 0; v < variants.size(); ++v) {
            const BenchVariant& variant = view.variants[v];
            if (!variants[v].fit || hasFitError(view, variant)) continue;
            const auto goOn = [&] {
                bar_.update(fmt::format("{}, {}: error of the fit",
                                        titleOf(view.scene, view.camera), variant.name),
                            0.0);
                return !isStopRequested();
            };
            if (!exact) exact = fitErrorPictures(traced, settings, goOn);
            if (exact) fitted = fitErrorPictures(variants[v], settings, goOn);
            if (!exact || !fitted) return false;
            const FitImageError error = fitImageError(*exact, *fitted, settings);
            const BenchFitError record{
                view.scene.name,    view.camera.name,    variant.name,          error.relMse,
                error.interval.low, error.interval.high, error.noiseOfOneSample};
            appendRecord(folder_.records(), record);
            records_.fitErrors.push_back(record);
        }
        return true;
    }

    std::optional<Picture> referenceOf(const BenchView& view, const LoadedScene& truth) {
        const std::string title = titleOf(view.scene, view.camera) + ": reference";
        const BenchReferenceSettings settings{suite_.referenceEstimator, suite_.referenceSeconds,
                                              settings_.threads};
        const auto goOn = [&](double share) {
            bar_.update(fmt::format("{} {:.0f} %", title, 100.0 * share), 0.0);
            return !isStopRequested();
        };
        const auto notice = [&](const std::string& sentence) {
            bar_.clear();
            say(fmt::format("note: {}\n", sentence));
        };
        const std::optional<Reference> reference =
            referenceFor(truth, settings, referenceCacheDirectory(), goOn, notice);
        if (!reference) return {};
        const auto isSame = [&](const BenchReference& r) {
            return r.scene == view.scene.name && r.camera == view.camera.name &&
                   r.key == reference->key;
        };
        if (std::none_of(records_.references.begin(), records_.references.end(), isSame)) {
            writeExr(folder_.referencePicture(view.scene.name, view.camera.name),
                     truth.film.fullFrame(), {{{"R", "G", "B"}, reference->mean.pixels}}, {});
            const BenchReference record{
                view.scene.name,    view.camera.name,   suite_.referenceEstimator, reference->key,
                reference->samples, reference->seconds, reference->mean.relMse};
            appendRecord(folder_.records(), record);
            records_.references.push_back(record);
        }
        return reference->mean.pixels;
    }

    bool runOne(const BenchConfiguration& configuration, int seed, const LoadedScene& loaded,
                const Picture& reference) {
        const std::string title = titleOf(configuration);
        const double load = machineLoad();
        const ProgressiveSettings settings{configuration.estimator, suite_.seconds,
                                           suite_.mostSamples, static_cast<std::uint64_t>(seed),
                                           settings_.threads};
        const auto render = renderProgressively(loaded, settings, reference, [&](double share) {
            bar_.update(title, share);
            return !isStopRequested();
        });
        if (!render) return false;
        writeExr(folder_.picture(configuration, seed), loaded.film.fullFrame(),
                 {{{"R", "G", "B"}, render->picture}}, {});
        const BenchRun run{configuration,      seed,         loaded.hash,        load,
                           render->badSamples, render->flip, render->checkpoints};
        appendRecord(folder_.records(), run);
        records_.runs.push_back(run);
        const BenchCheckpoint& last = run.checkpoints.back();
        bar_.finishJob(fmt::format("{}, seed {}: {} samples in {:.2f} s, relMSE {:.3g}", title,
                                   seed, last.samples, last.seconds, last.errors.relMse));
        return !isStopRequested();
    }

    bool renderTechniques(const BenchView& view, const LoadedScene& loaded) {
        const std::filesystem::path file = folder_.techniques(view.scene.name, view.camera.name);
        if (std::filesystem::exists(file)) return true;
        Film film(loaded.film.fullFrame(), {}, loaded.film.color);
        TechniqueImages images(film.window(), film.color());
        RenderSettings settings;
        settings.samples = suite_.mostSamples;
        settings.timeLimitSeconds = suite_.seconds;
        settings.threads = settings_.threads;
        settings.techniqueImages = &images;
        const RenderResult result = render(
            *loaded.scene, *loaded.camera, *makeEstimator(withKind(loaded.estimator, "bdpt")),
            Filter(loaded.film.filter, loaded.film.filterRadius), film, settings,
            [&](const RenderProgress&) {
                bar_.update(titleOf(view.scene, view.camera) + ": techniques of bdpt", 0.0);
                return !isStopRequested();
            });
        if (result.wasInterrupted) return false;
        writeExr(file, film.window(), images.channels(film.samples()), {});
        return true;
    }

    const BenchSuite& suite_;
    const BenchRunSettings& settings_;
    const BenchFolder& folder_;
    BenchRecords records_;
    std::optional<BenchHeader> header_;  // of new records
    JobBar bar_;
};

}  // namespace

bool runBench(const BenchSuite& suite, const BenchRunSettings& settings,
              const BenchFolder& folder) {
    return BenchRunner(suite, settings, folder).run();
}

}  // namespace etendue
