#include "tools/progressive_render.h"

#include <algorithm>
#include <numeric>

#include "renderer/render.h"
#include "statistics/flip.h"

namespace etendue {

namespace {

double meanOf(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

std::optional<ProgressiveRender> renderProgressively(const LoadedScene& loaded,
                                                     const ProgressiveSettings& settings,
                                                     const Picture& reference,
                                                     const std::function<bool(double)>& goOn) {
    EstimatorSettings kind = loaded.estimator;
    kind.kind = settings.estimator;
    kind.techniques = {};
    const std::unique_ptr<Estimator> estimator = makeEstimator(kind);
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    Film film({loaded.film.width, loaded.film.height, 0, 0, loaded.film.width, loaded.film.height},
              {}, loaded.film.color);
    ProgressiveRender progressive;
    double seconds = 0.0;
    std::uint32_t samples = 0;
    while (seconds < settings.seconds && samples < settings.mostSamples) {
        RenderSettings next;
        next.firstSample = samples;
        next.samples = std::min(std::max(samples, 1u), settings.mostSamples - samples);
        next.seed = settings.seed;
        next.sampler = loaded.sampler;
        next.threads = settings.threads;
        next.timeLimitSeconds = settings.seconds - seconds;
        const RenderResult result =
            render(*loaded.scene, *loaded.camera, *estimator, filter, film, next,
                   [&](const RenderProgress& p) {
                       return goOn(std::min(1.0, (seconds + p.seconds) / settings.seconds));
                   });
        if (result.wasInterrupted) return {};
        seconds += result.seconds;
        samples += result.samples;
        progressive.badSamples += result.badSampleCount;
        progressive.picture = film.channels().front().pixels;
        progressive.checkpoints.push_back(
            {samples, seconds, imageErrors(progressive.picture, reference)});
    }
    progressive.flip = meanOf(hdrFlip(progressive.picture, reference, loaded.film.width));
    return progressive;
}

}  // namespace etendue
