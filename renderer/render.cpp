#include "renderer/render.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <span>

#include "renderer/parallel.h"
#include "renderer/splats.h"

namespace etendue {

namespace {

constexpr int tileSize = 16;
constexpr std::size_t badSamplesKept = 16;
/// Long enough to keep all threads busy to the end of a pass, short enough to stop when asked.
constexpr double secondsPerPass = 0.5;
/// What one task takes of a tile: little, so that threads finish together.
constexpr int rowsPerPart = 4;
/// Of splats in memory at a time: of 8192 samples for two threads. Enough that threads seldom wait
/// for each other.
constexpr std::size_t partsPerThread = 64, fewestPartsPerThread = 8;

struct Part {
    int x, y, width, height;  // pixels of the full frame
};

/// Tile by tile, each from its top: neighbours see the same parts of a scene.
std::vector<Part> partsOf(const FrameWindow& window) {
    std::vector<Part> parts;
    for (int tileY = 0; tileY < window.height; tileY += tileSize)
        for (int x = 0; x < window.width; x += tileSize) {
            const int endY = std::min(tileY + tileSize, window.height);
            for (int y = tileY; y < endY; y += rowsPerPart)
                parts.push_back({window.x + x, window.y + y, std::min(tileSize, window.width - x),
                                 std::min(rowsPerPart, endY - y)});
        }
    return parts;
}

/// Light paths may fall anywhere, so those of the whole frame are traced for a window of it: a crop
/// is that part of the full picture, to the bit.
std::vector<Part> partsFor(const FrameWindow& window, bool isSplatting) {
    if (!isSplatting) return partsOf(window);
    return partsOf(
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

    /// Adds what the samples of these pixels bring to them, if they belong to the film, and records
    /// what they splat, if there is a list.
    void takePart(const Part& part, std::uint32_t index, SplatList* splats) {
        static thread_local Sample sample;
        for (int y = part.y; y < part.y + part.height; ++y)
            for (int x = part.x; x < part.x + part.width; ++x)
                takeSample(x, y, index, sample, splats);
    }

    void takeSample(int x, int y, std::uint32_t index, Sample& sample, SplatList* splats) {
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
                if (splats) splats->add(c);
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

/// Samples `first` … `first + count − 1` of every pixel.
void takePass(Recorder& recorder, const std::vector<Part>& parts, std::uint32_t first,
              std::uint32_t count, int threads) {
    parallelFor(parts.size(), threads, [&](std::size_t i) {
        for (std::uint32_t s = first; s < first + count; ++s)
            recorder.takePart(parts[i], s, nullptr);
    });
}

/// The same with splats, of as many parts at a time as there are lists. They are added sample by
/// sample, part by part: the same bits, whatever the pass, the lists and the thread.
void takeSplattingPass(Recorder& recorder, const std::vector<Part>& parts, std::uint32_t first,
                       std::uint32_t count, int threads, std::span<SplatList> lists) {
    const std::size_t divisions = (parts.size() + lists.size() - 1) / lists.size();
    const std::size_t size = (parts.size() + divisions - 1) / divisions;
    const auto samples = static_cast<std::uint32_t>(lists.size() / size);  // at a time
    for (std::uint32_t s = first; s < first + count; s += samples)
        for (std::size_t begin = 0; begin < parts.size(); begin += size) {
            const std::size_t partCount = std::min(size, parts.size() - begin);
            const std::uint32_t sampleCount = std::min(samples, first + count - s);
            parallelFor(partCount, threads, [&](std::size_t i) {
                for (std::uint32_t j = 0; j < sampleCount; ++j) {
                    SplatList& list = lists[j * partCount + i];
                    list.clear();
                    recorder.takePart(parts[begin + i], s + j, &list);
                    list.sortByBand();
                }
            });
            addSplats(lists.first(sampleCount * partCount), recorder.view.filter, threads,
                      recorder.film, recorder.images);
        }
}

/// The more light paths a sample has, the fewer lists.
std::size_t listCount(int threads, std::uint64_t lightPaths) {
    return static_cast<std::size_t>(threads) *
           std::max<std::size_t>(partsPerThread / lightPaths, fewestPartsPerThread);
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
    const auto lightPaths = static_cast<std::uint64_t>(estimator.lightPathsPerSample());
    const std::vector<Part> parts = partsFor(film.window(), lightPaths > 0);
    std::vector<SplatList> lists;
    if (lightPaths > 0) {
        film.expectSplats();
        lists.resize(listCount(settings.threads, lightPaths), SplatList(film.window(), filter));
    }
    const double pixels = static_cast<double>(film.window().width) * film.window().height;
    const std::uint64_t framePixels = static_cast<std::uint64_t>(film.window().fullWidth) *
                                      static_cast<std::uint64_t>(film.window().fullHeight);
    const std::uint64_t refusedBefore = scene.refusedRays();
    const View view{scene, camera, filter, film.color() == FilmColor::xyz};
    Recorder recorder{view,          estimator,       film, settings.techniqueImages,
                      settings.seed, settings.sampler};
    RenderResult result;
    while (result.samples < settings.samples && !result.wasInterrupted &&
           result.seconds < settings.timeLimitSeconds) {
        const std::uint32_t first = result.samples;
        const std::uint32_t count =
            passSize(first, settings.samples, result.seconds, settings.timeLimitSeconds);
        if (lists.empty())
            takePass(recorder, parts, settings.firstSample + first, count, settings.threads);
        else
            takeSplattingPass(recorder, parts, settings.firstSample + first, count,
                              settings.threads, lists);
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
