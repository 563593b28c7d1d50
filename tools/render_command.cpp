#include "tools/render_command.h"

#include <fmt/format.h>

#include <algorithm>

#include "lens/fit_cache.h"
#include "renderer/atomic_file.h"
#include "renderer/output_lock.h"
#include "renderer/parallel.h"
#include "renderer/part_file.h"
#include "renderer/render.h"
#include "renderer/scene_loader.h"
#include "tools/part_keeper.h"
#include "tools/picture_noise.h"
#include "tools/preview.h"
#include "tools/scene_names.h"
#include "tools/stop_request.h"
#include "tools/version.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

FrameWindow windowFor(const RenderCommand& command, const FilmSettings& film) {
    FrameWindow window = film.fullFrame();
    if (command.crop.empty()) return window;
    window.x = command.crop[0];
    window.y = command.crop[1];
    window.width = command.crop[2];
    window.height = command.crop[3];
    if (window.width < 1 || window.height < 1 || window.x + window.width > film.width ||
        window.y + window.height > film.height)
        throw InputError(
            fmt::format("--crop {},{},{},{}: must lie in the frame of {} × {} pixels", window.x,
                        window.y, window.width, window.height, film.width, film.height),
            ExitCode::usage);
    return window;
}

bool isAskedFor(const RenderCommand& command, const char* layer) {
    return std::ranges::find(command.layers, layer) != command.layers.end();
}

/// Light paths fall all over the picture, and so do wavelengths that a lens parts: pixels are not
/// independent then, as etendue compare takes those to be that say the variance of their colours.
bool hasVarianceOfColors(const LoadedScene& loaded) {
    return loaded.estimator.kind == "pt" &&
           !isParted(*loaded.camera, loaded.film.color == FilmColor::xyz);
}

FilmLayers layersFor(const RenderCommand& command, const LoadedScene& loaded) {
    FilmLayers layers;
    layers.albedo = isAskedFor(command, "albedo");
    layers.normal = isAskedFor(command, "normal");
    layers.depth = isAskedFor(command, "depth");
    layers.position = isAskedFor(command, "position");
    layers.variance = isAskedFor(command, "variance") && hasVarianceOfColors(loaded);
    layers.luminanceVariance = true;  // of whole pictures: --error, part files
    return layers;
}

/// The viewer's axes (x right, y up, looking along −z) as OpenEXR keeps matrices: row vectors, so
/// the translation is in the last row.
std::vector<float> worldToCamera(const Camera& camera) {
    const Transform& t = camera.settings().worldFromLens;
    const Transform worldFromCamera{-t.x, t.y, -t.z, t.translation};
    const Transform m = worldFromCamera.inverse();
    std::vector<float> rows;
    for (const auto& [v, w] : {std::pair{m.x, 0.0}, {m.y, 0.0}, {m.z, 0.0}, {m.translation, 1.0}})
        for (const double value : {v.x, v.y, v.z, w}) rows.push_back(static_cast<float>(value));
    return rows;
}

/// What does not depend on the samples.
Metadata pictureMetadata(const RenderCommand& command, const LoadedScene& loaded) {
    Metadata m;
    m["etendue:scene"] = command.scene.string();
    m["etendue:estimator"] = loaded.estimator.kind;
    m["worldToCamera"] = worldToCamera(*loaded.camera);
    if (loaded.fNumber > 0.0) {
        m["aperture"] = static_cast<float>(loaded.fNumber);
        m["focus"] = static_cast<float>(loaded.focusDistance);
    }
    return m;
}

Metadata metadataFor(const RenderCommand& command, const LoadedScene& loaded, const Film& film,
                     double seconds) {
    Metadata m = pictureMetadata(command, loaded);
    m["software"] = fmt::format("etendue {}", version);
    m["etendue:version"] = std::string(version);
    m["etendue:command"] = command.commandLine;
    m["etendue:sceneHash"] = loaded.hash;
    m["etendue:seed"] = std::to_string(command.seed);
    m["etendue:samples"] = static_cast<int>(film.samples());
    m["etendue:renderSeconds"] = static_cast<float>(seconds);
    return m;
}

