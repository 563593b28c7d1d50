// What a lens' fit alone does to the picture, free of noise.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "renderer/scene_loader.h"
#include "statistics/bootstrap.h"
#include "statistics/picture_comparison.h"

namespace etendue {

/// relMSE of pictures through a fitted lens against those through its exact trace, and its interval
/// of 95 %. An estimate that may come out negative: then it is not to be told from zero.
struct FitImageError {
    double relMse = 0.0;
    Interval interval;
    double noiseOfOneSample = 0.0;  // trimmed relMSE of `pt` with one sample per pixel, by the
                                    // spread of the exact pictures
};

struct FitErrorSettings {
    int seeds = 6;              // at least three
    std::uint32_t samples = 2;  // per pixel of each picture
    int threads = 1;
};

/// `pt` pictures through the scene's camera, one for each seed; empty when `goOn` returned false.
std::optional<std::vector<Picture>> fitErrorPictures(const LoadedScene& loaded,
                                                     const FitErrorSettings& settings,
                                                     const std::function<bool()>& goOn);

/// Of such pictures through the exact trace and through the fit, with the same settings and hence
/// the same random numbers: most of the noise cancels in the difference d of two with one seed.
/// What differences of two seeds i and j share is the fit's doing, so that the mean over pixels and
/// pairs i ≠ j of d_i d_j / (r² + 0.01) has no noise in the mean; r is the mean of `exact`. The
/// 0.1 % of values that differ most are left out, as in relMseTrimmed.
FitImageError fitImageError(const std::vector<Picture>& exact, const std::vector<Picture>& fitted,
                            const FitErrorSettings& settings);

}  // namespace etendue
