// What pictures of one scene with different seeds tell: their mean, and how much pixels vary.
#pragma once

#include <vector>

#include "renderer/parallel.h"
#include "renderer/render.h"
#include "renderer/scene_loader.h"
#include "statistics/picture_comparison.h"
#include "statistics/statistics.h"

namespace etendue {

struct PictureNoise {
    std::vector<Picture> pictures;
    std::vector<double> means;  // of each picture
    double variance = 0.0;      // of a pixel, mean over the pixels
    double seconds = 0.0;       // of all pictures
};

inline PictureNoise measureNoise(const LoadedScene& loaded, std::uint32_t samples, int seeds) {
    PictureNoise result;
    for (int seed = 0; seed < seeds; ++seed) {
        Film film(
            {loaded.film.width, loaded.film.height, 0, 0, loaded.film.width, loaded.film.height},
            {}, loaded.film.color);
        RenderSettings settings;
        settings.samples = samples;
        settings.seed = static_cast<std::uint64_t>(seed);
        settings.sampler = loaded.sampler;
        settings.threads = hardwareThreads();
        result.seconds +=
            render(*loaded.scene, *loaded.camera, *makeEstimator(loaded.estimator),
                   Filter(loaded.film.filter, loaded.film.filterRadius), film, settings, {})
                .seconds;
        result.pictures.push_back(film.channels().front().pixels);
    }
    result.means = meansOf(result.pictures);
    const std::size_t pixels = result.pictures.front().size();
    for (std::size_t i = 0; i < pixels; ++i) {
        std::vector<double> values;
        for (const Picture& p : result.pictures) values.push_back(static_cast<double>(p[i]));
        result.variance += summarize(values).variance / static_cast<double>(pixels);
    }
    return result;
}

}  // namespace etendue
