#include "renderer/render.h"

#include <algorithm>
#include <chrono>
#include <mutex>

#include "renderer/parallel.h"
#include "renderer/splats.h"

namespace etendue {

namespace {

constexpr int tileSize = 16;
constexpr std::size_t badSamplesKept = 16;
/// Long enough to keep all threads busy to the end of a pass, short enough to stop when asked.
constexpr double secondsPerPass = 0.5;
/// Of splats in memory at a time: some ten million.
constexpr std::size_t tilesPerPart = 4096;
constexpr std::uint64_t samplesPerSplattingPass = std::uint64_t{tilesPerPart} * tileSize * tileSize;

struct Tile {
    int x, y, width, height;  // pixels of the full frame
};

std::vector<Tile> tilesOf(const FrameWindow& window) {
    std::vector<Tile> tiles;
    for (int y = 0; y < window.height; y += tileSize)
        for (int x = 0; x < window.width; x += tileSize)
            tiles.push_back({window.x + x, window.y + y, std::min(tileSize, window.width - x),
                             std::min(tileSize, window.height - y)});
    return tiles;
}

/// Light paths may fall anywhere, so those of the whole frame are traced for a window of it: a crop
/// is that part of the full picture, to the bit.
std::vector<Tile> tilesFor(const FrameWindow& window, bool isSplatting) {
    if (!isSplatting) return tilesOf(window);
    return tilesOf(
        {window.fullWidth, window.fullHeight, 0, 0, window.fullWidth, window.fullHeight});
}

bool contains(const FrameWindow& window, int x, int y) {
    return x >= window.x && x - window.x < window.width && y >= window.y &&
           y - window.y < window.height;
}

/// Everything a thread needs to take samples.
struct Recorder {
    const View& view;
    const Estimator& estimator;
    Film& film;
    TechniqueImages* images;
    std::uint64_t seed;
    Sampler sampler;

    std::mutex badMutex{};
    std::vector<BadSample> bad{};

    /// Adds what the sample brings to its own pixel, if that belongs to the film, and records what
    /// it splats.
    void takeSample(int x, int y, std::uint32_t index, Sample& sample, SplatList& splats) {
        const bool isOwn = contains(film.window(), x, y);
        estimator.takeSample(view, {seed, x, y, index, sampler},
                             {.ownPixel = isOwn, .firstHit = isOwn && film.wantsFeatures()},
                             sample);
        Spectrum sum;
        for (const Contribution& c : sample.contributions) {
            if (!isUsable(c.value * c.weight)) {
                rememberBad({x, y, index, c.technique});
                continue;
            }
            if (c.isSplat) {
                splats.add(index, c);
                continue;
            }
            sum += c.value * c.weight;
            if (images) images->add(x, y, c.technique, c.value, c.weight);
        }
        if (!isOwn) return;
        if (!film.add(x, y, sum)) rememberBad({x, y, index, {}});
        if (const auto& hit = sample.firstHit)
            film.addFeatures(
                x, y, {hit->albedo, hit->point.shading.z, hit->point.position, hit->distance});
    }

    void rememberBad(BadSample b) {
        const std::lock_guard lock(badMutex);
        bad.push_back(b);
    }
};

/// A pass over the frame, in parts few enough that their splats fit in memory. Splats are added
/// sample by sample, in the order of the tiles: the same bits, whatever the pass and the thread.
void takePass(Recorder& recorder, const std::vector<Tile>& tiles, std::uint32_t first,
              std::uint32_t count, int threads) {
    for (std::size_t begin = 0; begin < tiles.size(); begin += tilesPerPart) {
        const std::size_t size = std::min(tilesPerPart, tiles.size() - begin);
        std::vector<SplatList> splats(size,
                                      SplatList(recorder.film.window(), recorder.view.filter));
        parallelFor(size, threads, [&](std::size_t i) {
            const Tile& tile = tiles[begin + i];
            Sample sample;
            for (std::uint32_t s = first; s < first + count; ++s)
                for (int y = tile.y; y < tile.y + tile.height; ++y)
                    for (int x = tile.x; x < tile.x + tile.width; ++x)
                        recorder.takeSample(x, y, s, sample, splats[i]);
        });
        addSplats(splats, recorder.view.filter, first, count, threads, recorder.film,
                  recorder.images);
    }
}

/// The first few in a fixed order: by sample, then by pixel.
std::vector<BadSample> firstOf(std::vector<BadSample> bad) {
    std::sort(bad.begin(), bad.end(), [](const BadSample& a, const BadSample& b) {
        return std::tie(a.sample, a.y, a.x, a.technique) <
               std::tie(b.sample, b.y, b.x, b.technique);
    });
    bad.resize(std::min(bad.size(), badSamplesKept));
    return bad;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// How many samples per pixel the next pass takes, at the speed so far.
std::uint32_t passSize(std::uint32_t done, std::uint32_t target, double seconds, double limit,
                       double most) {
    if (done == 0) return 1;
    const double secondsPerSample = std::max(seconds / done, 1e-9);
    const double budget = std::min(secondsPerPass, limit - seconds);
    const double fitting = std::max(1.0, std::min(budget / secondsPerSample, most));
    return std::min(target - done, static_cast<std::uint32_t>(std::min(fitting, 1e6)));
}

}  // namespace

RenderResult render(const Scene& scene, const Camera& camera, const Estimator& estimator,
                    const Filter& filter, Film& film, const RenderSettings& settings,
                    const std::function<bool(const RenderProgress&)>& onPass) {
    const auto start = std::chrono::steady_clock::now();
    const auto lightPaths = static_cast<std::uint64_t>(estimator.lightPathsPerSample());
    const std::vector<Tile> tiles = tilesFor(film.window(), lightPaths > 0);
    if (lightPaths > 0) film.expectSplats();
    const double pixels = static_cast<double>(film.window().width) * film.window().height;
    const std::uint64_t framePixels = static_cast<std::uint64_t>(film.window().fullWidth) *
                                      static_cast<std::uint64_t>(film.window().fullHeight);
    const double mostSamples =
        lightPaths > 0 ? static_cast<double>(samplesPerSplattingPass / (framePixels * lightPaths))
                       : std::numeric_limits<double>::infinity();
    const std::uint64_t refusedBefore = scene.refusedRays();
    const View view{scene, camera, filter, film.color() == FilmColor::xyz};
    Recorder recorder{view,          estimator,       film, settings.techniqueImages,
                      settings.seed, settings.sampler};
    RenderResult result;
    while (result.samples < settings.samples && !result.wasInterrupted &&
           result.seconds < settings.timeLimitSeconds) {
        const std::uint32_t first = result.samples;
        const std::uint32_t count = passSize(first, settings.samples, result.seconds,
                                             settings.timeLimitSeconds, mostSamples);
        takePass(recorder, tiles, settings.firstSample + first, count, settings.threads);
        film.addLightPaths(count * framePixels * lightPaths);
        film.addSamples(count);
        result.samples += count;
        result.seconds = secondsSince(start);
        const double fraction = std::max(static_cast<double>(result.samples) / settings.samples,
                                         result.seconds / settings.timeLimitSeconds);
        const RenderProgress progress{result.samples, settings.samples, result.seconds,
                                      std::min(fraction, 1.0),
                                      pixels * result.samples / std::max(result.seconds, 1e-9)};
        if (onPass && !onPass(progress)) result.wasInterrupted = result.samples < settings.samples;
    }
    result.badSampleCount = recorder.bad.size();
    result.badSamples = firstOf(std::move(recorder.bad));
    result.refusedRays = scene.refusedRays() - refusedBefore;
    return result;
}

}  // namespace etendue
