#include "tools/regress_pictures.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>

#include "renderer/parallel.h"
#include "statistics/tiles.h"
#include "tools/watched_estimator.h"

namespace etendue {

namespace {

/// What one seed has brought.
struct OneSeed {
    std::vector<Picture> pictures;  // [checkpoint]
    double largest = 0.0;
    LeftOutMeans leftOut{};
    std::uint64_t badSamples = 0;
    bool isComplete = false;
};

OneSeed renderSeed(const LoadedScene& loaded, const CommonPathsSettings& paths,
                   const SeedSettings& settings, std::uint64_t seed,
                   const std::function<bool()>& goOn) {
    const FilmSettings& frame = loaded.film;
    const Filter filter(frame.filter, frame.filterRadius);
    Film film(frame.fullFrame(), {}, frame.color);
    const auto estimator = makeCommonPaths(*loaded.scene, *loaded.camera, paths);
    const WatchedEstimator watched(*estimator, loaded);
    OneSeed result;
    RenderSettings render;
    render.seed = seed;
    render.sampler = settings.sampler;
    std::uint32_t done = 0;
    for (const std::uint32_t checkpoint : settings.checkpoints) {
        render.firstSample = done;
        render.samples = checkpoint - done;
        const RenderResult part =
            etendue::render(*loaded.scene, *loaded.camera, watched, filter, film, render,
                            [&](const RenderProgress&) { return goOn(); });
        if (part.wasInterrupted) return result;
        done = checkpoint;
        result.badSamples += part.badSampleCount;
        result.pictures.push_back(film.channels().front().pixels);
    }
    result.largest = watched.largest();
    result.leftOut = estimator->leftOut(
        done, static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height),
        frame.color);
    result.isComplete = true;
    return result;
}

}  // namespace

std::optional<SeedPictures> renderSeeds(const LoadedScene& loaded, const CommonPathsSettings& paths,
                                        const SeedSettings& settings,
                                        const std::function<bool()>& goOn) {
    const auto start = std::chrono::steady_clock::now();
    const auto count = static_cast<std::size_t>(settings.seeds);
    std::vector<OneSeed> seeds(count);
    std::atomic<bool> isOver{false};
    std::mutex asking;
    const auto goesOn = [&] {
        if (isOver) return false;
        const std::lock_guard lock(asking);
        if (!goOn()) isOver = true;
        return !isOver;
    };
    parallelFor(count, settings.threads, [&](std::size_t i) {
        if (goesOn())
            seeds[i] = renderSeed(loaded, paths, settings, settings.firstSeed + i, goesOn);
    });
    SeedPictures result;
    result.pictures.resize(settings.checkpoints.size());
    for (OneSeed& seed : seeds) {
        if (!seed.isComplete) return {};
        for (std::size_t step = 0; step < settings.checkpoints.size(); ++step)
            result.pictures[step].push_back(std::move(seed.pictures[step]));
        result.largest = std::max(result.largest, seed.largest);
        for (std::size_t c = 0; c < pathClassCount; ++c)
            result.leftOut[c] += seed.leftOut[c] / static_cast<double>(count);
        result.badSamples += seed.badSamples;
    }
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

std::size_t PictureRegions::count() const { return pixels().size(); }

std::vector<int> PictureRegions::pixels() const {
    std::vector<int> result;
    for (const Tile& tile : tilesOf(width, height, tileSize)) result.push_back(tile.pixels());
    result.push_back(width * height);
    return result;
}

std::vector<double> PictureRegions::meansOf(const Picture& picture) const {
    std::vector<double> means;
    double whole = 0.0;
    for (const Tile& tile : tilesOf(width, height, tileSize)) {
        const double sum = sumIn(tile, picture, width);
        means.push_back(sum / tile.pixels());
        whole += sum;
    }
    means.push_back(whole / (3.0 * width * height));
    return means;
}

}  // namespace etendue
