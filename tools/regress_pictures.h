// Pictures of many seeds at rising counts of samples: what regression tests judge.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "renderer/render.h"
#include "renderer/scene_loader.h"
#include "statistics/picture_comparison.h"
#include "tools/path_classes.h"

namespace etendue {

struct SeedSettings {
    std::vector<std::uint32_t> checkpoints{1};  // samples per pixel, rising
    int seeds = 32;
    std::uint64_t firstSeed = 0;
    Sampler sampler = Sampler::independent;
    int threads = 1;
};

struct SeedPictures {
    std::vector<std::vector<Picture>> pictures;  // [checkpoint][seed]
    double largest = 0.0;                        // see SampleSizes
    LeftOutMeans leftOut{};                      // mean over the seeds, at the last checkpoint
    std::uint64_t badSamples = 0;
    double seconds = 0.0;  // until all were there
};

/// One progressive render for each seed. `goOn`: asked from any thread, one at a time; when it says
/// false the result is empty. The same bits for any number of threads.
std::optional<SeedPictures> renderSeeds(const LoadedScene& loaded, const CommonPathsSettings& paths,
                                        const SeedSettings& settings,
                                        const std::function<bool()>& goOn);

/// Parts of a picture whose means are tested: each tile in R, in G and in B, then all of it.
struct PictureRegions {
    int width = 0, height = 0, tileSize = 16;  // pixels

    std::size_t count() const;
    /// How many pixels each has.
    std::vector<int> pixels() const;
    std::vector<double> meansOf(const Picture& picture) const;
};

}  // namespace etendue
