#include "statistics/picture_comparison.h"

#include <algorithm>

#include "statistics/statistics.h"
#include "statistics/tiles.h"

namespace etendue {

namespace {

std::vector<double> meansIn(const Tile& tile, const std::vector<Picture>& pictures, int width) {
    std::vector<double> means;
    for (const Picture& picture : pictures)
        means.push_back(sumIn(tile, picture, width) / tile.pixels());
    return means;
}

}  // namespace

std::vector<double> meansOf(const std::vector<Picture>& pictures) {
    std::vector<double> means;
    for (const Picture& p : pictures) {
        double sum = 0.0;
        for (const float v : p) sum += static_cast<double>(v);
        means.push_back(sum / static_cast<double>(p.size()));
    }
    return means;
}

double welchP(std::span<const double> a, std::span<const double> b, int /*pixels*/) {
    return welchTest(a, b).pValue;
}

PictureComparison comparePictures(const std::vector<Picture>& a, const std::vector<Picture>& b,
                                  int width, int tileSize, std::size_t comparisons,
                                  const TestOfMeans& pOf) {
    const int pixels = static_cast<int>(a.front().size() / 3);
    const std::vector<Tile> tiles = tilesOf(width, pixels / width, tileSize);
    const std::vector<double> wholeA = meansOf(a), wholeB = meansOf(b);
    PictureComparison result;
    result.level = sidakLevel(0.01, (tiles.size() + 1) * comparisons);
    result.smallestP = pOf(wholeA, wholeB, pixels);
    for (const Tile& tile : tiles)
        result.smallestP = std::min(
            result.smallestP, pOf(meansIn(tile, a, width), meansIn(tile, b, width), tile.pixels()));
    const WelchResult whole = welchTest(wholeA, wholeB);
    const double mean = summarize(wholeB).mean;
    result.relativeBias = whole.difference / mean;
    if (whole.standardError > 0.0)
        result.relativeBiasHalfWidth =
            studentQuantile(0.99, whole.degreesOfFreedom) * whole.standardError / mean;
    return result;
}

}  // namespace etendue
