#include "renderer/render.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <span>
#include <stdexcept>

#include "renderer/lane_sums.h"
#include "renderer/parallel.h"
#include "renderer/splats.h"

namespace etendue {

namespace {

constexpr int tileSize = 16;
constexpr std::size_t badSamplesKept = 16;
/// Long enough to keep all threads busy to the end of a batch, short enough to stop when asked.
constexpr double secondsPerBatch = 0.5;
/// What one task takes of a tile: little, so that threads finish together.
constexpr int rowsPerPart = 4;
/// Of splats in memory at a time: of 8192 samples for two threads. Enough that threads seldom wait
/// for each other.
constexpr std::size_t partsPerThread = 64, fewestPartsPerThread = 8;
/// In the first batch, when nobody knows yet how long a part takes.
constexpr std::size_t firstPartsPerThread = 16;

struct Part {
    int x, y, width, height;  // pixels of the full frame
};

/// Parts `beginPart` … `endPart − 1` of one sample, or all parts of one or more.
struct Batch {
    std::uint32_t firstSample, sampleCount;
    std::size_t beginPart, endPart;
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

/// Light paths may fall anywhere, and so may wavelengths that a lens parts, so those of the whole
/// frame are traced for a window of it: a crop is that part of the full picture, to the bit.
std::vector<Part> partsFor(const FrameWindow& window, bool isSplatting) {
    if (!isSplatting) return partsOf(window);
    return partsOf(
        {window.fullWidth, window.fullHeight, 0, 0, window.fullWidth, window.fullHeight});
}

bool contains(const FrameWindow& window, int x, int y) {
    return x >= window.x && x - window.x < window.width && y >= window.y &&
           y - window.y < window.height;
}

/// Of all in a fixed order, by sample, then by pixel, the first few.
void keepFirst(std::vector<BadSample>& bad) {
    std::sort(bad.begin(), bad.end(), [](const BadSample& a, const BadSample& b) {
        return std::tie(a.sample, a.y, a.x, a.technique) <
               std::tie(b.sample, b.y, b.x, b.technique);
    });
    bad.resize(std::min(bad.size(), badSamplesKept));
}

/// Everything a thread needs to take samples.
struct Recorder {
    const View& view;
    const Estimator& estimator;
    Film& film;
    TechniqueImages* images;
    std::uint64_t seed;
    Sampler sampler;
    float samplesPerLightPath;

    std::mutex badMutex{};
    std::vector<BadSample> bad{};  // the first few, and some more

    /// Adds what the samples of these pixels bring to them, if they belong to the film, and records
    /// what they splat, if there is a list.
    void takePart(const Part& part, std::uint32_t index, SplatList* splats, bool isUnfinished) {
        static thread_local Sample sample;
        for (int y = part.y; y < part.y + part.height; ++y)
            for (int x = part.x; x < part.x + part.width; ++x) {
                takeSample(x, y, index, sample, splats);
                if (isUnfinished && contains(film.window(), x, y)) film.countUnfinished(x, y);
            }
    }

    void takeSample(int x, int y, std::uint32_t index, Sample& sample, SplatList* splats) {
        const bool isOwn = contains(film.window(), x, y);
        estimator.takeSample(view, {seed, x, y, index, sampler},
                             {.ownPixel = isOwn, .firstHit = isOwn && film.wantsFeatures()},
                             sample);
        Spectrum sum;
        LaneSums lanes;
        for (const Contribution& c : sample.contributions) {
            if (!isOwn && !c.isSplat) continue;
            if (!isTaken(c.value * c.weight, {x, y, index, c.technique})) continue;
            if (c.isSplat) {
                if (!splats) throw std::logic_error("render: splats of an estimator that has none");
                const bool isLights = c.technique.t == 1;
                if (!isLights) lanes.add(c);
                // Of a camera path one technique's share, without the others', is for the images.
                if (isLights || images) splats->add(c, isLights ? samplesPerLightPath : 1.0f);
                continue;
            }
            sum += c.value * c.weight;
            if (images) images->add(x, y, c.technique, toVec3(c.value), c.weight);
        }
        for (const Contribution& lane : lanes.sums())
            if (isTaken(lane.value, {x, y, index, {}}) && splats) splats->add(lane, 1.0f);
        if (!isOwn) return;
        if (!splats) {
            if (!film.add(x, y, sum)) rememberBad({x, y, index, {}});
        } else if (isTaken(sum, {x, y, index, {}}) && !isBlack(sum)) {
            splats->addToPixel(x, y, sum);
        }
        if (const auto& hit = sample.firstHit)
            if (!film.addFeatures(
                    x, y, {hit->albedo, hit->point.shading.z, hit->point.position, hit->distance}))
                rememberBad({x, y, index, {}});
    }

