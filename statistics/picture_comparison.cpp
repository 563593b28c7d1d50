#include "statistics/picture_comparison.h"

#include <algorithm>

#include "statistics/statistics.h"

namespace etendue {

namespace {

/// Part of a picture, in one colour.
struct Tile {
    int x0, y0, x1, y1;
    std::size_t color;
    int pixels() const { return (x1 - x0) * (y1 - y0); }
};

std::vector<Tile> tilesOf(int width, int height, int tileSize) {
    std::vector<Tile> tiles;
    for (int y = 0; y < height; y += tileSize)
        for (int x = 0; x < width; x += tileSize)
            for (std::size_t color = 0; color < 3; ++color)
                tiles.push_back(
                    {x, y, std::min(x + tileSize, width), std::min(y + tileSize, height), color});
    return tiles;
}

std::vector<double> meansIn(const Tile& tile, const std::vector<Picture>& pictures, int width) {
    std::vector<double> means;
    for (const Picture& picture : pictures) {
        double sum = 0.0;
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x)
                sum += static_cast<double>(
                    picture[3 * static_cast<std::size_t>(y * width + x) + tile.color]);
        means.push_back(sum / tile.pixels());
    }
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
