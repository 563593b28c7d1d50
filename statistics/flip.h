// FLIP: how different two pictures look to somebody who flips between them.
#pragma once

#include <vector>

#include "statistics/picture_comparison.h"

namespace etendue {

/// Of a display 0.7 m wide with 3840 pixels a row, seen from 0.7 m: the paper's own, 67.02.
double flipPixelsPerDegree();

/// HDR-FLIP's exposures, in stops: `count` of them, evenly from `start` to `stop`.
struct FlipExposures {
    double start = 0.0, stop = 0.0;
    int count = 2;
};
/// From `start`, where the brightest pixel of the reference is mapped to 0.85 by the tone curve, to
/// `stop`, where that of median luminance is (of those not black, where the median is black).
/// Negative colours count as black, of which a whole picture has one exposure, 0.
FlipExposures flipExposures(const Picture& reference);
/// Narkowicz's fit of the ACES curve, without its exposure; from [0, ∞) to [0, 1].
double acesToneCurve(double x);

/// LDR-FLIP (Andersson et al. 2020) of each pixel, in [0, 1]: 0 where nobody sees a difference.
/// Linear RGB in [0, 1], as displayed.
std::vector<float> ldrFlip(const Picture& picture, const Picture& reference, int width,
                           double pixelsPerDegree = flipPixelsPerDegree());

/// HDR-FLIP (Andersson, Nilsson, Shirley and Akenine-Möller 2021) of each pixel: the greatest
/// LDR-FLIP over the exposures. Linear RGB; std::invalid_argument for pictures of two sizes.
std::vector<float> hdrFlip(const Picture& picture, const Picture& reference, int width,
                           double pixelsPerDegree = flipPixelsPerDegree());
/// The HDR-FLIP of a picture: the mean of its pixels'.
double meanHdrFlip(const Picture& picture, const Picture& reference, int width);

}  // namespace etendue
