#include "renderer/render.h"

#include <algorithm>
#include <chrono>
#include <mutex>

#include "renderer/parallel.h"

namespace etendue {

namespace {

constexpr int tileSize = 16;
constexpr std::size_t badSamplesKept = 16;
/// Long enough to keep all threads busy to the end of a pass, short enough to stop when asked.
constexpr double secondsPerPass = 0.5;

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

/// Everything a thread needs to take samples.
struct Sampler {
    const Scene& scene;
    const Camera& camera;
    const Estimator& estimator;
    const Filter& filter;
    Film& film;
    std::uint64_t seed;

    std::mutex badMutex{};
    std::vector<BadSample> bad{};

    /// One camera sample: film point by the filter, lens point uniform on the aperture. The weight
    /// of equation (1) times the radiance is the pixel value; a blocked ray is a sample of value
    /// zero.
    void takeSample(int x, int y, std::uint32_t sample) {
        const auto pixel =
            static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(film.window().fullWidth) +
            static_cast<std::uint32_t>(x);
        RandomStream random(seed, pixel, sample);
        const Vec2 center{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
        const Vec2 filmPoint = center + filter.sample(random.next2());
        const Wavelengths wavelengths;
        const auto ray = camera.sampleRay(filmPoint, random.next2(), wavelengths);
        if (!ray) return;
        const Spectrum radiance =
            film.wantsFeatures() ? radianceAndFeatures(x, y, *ray, wavelengths, random)
                                 : estimator.radiance(scene, *ray, wavelengths, random, nullptr);
        if (!film.add(x, y, radiance * ray->weight)) rememberBad({x, y, sample});
    }

    Spectrum radianceAndFeatures(int x, int y, const CameraRay& ray, const Wavelengths& wavelengths,
                                 RandomStream& random) {
        std::optional<FirstHit> hit;
        const Spectrum radiance = estimator.radiance(scene, ray, wavelengths, random, &hit);
        if (hit)
            film.addFeatures(
                x, y, {hit->albedo, hit->point.shading.z, hit->point.position, hit->distance});
        return radiance;
    }

    void rememberBad(BadSample b) {
        const std::lock_guard lock(badMutex);
        bad.push_back(b);
    }
};

/// The first few in a fixed order: by sample, then by pixel.
std::vector<BadSample> firstOf(std::vector<BadSample> bad) {
    std::sort(bad.begin(), bad.end(), [](const BadSample& a, const BadSample& b) {
        return std::tie(a.sample, a.y, a.x) < std::tie(b.sample, b.y, b.x);
    });
    bad.resize(std::min(bad.size(), badSamplesKept));
    return bad;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// How many samples per pixel the next pass takes, at the speed so far.
std::uint32_t passSize(std::uint32_t done, std::uint32_t target, double seconds, double limit) {
    if (done == 0) return 1;
    const double secondsPerSample = std::max(seconds / done, 1e-9);
    const double budget = std::min(secondsPerPass, limit - seconds);
    const double fitting = std::max(1.0, budget / secondsPerSample);
    return std::min(target - done, static_cast<std::uint32_t>(std::min(fitting, 1e6)));
}

}  // namespace

RenderResult render(const Scene& scene, const Camera& camera, const Estimator& estimator,
                    const Filter& filter, Film& film, const RenderSettings& settings,
                    const std::function<bool(const RenderProgress&)>& onPass) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<Tile> tiles = tilesOf(film.window());
    const double pixels = static_cast<double>(film.window().width) * film.window().height;
    const std::uint64_t refusedBefore = scene.refusedRays();
    Sampler sampler{scene, camera, estimator, filter, film, settings.seed};
    RenderResult result;
    // A pixel's samples are added in their order, whatever the pass and the thread: the same bits.
    while (result.samples < settings.samples && !result.wasInterrupted &&
           result.seconds < settings.timeLimitSeconds) {
        const std::uint32_t first = result.samples;
        const std::uint32_t count =
            passSize(first, settings.samples, result.seconds, settings.timeLimitSeconds);
        parallelFor(tiles.size(), settings.threads, [&](std::size_t i) {
            const Tile& tile = tiles[i];
            for (int y = tile.y; y < tile.y + tile.height; ++y)
                for (int x = tile.x; x < tile.x + tile.width; ++x)
                    for (std::uint32_t s = first; s < first + count; ++s)
                        sampler.takeSample(x, y, s);
        });
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
    result.badSampleCount = sampler.bad.size();
    result.badSamples = firstOf(std::move(sampler.bad));
    result.refusedRays = scene.refusedRays() - refusedBefore;
    return result;
}

}  // namespace etendue