    bool isTaken(const Spectrum& value, const BadSample& otherwise) {
        if (isUsable(value)) return true;
        film.countBad();
        rememberBad(otherwise);
        return false;
    }

    void rememberBad(BadSample b) {
        const std::lock_guard lock(badMutex);
        bad.push_back(b);
        if (bad.size() == 64 * badSamplesKept) keepFirst(bad);
    }
};

/// The film's share of what is done when all of a frame has had a sample.
void finishSample(Film& film, int threads) {
    const int height = film.window().height;
    constexpr int rows = 64;
    parallelFor(static_cast<std::size_t>((height + rows - 1) / rows), threads, [&](std::size_t i) {
        const int first = static_cast<int>(i) * rows;
        film.finishSample(first, std::min(first + rows, height));
    });
}

/// Part by part, all samples of one by the same thread.
void takeBatch(Recorder& recorder, std::span<const Part> parts, const Batch& batch, int threads,
               bool isUnfinished) {
    parallelFor(parts.size(), threads, [&](std::size_t i) {
        for (std::uint32_t s = 0; s < batch.sampleCount; ++s)
            recorder.takePart(parts[i], batch.firstSample + s, nullptr, isUnfinished);
    });
}

/// The same with splats, of as many parts at a time as there are lists. They are added sample by
/// sample, part by part, whatever the batch, the lists and the thread.
void takeSplattingBatch(Recorder& recorder, std::span<const Part> parts, const Batch& batch,
                        int threads, std::span<SplatList> lists, bool isUnfinished) {
    const std::size_t divisions = (parts.size() + lists.size() - 1) / lists.size();
    const std::size_t size = (parts.size() + divisions - 1) / divisions;
    for (std::uint32_t s = 0; s < batch.sampleCount; ++s) {
        for (std::size_t begin = 0; begin < parts.size(); begin += size) {
            const std::size_t count = std::min(size, parts.size() - begin);
            parallelFor(count, threads, [&](std::size_t i) {
                lists[i].clear();
                recorder.takePart(parts[begin + i], batch.firstSample + s, &lists[i], isUnfinished);
                lists[i].sortByBand();
            });
            addSplats(lists.first(count), recorder.view.filter, threads, recorder.film,
                      recorder.images);
        }
        // The last of several; of the last one whoever knows that it is finished says so.
        if (s + 1 < batch.sampleCount) finishSample(recorder.film, threads);
    }
}

/// The more light paths a sample has, the fewer lists.
std::size_t listCount(int threads, std::uint64_t lightPaths) {
    return static_cast<std::size_t>(threads) *
           std::max<std::size_t>(partsPerThread / lightPaths, fewestPartsPerThread);
}

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// What comes next, at the speed so far.
Batch nextBatch(std::uint32_t firstSample, std::uint32_t samplesLeft, std::size_t beginPart,
                std::size_t partCount, double partsPerSecond, double secondsLeft, int threads) {
    const auto threadCount = static_cast<double>(threads);
    const double fitting = partsPerSecond > 0.0
                               ? std::max(partsPerSecond * secondsPerBatch, threadCount)
                               : threadCount * static_cast<double>(firstPartsPerThread);
    const auto count = static_cast<double>(partCount);
    if (beginPart > 0 || fitting < count) {
        const double left = static_cast<double>(partCount - beginPart);
        return {firstSample, 1, beginPart,
                beginPart + static_cast<std::size_t>(std::min(fitting, left))};
    }
    const double samples =
        partsPerSecond > 0.0 ? std::min(fitting, partsPerSecond * secondsLeft) / count : 1.0;
    return {firstSample,
            static_cast<std::uint32_t>(std::clamp(samples, 1.0, static_cast<double>(samplesLeft))),
            0, partCount};
}

/// Light paths are those of the frame's pixels.
std::uint64_t pixelsOf(std::span<const Part> parts) {
    std::uint64_t count = 0;
    for (const Part& part : parts)
        count += static_cast<std::uint64_t>(part.width) * static_cast<std::uint64_t>(part.height);
    return count;
}

}  // namespace

RenderResult render(const Scene& scene, const Camera& camera, const Estimator& estimator,
                    const Filter& filter, Film& film, const RenderSettings& settings,
                    const std::function<bool(const RenderProgress&)>& onBatch) {
    const auto start = std::chrono::steady_clock::now();
    const View view{scene, camera, filter, film.color() == FilmColor::xyz, film.window()};
    const auto lightPaths = static_cast<std::uint64_t>(estimator.lightPathsPerSample());
    const bool camerasSplat = estimator.hasCameraLight() && isParted(view),
               isSplatting = lightPaths > 0 || camerasSplat;
    const std::vector<Part> parts = partsFor(film.window(), isSplatting);
    std::vector<SplatList> lists;
    if (isSplatting) {
        film.expectSplats();
        lists.resize(listCount(settings.threads, std::max<std::uint64_t>(lightPaths, 1)),
                     SplatList(film.window(), filter));
    }
    // Of all that one sample of the whole frame has.
    const double lightPathsOfSample =
        static_cast<double>(std::max<std::uint64_t>(lightPaths, 1) * pixelsOf(parts));
    const double pixels = static_cast<double>(film.pixelCount());
    const std::uint64_t badBefore = film.badSamples(), refusedBefore = scene.refusedRays();
    Recorder recorder{view,
                      estimator,
                      film,
                      settings.techniqueImages,
                      settings.seed,
                      settings.sampler,
                      static_cast<float>(1.0 / lightPathsOfSample)};
    RenderResult result;
    std::size_t partsDone = film.state().unfinishedParts;  // of the sample at hand
    if (partsDone >= parts.size())
        throw std::invalid_argument("render: the film's unfinished sample has more parts than it");
    std::uint64_t allPartsDone = 0;
    double batchSeconds = 0.0;  // without what onBatch takes
    while (result.samples < settings.samples && !result.wasInterrupted &&
           (partsDone > 0 || result.seconds < settings.timeLimitSeconds)) {
        const Batch batch = nextBatch(
            settings.firstSample + result.samples, settings.samples - result.samples, partsDone,
            parts.size(), static_cast<double>(allPartsDone) / std::max(batchSeconds, 1e-9),
            settings.timeLimitSeconds - result.seconds, settings.threads);
        const auto batchStart = std::chrono::steady_clock::now();
        const std::size_t count = batch.endPart - batch.beginPart;
        const auto batchParts = std::span(parts).subspan(batch.beginPart, count);
        const bool isUnfinished = count < parts.size();
        if (isUnfinished) film.expectUnfinishedSample();
        if (lists.empty())
            takeBatch(recorder, batchParts, batch, settings.threads, isUnfinished);
        else
            takeSplattingBatch(recorder, batchParts, batch, settings.threads, lists, isUnfinished);
        allPartsDone += count * batch.sampleCount;
        partsDone = batch.endPart % parts.size();
        film.setUnfinishedParts(partsDone);
        if (partsDone == 0) {
            finishSample(film, settings.threads);
            film.addSamples(batch.sampleCount);
            result.samples += batch.sampleCount;
        }
        batchSeconds += secondsSince(batchStart);
        result.seconds = secondsSince(start);
        const double samples =
            result.samples + static_cast<double>(partsDone) / static_cast<double>(parts.size());
        const double fraction =
            std::max(samples / settings.samples, result.seconds / settings.timeLimitSeconds);
        const RenderProgress progress{
            result.samples,          settings.samples,
            partsDone == 0,          result.seconds,
            std::min(fraction, 1.0), pixels * samples / std::max(result.seconds, 1e-9)};
        if (onBatch && !onBatch(progress))
            result.wasInterrupted = result.samples < settings.samples;
    }
    result.badSampleCount = film.badSamples() - badBefore;
    keepFirst(recorder.bad);
    result.badSamples = std::move(recorder.bad);
    result.refusedRays = scene.refusedRays() - refusedBefore;
    return result;
}

}  // namespace etendue
