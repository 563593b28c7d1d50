// What the parts of render_bench share: renders of a scene, and medians.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "lens/fit_cache.h"
#include "renderer/render.h"
#include "renderer/scene_loader.h"

namespace etendue {

inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// Embree works on no more than `threads` threads from then on, in all of the process.
inline LoadedScene loadForBench(const std::filesystem::path& file, int width, int height,
                                std::vector<std::string> overrides = {}, int threads = 2) {
    overrides.push_back("film.width=" + std::to_string(width));
    overrides.push_back("film.height=" + std::to_string(height));
    return loadScene(file, {std::move(overrides), threads, fitCacheDirectory()});
}

inline Filter filterOf(const LoadedScene& loaded) {
    return Filter(loaded.film.filter, loaded.film.filterRadius);
}

inline RenderResult renderForBench(const LoadedScene& loaded, const std::string& kind,
                                   std::uint32_t samples, int threads) {
    Film film(loaded.film.fullFrame(), {}, loaded.film.color);
    RenderSettings settings;
    settings.samples = samples;
    settings.threads = threads;
    settings.sampler = loaded.sampler;
    EstimatorSettings estimator = loaded.estimator;
    estimator.kind = kind;
    return render(*loaded.scene, *loaded.camera, *makeEstimator(estimator), filterOf(loaded), film,
                  settings, {});
}

/// The parts of render_bench; each prints a table. `project` is the project's folder, `wanted` a
/// scene's name or empty for all.
void benchEmbreeShare(const std::filesystem::path& project, const std::string& wanted);
void benchVertices(const std::filesystem::path& project, const std::string& wanted);
void benchSplats(const std::filesystem::path& project, const std::string& wanted);
void benchMemory(const std::filesystem::path& project, const std::string& wanted);

}  // namespace etendue