/// What is wrong with the picture, said aloud: nothing is left out in silence.
void reportDefects(const RenderCommand& command, const Film& film, const RenderResult& result) {
    tellBadSamplesOfParts(film.badSamples() - result.badSampleCount);
    if (result.badSampleCount > 0) {
        say(fmt::format(
            "etendue: {} samples were not finite or negative and were left out; the first:\n",
            result.badSampleCount));
        for (const BadSample& b : result.badSamples)
            say(fmt::format("  seed {} pixel {},{} sample {} ({})\n", command.seed, b.x, b.y,
                            b.sample, b.technique == Technique{} ? "sum" : nameOf(b.technique)));
        say("  etendue replay shows how one came about, by the same scene, -s, --size and "
            "--camera\n");
    }
    if (result.refusedRays > 0)
        say(fmt::format("etendue: {} rays had no finite place in the scene and met nothing\n",
                        result.refusedRays));
}

void printNotes(const LoadedScene& loaded, bool isQuiet) {
    if (isQuiet) return;
    for (const std::string& note : loaded.notes) say(fmt::format("note: {}\n", note));
}

LoadOptions loadOptions(const RenderCommand& command, int threads) {
    LoadOptions options{command.overrides, threads, fitCacheDirectory()};
    options.camera = command.camera;
    options.samples = command.samples;
    if (!command.techniques.empty())
        options.overrides.push_back("estimator.techniques=" + command.techniques);
    if (!command.size.empty()) options.setSize(command.size[0], command.size[1]);
    return options;
}

/// Those of the film that the picture is to have.
std::vector<ExrChannels> channelsFor(const RenderCommand& command, const LoadedScene& loaded,
                                     const Film& film) {
    std::vector<ExrChannels> channels = film.channels();
    if (!isAskedFor(command, "variance") || hasVarianceOfColors(loaded))
        std::erase_if(channels,
                      [](const ExrChannels& c) { return c.names.front() == "variance.Y"; });
    return channels;
}

void writePictures(const RenderCommand& command, const LoadedScene& loaded, const Film& film,
                   const TechniqueImages& techniques, const Metadata& metadata) {
    const std::vector<ExrChannels> channels = channelsFor(command, loaded, film);
    if (!isPartFile(command.output)) writeExr(command.output, film.window(), channels, metadata);
    if (!command.techniqueImages.empty())
        writeExr(command.techniqueImages, film.window(), techniques.channels(film.samples()),
                 metadata);
    writePreview(command.preview, film.window(), channels.front().pixels);
}

std::vector<GivenFile> writtenFiles(const RenderCommand& command,
                                    const std::filesystem::path& partFile) {
    std::vector<GivenFile> files{{"-o", command.output},
                                 {"--preview", command.preview.file},
                                 {"--technique-images", command.techniqueImages}};
    if (partFile.empty()) return files;
    files.push_back({"a part file of -o", previousPart(partFile)});
    if (partFile != command.output) files.push_back({"a part file of -o", partFile});
    return files;
}

void checkFiles(const RenderCommand& command, const std::filesystem::path& partFile) {
    checkWritable(command.output, ".exr");
    checkWritable(command.preview.file, ".png");
    checkWritable(command.techniqueImages, ".exr");
    checkWritable(partFile, ".exr");
    checkDistinct(writtenFiles(command, partFile),
                  {{"the scene", command.scene}, {"--camera", command.camera}});
}

/// Nobody else may be writing it.
void makeWayFor(const RenderCommand& command, const std::filesystem::path& partFile) {
    if (partFile.empty()) return;
    sweepTemporaries(command.output);
    sweepTemporaries(partFile);
    if (!command.resumes && !command.restarts)
        refuseToReplacePart(partFile, "--resume goes on from them");
}

/// What cannot be had together.
void checkCombinations(const RenderCommand& command, const std::string& kind) {
    const auto refuse = [](const char* message) { throw InputError(message, ExitCode::usage); };
    if (command.techniqueImages.empty()) return;
    if (kind == "pt")
        refuse("--technique-images: the estimator is \"pt\", which has none; --estimator bdpt has");
    if (command.resumes)
        refuse(
            "--technique-images: a part file has no such images to go on from, as --resume asks");
}

/// The sums of which render a part belongs to.
PartInfo partInfoFor(const RenderCommand& command, const LoadedScene& loaded, const Film& film) {
    PartInfo info;
    info.window = film.window();
    info.layers = film.layers();
    info.color = film.color();
    std::string settings;
    for (const std::string& o : loadOptions(command, 1).overrides)
        settings += (settings.empty() ? "" : " ") + o;
    info.madeFrom = {{"program", fmt::format("etendue {}", version)},
                     {"settings", settings},
                     {"seed", std::to_string(command.seed)},
                     {"lens", loaded.lensModel},
                     {"lens_fit", loaded.fit ? loaded.fit->hash : "none"},
                     {"scene", loaded.hash}};
    info.picture = pictureMetadata(command, loaded);
    return info;
}

