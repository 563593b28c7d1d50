// Scenes and cameras by their names in a folder such as scenes/.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace etendue
