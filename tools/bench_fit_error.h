// What a lens' fit alone does to the picture, free of noise.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "renderer/scene_loader.h"
#include "statistics/bootstrap.h"

namespace etendue {

/// relMSE of pictures through a fitted lens against those through its exact trace, and its interval
/// of 95 %. An estimate that may come out negative: then it is not to be told from zero.
struct FitImageError {
    double relMse = 0.0;
    Interval interval;
};

struct FitErrorSettings {
    int seeds = 8;              // at least three
    std::uint32_t samples = 4;  // per pixel of each picture
    int threads = 1;
};

/// `pt` through both lenses with the same random numbers, once for each seed: most of the noise
/// cancels in the difference d of the two. What differences of two seeds i and j share is the fit's
/// doing, so that the mean over pixels and pairs i ≠ j of d_i d_j / (r² + 0.01) has no noise in the
/// mean. `goOn` returns false to give up; then the result is empty.
std::optional<FitImageError> fitImageError(const LoadedScene& traced, const LoadedScene& fitted,
                                           const FitErrorSettings& settings,
                                           const std::function<bool()>& goOn);

}  // namespace etendue
