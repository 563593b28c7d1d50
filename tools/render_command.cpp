#include "tools/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "lens/fit_cache.h"
#include "renderer/parallel.h"
#include "renderer/render.h"
#include "renderer/scene_loader.h"
#include "renderer/srgb.h"
#include "tools/stop_request.h"
#include "tools/version.h"

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

FilmLayers layersFor(const RenderCommand& command) {
    const auto has = [&](const char* name) {
        return std::find(command.layers.begin(), command.layers.end(), name) !=
               command.layers.end();
    };
    FilmLayers layers;
    layers.albedo = has("albedo");
    layers.normal = has("normal");
    layers.depth = has("depth");
    layers.position = has("position");
    layers.variance = has("variance");
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

Metadata metadataFor(const RenderCommand& command, const LoadedScene& loaded,
                     const RenderResult& result) {
    Metadata m;
    m["software"] = fmt::format("etendue {}", version);
    m["etendue:version"] = std::string(version);
    m["etendue:command"] = command.commandLine;
    m["etendue:scene"] = command.scene.string();
    m["etendue:sceneHash"] = loaded.hash;
    m["etendue:estimator"] = loaded.estimator.kind;
    m["etendue:seed"] = std::to_string(command.seed);
    m["etendue:samples"] = static_cast<int>(result.samples);
    m["etendue:renderSeconds"] = static_cast<float>(result.seconds);
    m["worldToCamera"] = worldToCamera(*loaded.camera);
    if (loaded.fNumber > 0.0) {
        m["aperture"] = static_cast<float>(loaded.fNumber);
        m["focus"] = static_cast<float>(loaded.focusDistance);
    }
    return m;
}

/// What is wrong with the picture, said aloud: nothing is left out in silence.
void reportDefects(const RenderCommand& command, const RenderResult& result) {
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
    if (!command.size.empty()) {
        options.overrides.push_back(fmt::format("film.width={}", command.size[0]));
        options.overrides.push_back(fmt::format("film.height={}", command.size[1]));
    }
    return options;
}

void writePictures(const RenderCommand& command, const LoadedScene& loaded, const Film& film,
                   const TechniqueImages& techniques, const RenderResult& result) {
    const std::vector<ExrChannels> channels = film.channels();
    const Metadata metadata = metadataFor(command, loaded, result);
    writeExr(command.output, film.window(), channels, metadata);
    if (!command.techniqueImages.empty())
        writeExr(command.techniqueImages, film.window(),
                 techniques.channels(film.samples(), film.state().lightPaths), metadata);
    if (!command.preview.empty())
        writePng(
            command.preview, film.window().width, film.window().height,
            srgbBytes(channels.front().pixels, static_cast<float>(command.previewExposureStops)));
}

/// A picture's format does not follow its name; a name that promises another one would mislead.
void checkExtension(const std::filesystem::path& file, const std::string& expected) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!extension.empty() && extension != expected)
        throw InputError(
            fmt::format("{}: this picture is written as {}", file.string(), expected.substr(1)),
            ExitCode::usage);
}

/// Better now than after hours of rendering.
void checkWritable(const std::filesystem::path& file, const std::string& extension) {
    if (file.empty()) return;
    checkExtension(file, extension);
    std::filesystem::path folder = file.parent_path();
    if (folder.empty()) folder = ".";
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        throw InputError(fmt::format("{}: no such folder", folder.string()), ExitCode::missingFile);
    if (std::filesystem::is_directory(file, error))
        throw InputError(fmt::format("{}: is a folder, not a file to write", file.string()));
}

/// What only some estimators can give.
void checkEstimator(const RenderCommand& command, const std::string& kind) {
    if (kind == "pt" && !command.techniqueImages.empty())
        throw InputError(
            "--technique-images: the estimator is \"pt\", which has none; -s estimator.kind=bdpt "
            "has",
            ExitCode::usage);
    if (kind != "pt" && layersFor(command).variance)
        throw InputError(
            "--layers variance: light paths fall all over the picture, and their spread within a "
            "pixel is not recorded; -s estimator.kind=pt has it",
            ExitCode::usage);
}

}  // namespace

ExitCode runRender(const RenderCommand& command) {
    const bool isQuiet = command.progress == ProgressStyle::quiet;
    checkWritable(command.output, ".exr");
    checkWritable(command.preview, ".png");
    checkWritable(command.techniqueImages, ".exr");
    const int threads = command.threads.value_or(hardwareThreads());
    LoadOptions options = loadOptions(command, threads);
    FitBar fitBar;
    if (!isQuiet && command.progress != ProgressStyle::json)
        options.fitProgress = [&](double share, std::string_view stage) {
            fitBar.update(share, stage);
        };
    const LoadedScene loaded = loadScene(command.scene, options);
    fitBar.clear();
    printNotes(loaded, isQuiet);

    Film film(windowFor(command, loaded.film), layersFor(command), loaded.film.color);
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    const std::unique_ptr<Estimator> estimator = makeEstimator(loaded.estimator);
    RenderSettings settings;
    const bool isTimed = command.timeLimitSeconds && !command.samples;
    settings.samples = isTimed ? unlimitedSamples : static_cast<std::uint32_t>(loaded.samples);
    settings.seed = command.seed;
    settings.sampler = loaded.sampler;
    settings.threads = threads;
    if (command.timeLimitSeconds) settings.timeLimitSeconds = *command.timeLimitSeconds;
    checkEstimator(command, loaded.estimator.kind);
    TechniqueImages techniques(film.window(), film.color());
    if (!command.techniqueImages.empty()) settings.techniqueImages = &techniques;

    heedStopRequests();
    Progress progress(command.progress);
    RenderProgress last;
    const RenderResult result = render(*loaded.scene, *loaded.camera, *estimator, filter, film,
                                       settings, [&](const RenderProgress& p) {
                                           last = p;
                                           progress.update(p);
                                           return !isStopRequested();
                                       });
    progress.finish(last);
    reportDefects(command, result);
    writePictures(command, loaded, film, techniques, result);
    if (result.wasInterrupted && !isQuiet)
        say(fmt::format("stopped early: {} of {} samples per pixel are in the picture\n",
                        result.samples, settings.samples));
    return result.wasInterrupted ? ExitCode::stoppedEarly : ExitCode::success;
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
