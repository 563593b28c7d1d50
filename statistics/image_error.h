// How far a picture is from its reference (docs/metrics.md).
#pragma once

#include <vector>

#include "statistics/picture_comparison.h"

namespace etendue {

/// Means over all pixels and channels of linear RGB; a of the picture, r of its reference.
struct ImageErrors {
    double mse = 0.0;            // (a − r)²
    double relMse = 0.0;         // (a − r)² / (r² + 0.01)
    double relMseTrimmed = 0.0;  // relMse of the pixels that the 0.1 % worst are left out of
    double mae = 0.0;            // |a − r|
    double meanError = 0.0;      // (mean a − mean r) / mean r, signed; see below
};

/// Both of the same size, of at least one pixel; otherwise std::invalid_argument. Against a black
/// reference the mean error is 0 if the picture is black, too, and else NaN: undefined.
ImageErrors imageErrors(const Picture& picture, const Picture& reference);

/// One value a pixel: the mean over its channels of (a − r)² / (r² + 0.01).
std::vector<float> relativeSquaredErrors(const Picture& picture, const Picture& reference);

/// Of the denominators r² + 0.01: keeps black pixels of the reference from deciding alone.
inline constexpr double relMseFloor = 0.01;

/// The mean of pictures that are independent and alike, and how far it can be trusted.
struct MeanPicture {
    Picture pixels;
    Picture variance;     // of each of its values: the square of its standard error
    double relMse = 0.0;  // expected of it, by its spread
};
/// Of at least two.
MeanPicture meanPicture(const std::vector<Picture>& independent);

/// bias², without the noise that every other error of a noisy picture keeps: the mean of
/// (a₁ − r₁)(a₂ − r₂), whose expectation is that of (mean a − mean r)² where all four pictures are
/// independent. It may come out negative.
double biasSquared(const Picture& picture1, const Picture& picture2, const Picture& reference1,
                   const Picture& reference2);

/// Half of the 99 % interval of ImageErrors::meanError, from what is known of each pixel: the
/// variance of its mean in each channel, empty for a picture without noise. The channels of a pixel
/// are taken to vary together, which at worst makes the interval √3 times too wide. NaN where the
/// mean error is.
double meanErrorHalfWidth(const Picture& picture, const Picture& reference,
                          const Picture& pictureVariance, const Picture& referenceVariance);
/// The same from the scatter of the differences among pixels: as if their differences were nothing
/// but noise, independent and of one spread. NaN where the mean error is, and for fewer than two
/// pixels.
double meanErrorHalfWidthByScatter(const Picture& picture, const Picture& reference);

}  // namespace etendue
