#include "tests/support/scenes.h"

#include <cmath>
#include <map>

#include "statistics/statistics.h"

namespace etendue {

LoadedScene sceneFromText(const std::string& text, const std::vector<std::string>& overrides) {
    const TemporaryFolder folder;
    return loadScene(folder.write("scene.toml", text),
                     {overrides, 8});  // Embree caps all threads of the process
}

std::vector<float> renderPixels(const LoadedScene& loaded, std::uint32_t samples,
                                std::uint64_t seed, int threads) {
    Film film({loaded.film.width, loaded.film.height, 0, 0, loaded.film.width, loaded.film.height});
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    const auto estimator = makeEstimator(loaded.estimator);
    RenderSettings settings;
    settings.samples = samples;
    settings.seed = seed;
    settings.threads = threads;
    const RenderResult result =
        render(*loaded.scene, *loaded.camera, *estimator, filter, film, settings, {});
    if (result.badSampleCount > 0 || result.refusedRays > 0)
        throw std::runtime_error("the render had bad samples or refused rays");
    return film.channels().front().pixels;
}

std::vector<double> batchRadiances(const LoadedScene& loaded, Vec3 origin, Vec3 direction,
                                   int batches, int samples) {
    std::vector<double> means;
    for (int b = 0; b < batches; ++b) {
        double sum = 0.0;
        for (int s = 0; s < samples; ++s) {
            RandomStream random(1, static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(s),
                                RandomDomain::test);
            sum += static_cast<double>(pathTracedRadiance(*loaded.scene, {origin, direction}, {},
                                                          loaded.estimator, random)[0]);
        }
        means.push_back(sum / samples);
    }
    return means;
}

namespace {

double meanOf(const std::vector<float>& pixels) {
    double sum = 0.0;
    for (const float v : pixels) sum += static_cast<double>(v);
    return sum / static_cast<double>(pixels.size());
}

/// Brightness of each tile of one picture.
std::vector<double> tileMeans(const std::vector<float>& pixels, int width, int tileSize) {
    const int tilesAcross = (width + tileSize - 1) / tileSize;
    std::map<int, std::pair<double, int>> sums;
    for (std::size_t i = 0; i < pixels.size() / 3; ++i) {
        const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
        auto& [sum, count] = sums[y / tileSize * tilesAcross + x / tileSize];
        for (std::size_t c = 0; c < 3; ++c) sum += static_cast<double>(pixels[3 * i + c]);
        count += 3;
    }
    std::vector<double> means;
    for (const auto& [tile, entry] : sums) means.push_back(entry.first / entry.second);
    return means;
}

}  // namespace

PictureComparison comparePictures(const std::vector<std::vector<float>>& a,
                                  const std::vector<std::vector<float>>& b, int width,
                                  int tileSize) {
    const auto tilesOf = [&](const std::vector<std::vector<float>>& pictures) {
        std::vector<std::vector<double>> result;
        for (const auto& p : pictures) result.push_back(tileMeans(p, width, tileSize));
        return result;
    };
    const auto tilesA = tilesOf(a), tilesB = tilesOf(b);
    const auto column = [](const std::vector<std::vector<double>>& tiles, std::size_t i) {
        std::vector<double> values;
        for (const auto& t : tiles) values.push_back(t[i]);
        return values;
    };
    const auto wholes = [](const std::vector<std::vector<float>>& pictures) {
        std::vector<double> values;
        for (const auto& p : pictures) values.push_back(meanOf(p));
        return values;
    };
    PictureComparison result;
    const std::size_t tiles = tilesA.front().size();
    result.level = sidakLevel(0.01, tiles);
    for (std::size_t i = 0; i < tiles; ++i)
        result.smallestP =
            std::min(result.smallestP, welchTest(column(tilesA, i), column(tilesB, i)).pValue);
    const std::vector<double> wholeA = wholes(a), wholeB = wholes(b);
    const WelchResult whole = welchTest(wholeA, wholeB);
    const double mean = summarize(wholeB).mean;
    result.relativeBias = whole.difference / mean;
    if (whole.standardError > 0.0)
        result.relativeBiasHalfWidth =
            studentQuantile(0.99, whole.degreesOfFreedom) * whole.standardError / mean;
    return result;
}

}  // namespace etendue
