// Scenes and cameras by their names in a folder such as scenes/, and one through the other.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/scene_loader.h"
#include "tools/progress.h"

namespace etendue {

/// What was asked for by a name, and where it lies.
struct NamedFile {
    std::string name;
    std::filesystem::path file;  // empty: the scene's own camera
    bool isDispersive = false;   // "+dispersion" was appended to a camera's name
};

/// Of the folders in `folder` that have a scene.toml, sorted.
std::vector<std::string> sceneNamesIn(const std::filesystem::path& folder);

/// `name`: a file, or a folder's name in `folder`. Throws InputError (missingFile) with the nearest
/// name there is.
NamedFile sceneCalled(const std::string& name, const std::filesystem::path& folder);
/// All of `names`, or of the folder if there are none.
std::vector<NamedFile> scenesCalled(const std::vector<std::string>& names,
                                    const std::filesystem::path& folder);

/// `name`: a file, a file's name in `folder`/cameras, or "own": the scene's. Likewise.
NamedFile cameraCalled(const std::string& name, const std::filesystem::path& folder);

/// "cornell-box, thin-lens".
std::string titleOf(const NamedFile& scene, const NamedFile& camera);

/// Loads it; a lens that must be fitted shows how far that is.
LoadedScene loadShowingFit(const std::filesystem::path& scene, LoadOptions options);

/// How a scene is looked at by commands that measure: at their own size, with dispersion only where
/// the camera's name asks for it.
struct ViewOptions {
    std::vector<std::string> overrides;
    int width = 0, height = 0;
    int threads = 1;
    bool ownCameraDisperses = false;  // where the scene's own camera does not say
};
/// Whether they set estimator.kind, which does nothing where a command names the estimators itself.
bool isEstimatorKindSet(const std::vector<std::string>& overrides);
/// Loads it; a lens that must be fitted tells the bar how far that is.
LoadedScene loadView(const NamedFile& scene, const NamedFile& camera, const ViewOptions& options,
                     JobBar& bar);

}  // namespace etendue
