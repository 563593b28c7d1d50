// References: pictures that count as the truth, rendered once and kept.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "renderer/scene_loader.h"
#include "statistics/image_error.h"

namespace etendue {

struct BenchReferenceSettings {
    std::string estimator = "bdpt";
    double seconds = 60.0;  // of rendering, about
    int threads = 1;
};

struct Reference {
    MeanPicture mean;
    std::uint64_t samples = 0;  // per pixel
    double seconds = 0.0;
    std::string key;  // hash of scene, settings and program
};

/// $XDG_CACHE_HOME/etendue/references, or ~/.cache/…; empty when the environment names neither.
std::filesystem::path referenceCacheDirectory();

/// From `directory`, else a new one, which is then kept there. It is the mean of 16 independent
/// pictures of equal counts, whose spread tells its error; they get further samples until the time
/// is over, but never by how they look. `goOn` hears which share is done and returns false to give
/// up; then the result is empty. Its seeds are none that a benchmark uses. `notice` hears in a
/// sentence what went wrong in `directory`: a reference that could not be read, or not be kept.
std::optional<Reference> referenceFor(const LoadedScene& loaded,
                                      const BenchReferenceSettings& settings,
                                      const std::filesystem::path& directory,
                                      const std::function<bool(double)>& goOn,
                                      const std::function<void(const std::string&)>& notice = {});

}  // namespace etendue
