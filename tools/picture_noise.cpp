#include "tools/picture_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "statistics/statistics.h"

namespace etendue {

namespace {

/// Tiles are large enough to be independent of each other, and at least some dozens.
constexpr std::size_t largestTile = 16, tilesWanted = 8;  // pixels; along the shorter side

}  // namespace

PictureNoise pictureNoise(const Film& film) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (film.samples() < 2) return {infinity, infinity};
    std::vector<double> luminances(film.pixelCount());
    for (std::size_t p = 0; p < luminances.size(); ++p) luminances[p] = film.luminance(p);
    const double mean = summarize(luminances).mean;
    if (mean <= 0.0) return {infinity, infinity};  // nothing found yet

    const auto width = static_cast<std::size_t>(film.window().width);
    const auto height = static_cast<std::size_t>(film.window().height);
    const std::size_t side =
        std::clamp(std::min(width, height) / tilesWanted, std::size_t{1}, largestTile);
    const std::size_t columns = (width + side - 1) / side, rows = (height + side - 1) / side;
    // Of their relative variances; a tile at the edge counts by what it has.
    std::vector<double> tiles(columns * rows);
    double total = 0.0;
    for (std::size_t p = 0; p < luminances.size(); ++p) {
        const double relative =
            film.luminanceVariance(p) / (luminances[p] * luminances[p] + 0.01 * mean * mean);
        total += relative;
        tiles[p / width / side * columns + p % width / side] +=
            relative / static_cast<double>(side * side);
    }
    const double relativeVariance = total / static_cast<double>(film.pixelCount());
    if (tiles.size() < 2)
        return {std::sqrt(relativeVariance), infinity};  // nothing tells its spread
    return {std::sqrt(relativeVariance),
            std::sqrt(relativeVariance + 1.96 * summarize(tiles).standardError)};
}

}  // namespace etendue