SampleRange wantedSamples(const RenderCommand& command, const LoadedScene& loaded) {
    if (command.range) return *command.range;
    const bool isOpenEnded = !command.samples && (command.timeLimitSeconds || command.errorLimit);
    return {0, isOpenEnded ? unlimitedSamples : static_cast<std::uint32_t>(loaded.samples)};
}

/// What to take from `first` on. One that was begun is finished though nobody wants it: without it
/// the picture would have more samples here than there.
SampleRange samplesLeft(SampleRange wanted, std::uint32_t first, const Film& film) {
    const std::uint32_t begun = film.state().unfinishedParts > 0 ? 1 : 0;
    return {first, std::max(wanted.end, first + begun)};
}

RenderSettings settingsFor(const RenderCommand& command, const LoadedScene& loaded,
                           SampleRange left, int threads) {
    RenderSettings settings;
    settings.firstSample = left.begin;
    settings.samples = left.size();
    settings.seed = command.seed;
    settings.sampler = loaded.sampler;
    settings.threads = threads;
    if (command.timeLimitSeconds) settings.timeLimitSeconds = *command.timeLimitSeconds;
    return settings;
}

/// Looks at the noise of the whole picture, and more rarely the more samples there are: each time
/// costs a small part of a sample of it.
class NoiseWatch {
public:
    explicit NoiseWatch(std::optional<double> limit) : limit_(limit) {}
    /// To be called between samples.
    bool isReached(const Film& film) {
        if (!limit_ || film.samples() < next_) return false;
        next_ = film.samples() + film.samples() / 8 + 1;
        noise_ = pictureNoise(film);
        return noise_.upperBound <= *limit_;
    }
    const PictureNoise& noise() const { return noise_; }

private:
    /// So few samples say too little of their spread.
    static constexpr std::uint64_t fewest = 8;
    std::optional<double> limit_;
    std::uint64_t next_ = fewest;
    PictureNoise noise_;
};

LoadedScene loadFor(const RenderCommand& command, int threads) {
    const bool isQuiet = command.progress == ProgressStyle::quiet;
    const bool showsFit = !isQuiet && command.progress != ProgressStyle::json;
    LoadOptions options = loadOptions(command, threads);
    LoadedScene loaded = showsFit ? loadShowingFit(command.scene, std::move(options))
                                  : loadScene(command.scene, options);
    printNotes(loaded, isQuiet);
    return loaded;
}

std::string noiseText(const PictureNoise& noise) {
    return fmt::format("noise {:.3g} % (at most {:.3g} %)", 100.0 * noise.relativeError,
                       100.0 * noise.upperBound);
}

/// What ended the render.
std::string endText(const RenderCommand& command, const Film& film, const RenderResult& result,
                    SampleRange wanted, const NoiseWatch& watch, bool isNoiseReached) {
    const std::uint64_t samples = film.samples();
    if (isNoiseReached)
        return fmt::format("--error {:g} is reached: {}, {} samples per pixel\n",
                           *command.errorLimit, noiseText(watch.noise()), samples);
    if (result.wasInterrupted)
        return fmt::format(
            "stopped early: {}{} samples per pixel are in the picture\n", samples,
            wanted.end == unlimitedSamples ? "" : fmt::format(" of {}", wanted.size()));
    if (samples < wanted.size())
        return fmt::format("--time {:g} is over: {} samples per pixel\n", *command.timeLimitSeconds,
                           samples);
    if (!command.errorLimit) return {};
    return fmt::format("all {} samples are taken before --error {:g} is reached\n", samples,
                       *command.errorLimit);
}

/// Why there still is a part.
std::string partText(const PartKeeper& keeper, const Film& film, SampleRange wanted, bool isEarly) {
    if (keeper.file().empty()) return {};
    const std::string part = keeper.file().string();
    if (isEarly) return fmt::format("the same command with --resume goes on from {}\n", part);
    if (film.samples() <= wanted.size()) return {};
    return fmt::format(
        "{}: is kept, since it holds {} samples per pixel, more than the {} asked for; the picture "
        "is of all of them\n",
        part, film.samples(), wanted.size());
}

}  // namespace

