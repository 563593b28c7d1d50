// Welch's t-test of pictures' tiles, guarded against light that one side has not met at all.
// docs/agreement.md explains it.
#pragma once

#include <span>

#include "statistics/picture_comparison.h"
#include "statistics/statistics.h"

namespace etendue {

/// One side's samples, which all of its pictures have taken together.
struct SampleSizes {
    double samplesPerPixel = 1.0;
    double largest = 0.0;  // that any of them brought to a pixel, in any colour
};

struct Judgement {
    PictureComparison comparison;
    /// Tests that Welch's t alone would have rejected, while the darker side may as well have
    /// missed a few of its brightest samples.
    std::size_t testsInDoubt = 0;
};

/// Two-sided p of equal means when the darker side may have missed samples that bring `step` to its
/// mean each: Welch's t with the variance that those have if the means are equal, added to what was
/// seen. Never below Welch's own.
double guardedP(const WelchResult& welch, double step);
/// The same of two sides, whose brightest samples bring so much to their means.
double guardedP(std::span<const double> a, std::span<const double> b, double largestStepOfA,
                double largestStepOfB);

/// As comparePictures, by guarded tests.
Judgement judgePictures(const std::vector<Picture>& a, const std::vector<Picture>& b,
                        SampleSizes sizesOfA, SampleSizes sizesOfB, int width, int tileSize,
                        std::size_t comparisons);

}  // namespace etendue
