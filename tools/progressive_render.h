// A render that is looked at on its way.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene_loader.h"
#include "statistics/picture_comparison.h"
#include "tools/bench_records.h"

namespace etendue {

struct ProgressiveSettings {
    std::string estimator;
    double seconds = 1.0;  // of rendering, about
    std::uint32_t mostSamples = 1u << 20;
    std::uint64_t seed = 0;
    int threads = 1;
};

struct ProgressiveRender {
    std::vector<BenchCheckpoint> checkpoints;  // after 1, 2, 4 … samples, and at the end
    Picture picture;
    double flip = 0.0;  // mean HDR-FLIP of the picture
    std::uint64_t badSamples = 0;
};

/// Until the time is over or the count is reached; looking at it is not timed. `goOn` hears which
/// share of the time is over and returns false to give up; then the result is empty.
std::optional<ProgressiveRender> renderProgressively(const LoadedScene& loaded,
                                                     const ProgressiveSettings& settings,
                                                     const Picture& reference,
                                                     const std::function<bool(double)>& goOn);

}  // namespace etendue
