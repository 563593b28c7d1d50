// The render loop: passes over the image, the same bits for any number of threads and passes.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "renderer/camera.h"
#include "renderer/estimator.h"
#include "renderer/film.h"
#include "renderer/filter.h"
#include "renderer/scene.h"
#include "renderer/technique_images.h"

namespace etendue {

/// A count that no render reaches: the time limit ends it.
inline constexpr std::uint32_t unlimitedSamples = 1u << 30;

struct RenderSettings {
    std::uint32_t samples = 64;     // per pixel
    std::uint32_t firstSample = 0;  // their indices: a render goes on where another has ended, in
                                    // the middle of a sample if that one did (FilmState)
    std::uint64_t seed = 0;
    Sampler sampler = Sampler::independent;
    int threads = 1;
    double timeLimitSeconds = std::numeric_limits<double>::infinity();
    TechniqueImages* techniqueImages = nullptr;  // receives them, if wanted
};

struct RenderProgress {
    std::uint32_t samplesDone = 0, samplesTarget = 0;  // per pixel, whole ones
    bool isBetweenSamples = true;                      // every pixel has had the same count
    double seconds = 0.0;
    double fractionDone = 0.0;            // of the samples or of the time, whichever ends first
    double cameraSamplesPerSecond = 0.0;  // of the whole image
};

/// A sample that was not a finite, non-negative number. It can be traced again from these numbers.
struct BadSample {
    int x = 0, y = 0;  // pixel of the full frame
    std::uint32_t sample = 0;
    Technique technique;  // that found it; s = t = 0 for path tracing
};

struct RenderResult {
    std::uint32_t samples = 0;  // per pixel
    double seconds = 0.0;
    bool wasInterrupted = false;  // by onBatch
    std::uint64_t badSampleCount = 0;
    std::vector<BadSample> badSamples;  // the first few
    std::uint64_t refusedRays = 0;      // see Intersector
};

/// Adds samples to every pixel of the film's window, and light paths from all of the frame if the
/// estimator has any, until the count or the time is reached; these end it between samples only, so
/// that every pixel has the same count. `onBatch` is called about every half second, where the film
/// may be looked at or written down, and returns false to stop there. That may be in the middle of
/// a sample, if one takes long: then FilmState says which parts of the frame have had it, and
/// another render of the same film goes on there, to the same bits.
RenderResult render(const Scene& scene, const Camera& camera, const Estimator& estimator,
                    const Filter& filter, Film& film, const RenderSettings& settings,
                    const std::function<bool(const RenderProgress&)>& onBatch);

}  // namespace etendue
