// References of regression tests: one small file for each scene and camera. docs/regression.md.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene_loader.h"
#include "statistics/picture_comparison.h"
#include "tools/path_classes.h"

namespace etendue {

/// What pictures of one estimator are held against.
struct ReferencePicture {
    std::string estimator;  // that is held against it: pt, lt or bdpt
    std::string by;         // that made it
    /// Whether the estimator meets some of its paths only by chance: they are left out of what it
    /// renders.
    bool leavesOut = false;
    std::uint32_t samples = 0;               // per pixel of each batch
    double largest = 0.0;                    // that a sample brought to a pixel, in any colour
    double noise = 0.0;                      // relMSE of `pixels` itself, expected
    std::vector<std::vector<double>> means;  // [batch][region], see PictureRegions
    Picture pixels;                          // mean of the batches
};

struct RegressReference {
    std::string scene, camera;
    std::string sceneHash;  // LoadedScene::hash
    int width = 0, height = 0;
    std::vector<ReferencePicture> pictures;

    const ReferencePicture* of(std::string_view estimator) const;
};

/// "DIR/cornell-box.pinhole.toml".
std::filesystem::path referenceFile(const std::filesystem::path& folder, const std::string& scene,
                                    const std::string& camera);

/// Throws InputError: not there, not TOML, of another scene, camera or size than it says, or
/// changed since it was written.
RegressReference readReference(const std::filesystem::path& file);
std::string referenceText(const RegressReference& reference);

struct RegressReferenceSettings {
    int batches = 16;
    std::uint32_t samples = 64;  // per pixel of each
    std::uint64_t firstSeed = 1u << 20;
    int tileSize = 16;  // pixels
    int threads = 1;
};

/// Renders the references of pt, lt and bdpt; empty when `goOn` has said false. `scene` and
/// `camera` stay empty.
std::optional<RegressReference> makeReference(const LoadedScene& loaded,
                                              const RegressReferenceSettings& settings,
                                              const std::function<bool()>& goOn);

/// What an estimator renders when it is held against its reference.
CommonPathsSettings testedPaths(const EstimatorSettings& scene, const std::string& estimator,
                                bool leavesOut);

}  // namespace etendue
