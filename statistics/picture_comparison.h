// Two sets of pictures that ought to have one mean, judged by statistics.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace etendue {

/// Linear RGB, three floats a pixel, row by row.
using Picture = std::vector<float>;

/// Welch's t-test of the means over seeds (Jung, Hanika and Dachsbacher 2020), per tile and colour
/// and of the whole picture, corrected for the number of tests; and the bias of the whole picture
/// with its confidence interval.
struct PictureComparison {
    double smallestP = 1.0;     // over the tiles and the whole; to be compared with `level`
    double level = 0.0;         // per test, Šidák-corrected from 0.01 overall
    double relativeBias = 0.0;  // (mean a − mean b) / mean b
    double relativeBiasHalfWidth = 0.0;  // of its 99 % confidence interval
    bool agree() const { return smallestP > level; }
    /// The bias is below `bound` with 99 % confidence: agreement that noise cannot fake.
    bool isEquivalent(double bound) const {
        return std::abs(relativeBias) + relativeBiasHalfWidth < bound;
    }
};

/// Two-sided p of equal means, each the mean of `pixels` pixels of one picture.
using TestOfMeans =
    std::function<double(std::span<const double> a, std::span<const double> b, int pixels)>;
/// By Welch's t.
double welchP(std::span<const double> a, std::span<const double> b, int pixels);

/// Each picture of `a` and `b` was rendered with a seed of its own; at least two of either.
/// `width`, `tileSize` in pixels. `comparisons`: how many such comparisons share the chance of 1 %
/// of any false alarm.
PictureComparison comparePictures(const std::vector<Picture>& a, const std::vector<Picture>& b,
                                  int width, int tileSize, std::size_t comparisons = 1,
                                  const TestOfMeans& pOf = welchP);

/// Mean brightness of each picture.
std::vector<double> meansOf(const std::vector<Picture>& pictures);

}  // namespace etendue
