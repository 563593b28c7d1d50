// The steps of loadScene, one per table of the scene file. Private to the loader.
#pragma once

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/config.h"
#include "renderer/obj_loader.h"
#include "renderer/scene_loader.h"

namespace etendue {

/// What an image says. Shares of light lie in [0, 1].
enum class TextureUse { reflectance, opacity, radiance };

/// What loading gathers on its way.
struct LoadingScene {
    SceneParts parts;
    std::vector<std::string> notes;
    std::vector<std::filesystem::path> files;          // every file read, for the hash
    std::map<std::string, const Material*> materials;  // the scene file's own, by name
    std::map<std::pair<std::filesystem::path, TextureUse>, std::shared_ptr<const Texture>> textures;
    const Material* defaultMaterial = nullptr;
    bool isDispersive = false;  // some material is
};

/// Runs `setting`, which may find that it cannot follow `key`.
template <class Setting>
auto attempt(const ConfigTable& table, std::string_view key, const Setting& setting) {
    try {
        return setting();
    } catch (const std::invalid_argument& error) {
        table.fail(key, error.what());
    }
}

/// [camera]. The scene must exist: it may be focused on.
void loadCamera(const ConfigTable& table, const LoadOptions& options, LoadingScene& loading,
                LoadedScene& loaded);
/// Lens axes in the world: +z toward `to`, +y up as far as it can be, +x to the viewer's left
/// (docs/camera.md, "Which way is up"). A table with neither `from` nor `to` stands where a lens of
/// these focal lengths (along x and y), without distortion and focused at infinity, sees the whole
/// scene.
Transform placeCamera(const ConfigTable& table, const Eigen::Vector2d& focalMm,
                      const CameraSettings& frame, const Scene& scene);

/// [camera] lens = …; places the camera, and sets its outer pupil if the estimator asks for it.
std::shared_ptr<const LensModel> loadLens(const ConfigTable& table, CameraSettings& camera,
                                          const LoadOptions& options, LoadingScene& loading,
                                          LoadedScene& loaded);

/// [[material]]
void loadMaterials(const std::vector<ConfigTable>& tables, LoadingScene& loading);
/// The material that `name` means in the scene file. Throws at `key` of `table` if there is none.
const Material* findMaterial(const ConfigTable& table, const std::string& key,
                             const LoadingScene& loading);
/// What an MTL entry means here; docs/scene-format.md has the table.
const Material* addObjMaterial(const ObjMaterial& material, LoadingScene& loading);
/// The grey of everything that names no material.
const Material* defaultMaterial(LoadingScene& loading);
/// Throws InputError as readImage does, and for a share that is none: a float image may hold any.
std::shared_ptr<const Texture> loadTexture(const std::filesystem::path& file, TextureUse use,
                                           LoadingScene& loading);
/// Of the file that the key names.
inline std::shared_ptr<const Texture> loadTexture(const ConfigTable& table, std::string_view key,
                                                  TextureUse use, LoadingScene& loading) {
    return table.readFile(
        key, [&](const std::filesystem::path& file) { return loadTexture(file, use, loading); });
}
Spectrum color(const ConfigTable& table, std::string_view key, Range range);

/// [[mesh]] and [[instance]]
void loadMeshes(const std::vector<ConfigTable>& meshes, const std::vector<ConfigTable>& instances,
                LoadingScene& loading);
/// A model with the materials of its MTL, where no scene file says otherwise. Returns its index.
void addModel(const std::filesystem::path& file, LoadingScene& loading);
/// transform = [ {scale = …}, {rotate = […]}, {translate = […]} ], the first one applied first.
Transform loadTransform(const ConfigTable& table, std::string_view key);

/// [[light]]
void loadLights(const std::vector<ConfigTable>& tables, LoadingScene& loading);

Vec3d vector3(const ConfigTable& table, std::string_view key, Range range = Range::any());

/// What may stand in a scene stands within this, m: floats and Embree can handle it, and what is
/// added to it on the way.
inline constexpr double farthestPlace = 1e15;
inline Vec3d place(const ConfigTable& table, std::string_view key) {
    return vector3(table, key, {-farthestPlace, farthestPlace});
}

}  // namespace etendue
