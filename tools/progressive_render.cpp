#include "tools/progressive_render.h"

#include <algorithm>

#include "renderer/render.h"
#include "statistics/flip.h"

namespace etendue {

std::optional<ProgressiveRender> renderProgressively(const LoadedScene& loaded,
                                                     const ProgressiveSettings& settings,
                                                     const Picture& reference,
                                                     const std::function<bool(double)>& goOn) {
    const std::unique_ptr<Estimator> estimator =
        makeEstimator(withKind(loaded.estimator, settings.estimator));
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    Film film(loaded.film.fullFrame(), {}, loaded.film.color);
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
    progressive.flip = meanHdrFlip(progressive.picture, reference, loaded.film.width);
    return progressive;
}

}  // namespace etendue
