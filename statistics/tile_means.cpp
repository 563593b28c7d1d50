#include "statistics/tile_means.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "statistics/statistics.h"

namespace etendue {

namespace {

// A film's means are correct to a few units of their last place, 6e-8 each.
constexpr double roundingOfMeans = 1e-6;

double pValueOf(double difference, double standardError, double magnitude) {
    const double beyondRounding = std::max(0.0, std::abs(difference) - roundingOfMeans * magnitude);
    if (beyondRounding == 0.0) return 1.0;
    return standardError > 0.0 ? normalTwoSidedP(beyondRounding / standardError) : 0.0;
}

}  // namespace

TileZTest zTestOfTiles(const Picture& picture, const Picture& reference, const Picture& variance,
                       int width, int tileSize) {
    if (width < 1 || tileSize < 1 || picture.empty() || reference.size() != picture.size() ||
        variance.size() != picture.size() ||
        picture.size() % (std::size_t{3} * static_cast<std::size_t>(width)) != 0)
        throw std::invalid_argument("pictures to compare must have one size");
    const int height = static_cast<int>(picture.size() / 3) / width;
    TileZTest result;
    const auto test = [&](int x0, int y0, int x1, int y1, int color) {
        double difference = 0.0, sumOfVariance = 0.0, magnitude = 0.0;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                const auto i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(x)) +
                               static_cast<std::size_t>(color);
                const double a = picture[i], r = reference[i];
                difference += a - r;
                magnitude += std::max(std::abs(a), std::abs(r));
                sumOfVariance += variance[i];
            }
        ++result.tests;
        const double p = pValueOf(difference, std::sqrt(sumOfVariance), magnitude);
        if (p >= result.smallestP) return;
        const double pixels = static_cast<double>(x1 - x0) * (y1 - y0);
        result.smallestP = p;
        result.x = x0;
        result.y = y0;
        result.width = x1 - x0;
        result.height = y1 - y0;
        result.color = color;
        result.difference = difference / pixels;
        result.standardError = std::sqrt(sumOfVariance) / pixels;
    };
    for (int color = 0; color < 3; ++color) {
        test(0, 0, width, height, color);
        for (int y = 0; y < height; y += tileSize)
            for (int x = 0; x < width; x += tileSize)
                test(x, y, std::min(x + tileSize, width), std::min(y + tileSize, height), color);
    }
    result.level = sidakLevel(0.01, result.tests);
    return result;
}

}  // namespace etendue
