#include "tools/agreement_judge.h"

#include <algorithm>

#include "statistics/statistics.h"

namespace etendue {

namespace {

/// Part of a picture, in one colour.
struct TileRange {
    int x0, y0, x1, y1;
    std::size_t color;
    int pixels() const { return (x1 - x0) * (y1 - y0); }
};

std::vector<TileRange> tilesOf(int width, int height, int tileSize) {
    std::vector<TileRange> tiles;
    for (int y = 0; y < height; y += tileSize)
        for (int x = 0; x < width; x += tileSize)
            for (std::size_t color = 0; color < 3; ++color)
                tiles.push_back(
                    {x, y, std::min(x + tileSize, width), std::min(y + tileSize, height), color});
    return tiles;
}

std::vector<double> meansIn(const TileRange& tile, const std::vector<Picture>& pictures,
                            int width) {
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

double guardedP(std::span<const double> a, std::span<const double> b, double largestStepOfA,
                double largestStepOfB) {
    const WelchResult welch = welchTest(a, b);
    const double difference = std::abs(welch.difference);
    const double step = welch.difference < 0.0 ? largestStepOfA : largestStepOfB;
    if (!(difference * step > 0.0)) return welch.pValue;
    // What has been missed comes in a Poisson number of steps; none is larger, so that none of
    // them makes a larger variance of the same mean.
    const double variance = welch.standardError * welch.standardError + difference * step;
    const double least = static_cast<double>(std::min(a.size(), b.size())) - 1.0;
    const double p =
        studentTwoSidedP(difference / std::sqrt(variance), std::max(welch.degreesOfFreedom, least));
    return std::max(p, welch.pValue);
}

Judgement judgePictures(const std::vector<Picture>& a, const std::vector<Picture>& b,
                        SampleSizes sizesOfA, SampleSizes sizesOfB, int width, int tileSize,
                        std::size_t comparisons) {
    Judgement result;
    PictureComparison& c = result.comparison;
    const int pixels = static_cast<int>(a.front().size() / 3);
    const std::vector<TileRange> tiles = tilesOf(width, pixels / width, tileSize);
    c.level = sidakLevel(0.01, (tiles.size() + 1) * comparisons);
    const auto test = [&](const std::vector<double>& meansA, const std::vector<double>& meansB,
                          int pixelsOfMean) {
        const auto step = [&](SampleSizes sizes) {
            return sizes.largest / (sizes.samplesPerPixel * pixelsOfMean);
        };
        const double p = guardedP(meansA, meansB, step(sizesOfA), step(sizesOfB));
        c.smallestP = std::min(c.smallestP, p);
        if (p > c.level && welchTest(meansA, meansB).pValue <= c.level) ++result.testsInDoubt;
    };
    for (const TileRange& tile : tiles)
        test(meansIn(tile, a, width), meansIn(tile, b, width), tile.pixels());
    const std::vector<double> wholeA = meansOf(a), wholeB = meansOf(b);
    test(wholeA, wholeB, pixels);
    const WelchResult whole = welchTest(wholeA, wholeB);
    const double mean = summarize(wholeB).mean;
    c.relativeBias = whole.difference / mean;
    if (whole.standardError > 0.0)
        c.relativeBiasHalfWidth =
            studentQuantile(0.99, whole.degreesOfFreedom) * whole.standardError / mean;
    return result;
}

}  // namespace etendue