ExitCode runRender(const RenderCommand& command) {
    heedWriteRequests();  // before all else: one that comes early is to end nothing
    const std::filesystem::path partFile = keptPartOf(command.output);
    checkFiles(command, partFile);
    const OutputLock lock(lockedFor(command.output));
    makeWayFor(command, partFile);

    const int threads = command.threads.value_or(hardwareThreads());
    const LoadedScene loaded = loadFor(command, threads);
    checkCombinations(command, loaded.estimator.kind);
    Film film(windowFor(command, loaded.film), layersFor(command, loaded), loaded.film.color);
    const SampleRange wanted = wantedSamples(command, loaded);
    PartKeeper keeper(partFile, partInfoFor(command, loaded, film), wanted.begin,
                      command.checkpointSeconds);
    const std::uint32_t first = command.resumes ? keeper.resume(film) : wanted.begin;

    RenderSettings settings =
        settingsFor(command, loaded, samplesLeft(wanted, first, film), threads);
    TechniqueImages techniques(film.window(), film.color());
    if (!command.techniqueImages.empty()) settings.techniqueImages = &techniques;

    heedStopRequests();
    Progress progress(command.progress);
    RenderProgress last;  // of a part that has all the samples, nothing more comes
    last.samplesDone = last.samplesTarget = first - wanted.begin;
    NoiseWatch watch(command.errorLimit);
    bool isNoiseReached = false;
    const auto metadata = [&](double seconds) {
        return metadataFor(command, loaded, film, keeper.earlierSeconds() + seconds);
    };
    const auto onBatch = [&](const RenderProgress& p) {
        last = p;
        last.samplesDone += first - wanted.begin;
        last.samplesTarget += first - wanted.begin;
        progress.update(last);
        // Technique images know of whole samples alone.
        const bool canStop = p.isBetweenSamples || command.techniqueImages.empty();
        if (canStop && isStopRequested()) return false;
        if (canStop && keeper.isDue())
            keeper.writeCheckpoint(film, first + p.samplesDone, p.seconds, metadata(p.seconds));
        isNoiseReached = p.isBetweenSamples && watch.isReached(film);
        return !isNoiseReached;
    };
    const RenderResult result =
        render(*loaded.scene, *loaded.camera, *makeEstimator(loaded.estimator),
               Filter(loaded.film.filter, loaded.film.filterRadius), film, settings, onBatch);
    progress.finish(last);
    reportDefects(command, film, result);

    const bool isEarly = result.wasInterrupted && !isNoiseReached;
    const bool keepsPart = isEarly || command.keepsPart || isPartFile(command.output) ||
                           film.samples() > wanted.size();
    if (keepsPart)
        keeper.write(film, first + result.samples, result.seconds, metadata(result.seconds));
    writePictures(command, loaded, film, techniques, metadata(result.seconds));
    if (!keepsPart) keeper.remove();
    if (command.progress != ProgressStyle::quiet)
        say(endText(command, film, result, wanted, watch, isNoiseReached) +
            partText(keeper, film, wanted, isEarly));
    return isEarly ? ExitCode::stoppedEarly : ExitCode::success;
}

ExitCode runCheck(const CheckCommand& command) {
    LoadOptions options{command.overrides, hardwareThreads(), fitCacheDirectory()};
    options.camera = command.camera;
    const LoadedScene loaded = loadScene(command.scene, options);
    printNotes(loaded, false);
    const BoundingSphere bounds = loaded.scene->bounds();
    fmt::print("{}: valid\n", command.scene.string());
    fmt::print("  triangles  {}\n", loaded.scene->triangleCount());
    fmt::print("  lights     {}\n", loaded.scene->lights().size());
    fmt::print("  bounds     centre {:.4g} {:.4g} {:.4g} m, radius {:.4g} m\n", bounds.center.x,
               bounds.center.y, bounds.center.z, bounds.radius);
    fmt::print("  picture    {} × {}, {} samples per pixel, {} to depth {}\n", loaded.film.width,
               loaded.film.height, loaded.samples, loaded.estimator.kind,
               loaded.estimator.maxDepth);
    fmt::print("  hash       {}\n", loaded.hash);
    return ExitCode::success;
}

}  // namespace etendue
