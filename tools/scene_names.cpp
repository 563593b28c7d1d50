#include "tools/scene_names.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/config.h"
#include "lens/fit_cache.h"

namespace etendue {

namespace {

std::vector<std::string> cameraNamesIn(const std::filesystem::path& folder) {
    std::vector<std::string> names{"own"};
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "cameras", error))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    return names;
}

[[noreturn]] void failUnknown(const std::string& kind, const std::string& name,
                              const std::filesystem::path& folder,
                              const std::vector<std::string>& known) {
    std::string message = fmt::format("no {} \"{}\" in {}", kind, name, folder.string());
    if (const auto nearest = nearestName(name, known))
        message += fmt::format("; did you mean \"{}\"?", *nearest);
    throw InputError(message, ExitCode::missingFile);
}

bool isFile(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
}

}  // namespace

std::vector<std::string> sceneNamesIn(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (std::filesystem::exists(entry.path() / "scene.toml"))
            names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

NamedFile sceneCalled(const std::string& name, const std::filesystem::path& folder) {
    const std::filesystem::path path = name;
    if (isFile(path))
        return {path.filename() == "scene.toml" && path.has_parent_path()
                    ? path.parent_path().filename().string()
                    : path.stem().string(),
                path};
    const std::filesystem::path file = folder / path / "scene.toml";
    if (!isFile(file)) failUnknown("scene", name, folder, sceneNamesIn(folder));
    return {name, file};
}

NamedFile cameraCalled(const std::string& name, const std::filesystem::path& folder) {
    constexpr std::string_view suffix = "+dispersion";
    if (name.ends_with(suffix)) {
        NamedFile camera = cameraCalled(name.substr(0, name.size() - suffix.size()), folder);
        return {name, camera.file, true};
    }
    if (name == "own") return {name, {}};
    const std::filesystem::path path = name;
    if (isFile(path)) return {path.stem().string(), path};
    const std::filesystem::path file = folder / "cameras" / (name + ".toml");
    if (!isFile(file)) failUnknown("camera", name, folder / "cameras", cameraNamesIn(folder));
    return {name, file};
}

std::vector<NamedFile> scenesCalled(const std::vector<std::string>& names,
                                    const std::filesystem::path& folder) {
    const std::vector<std::string> wanted = names.empty() ? sceneNamesIn(folder) : names;
    if (wanted.empty())
        throw InputError(fmt::format("{}: no folder in it has a scene.toml; --scenes names another",
                                     folder.string()),
                         ExitCode::missingFile);
    std::vector<NamedFile> scenes;
    for (const std::string& name : wanted) scenes.push_back(sceneCalled(name, folder));
    return scenes;
}

std::string titleOf(const NamedFile& scene, const NamedFile& camera) {
    return fmt::format("{}, {}", scene.name, camera.name);
}

LoadedScene loadShowingFit(const std::filesystem::path& scene, LoadOptions options) {
    FitBar bar;
    options.fitProgress = [&](double share, std::string_view stage) { bar.update(share, stage); };
    LoadedScene loaded = loadScene(scene, options);
    bar.clear();
    return loaded;
}

bool isEstimatorKindSet(const std::vector<std::string>& overrides) {
    Config config;
    for (const std::string& assignment : overrides) config.set(assignment);
    const ConfigTable root = config.root();
    return root.has("estimator") && root.table("estimator").has("kind");
}

LoadedScene loadView(const NamedFile& scene, const NamedFile& camera, const ViewOptions& view,
                     JobBar& bar) {
    LoadOptions options;
    options.overrides = view.overrides;
    options.setSize(view.width, view.height);
    options.threads = view.threads;
    options.fitCache = fitCacheDirectory();
    options.fitProgress = [&](double, std::string_view stage) {
        bar.update(fmt::format("{}: {}", titleOf(scene, camera), stage), 0.0);
    };
    options.camera = camera.file;
    options.disperses = camera.isDispersive || (camera.file.empty() && view.ownCameraDisperses);
    return loadScene(scene.file, options);
}

}  // namespace etendue
