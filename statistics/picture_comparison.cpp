#include "statistics/picture_comparison.h"

#include <algorithm>
#include <map>

#include "statistics/statistics.h"

namespace etendue {

namespace {

/// Of each tile of one picture, and each of R, G, B.
std::vector<double> tileMeans(const Picture& pixels, int width, int tileSize) {
    const int tilesAcross = (width + tileSize - 1) / tileSize;
    std::map<std::pair<int, std::size_t>, std::pair<double, int>> sums;
    for (std::size_t i = 0; i < pixels.size() / 3; ++i) {
        const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
        for (std::size_t c = 0; c < 3; ++c) {
            auto& [sum, count] = sums[{y / tileSize * tilesAcross + x / tileSize, c}];
            sum += static_cast<double>(pixels[3 * i + c]);
            ++count;
        }
    }
    std::vector<double> means;
    for (const auto& [tile, entry] : sums) means.push_back(entry.first / entry.second);
    return means;
}

/// The same, each with its means in all the pictures.
std::vector<std::vector<double>> byTile(const std::vector<Picture>& pictures, int width,
                                        int tileSize) {
    std::vector<std::vector<double>> result;
    for (const Picture& p : pictures) {
        const std::vector<double> means = tileMeans(p, width, tileSize);
        result.resize(means.size());
        for (std::size_t i = 0; i < means.size(); ++i) result[i].push_back(means[i]);
    }
    return result;
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

PictureComparison comparePictures(const std::vector<Picture>& a, const std::vector<Picture>& b,
                                  int width, int tileSize, std::size_t comparisons) {
    const auto tilesA = byTile(a, width, tileSize), tilesB = byTile(b, width, tileSize);
    const std::vector<double> wholeA = meansOf(a), wholeB = meansOf(b);
    const WelchResult whole = welchTest(wholeA, wholeB);
    PictureComparison result;
    result.level = sidakLevel(0.01, (tilesA.size() + 1) * comparisons);
    result.smallestP = whole.pValue;
    for (std::size_t i = 0; i < tilesA.size(); ++i)
        result.smallestP = std::min(result.smallestP, welchTest(tilesA[i], tilesB[i]).pValue);
    const double mean = summarize(wholeB).mean;
    result.relativeBias = whole.difference / mean;
    if (whole.standardError > 0.0)
        result.relativeBiasHalfWidth =
            studentQuantile(0.99, whole.degreesOfFreedom) * whole.standardError / mean;
    return result;
}

}  // namespace etendue
