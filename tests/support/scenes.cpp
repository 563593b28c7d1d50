#include "tests/support/scenes.h"

namespace etendue {

LoadedScene sceneFromText(const std::string& text, const std::vector<std::string>& overrides) {
    const TemporaryFolder folder;
    return loadScene(folder.write("scene.toml", text),
                     {overrides, 8});  // Embree caps all threads of the process
}

std::vector<float> renderPixels(const LoadedScene& loaded, std::uint32_t samples,
                                std::uint64_t seed, int threads) {
    Film film(loaded.film.fullFrame(), {}, loaded.film.color);
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    const auto estimator = makeEstimator(loaded.estimator);
    RenderSettings settings;
    settings.samples = samples;
    settings.seed = seed;
    settings.sampler = loaded.sampler;
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

}  // namespace etendue
