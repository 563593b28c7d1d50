#include "renderer/picture_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace etendue {

namespace {

/// Tiles are large enough to be independent of each other, and at least some dozens.
constexpr std::size_t largestTile = 16, tilesWanted = 8;  // pixels; along the shorter side

struct Mean {
    double sum = 0.0, sumOfSquares = 0.0, count = 0.0;
    void add(double v) {
        sum += v;
        sumOfSquares += v * v;
        count += 1.0;
    }
    double mean() const { return sum / count; }
    double standardError() const {
        if (count < 2.0) return std::numeric_limits<double>::infinity();
        return std::sqrt(std::max(0.0, sumOfSquares - sum * sum / count) / (count * (count - 1.0)));
    }
};

}  // namespace

PictureNoise pictureNoise(const Film& film) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (film.samples() < 2) return {infinity, infinity};
    const auto width = static_cast<std::size_t>(film.window().width);
    const auto height = static_cast<std::size_t>(film.window().height);
    double sum = 0.0;
    for (std::size_t p = 0; p < film.pixelCount(); ++p) sum += film.luminance(p);
    const double mean = sum / static_cast<double>(film.pixelCount());
    if (mean <= 0.0) return {infinity, infinity};  // nothing found yet

    const std::size_t side =
        std::clamp(std::min(width, height) / tilesWanted, std::size_t{1}, largestTile);
    Mean tiles;  // of their relative variances, tiles at the edge by what they have
    double total = 0.0;
    for (std::size_t y = 0; y < height; y += side)
        for (std::size_t x = 0; x < width; x += side) {
            double tileSum = 0.0;
            for (std::size_t row = y; row < std::min(y + side, height); ++row)
                for (std::size_t column = x; column < std::min(x + side, width); ++column) {
                    const std::size_t p = row * width + column;
                    const double luminance = film.luminance(p);
                    tileSum +=
                        film.luminanceVariance(p) / (luminance * luminance + 0.01 * mean * mean);
                }
            total += tileSum;
            tiles.add(tileSum / static_cast<double>(side * side));
        }
    const double relativeVariance = total / static_cast<double>(film.pixelCount());
    return {std::sqrt(relativeVariance),
            std::sqrt(relativeVariance + 1.96 * tiles.standardError())};
}

}  // namespace etendue
