// How noisy a picture still is, estimated from its own samples.
#pragma once

#include "renderer/film.h"

namespace etendue {

/// The root of the mean, over all pixels, of the variance of a pixel's luminance over its squared
/// luminance: 0.02 is a noise of two per cent. A hundredth of the picture's mean luminance squared
/// is added below, so that black pixels do not count for everything (relMSE's floor, of a picture
/// whose mean is 1: docs/metrics.md).
struct PictureNoise {
    double relativeError = 0.0;
    /// As large as it may be, by the spread of tiles of the picture: of 40 such bounds 39 lie above
    /// the error to be expected. Light that no sample has found yet is in neither.
    double upperBound = 0.0;
};

/// Needs FilmLayers::luminanceVariance and two samples at least; before, both are infinite.
PictureNoise pictureNoise(const Film& film);

}  // namespace etendue
