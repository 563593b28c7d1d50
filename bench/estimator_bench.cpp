// What a lens costs each estimator: time per camera sample through each camera, and its ratio to
// the thin lens. Medians over interleaved rounds.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <vector>

#include "lens/fit_cache.h"
#include "renderer/render.h"
#include "renderer/scene_loader.h"

namespace etendue {
namespace {

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

double secondsOf(const LoadedScene& loaded, const std::string& kind, std::uint32_t samples) {
    Film film(loaded.film.fullFrame(), {}, loaded.film.color);
    EstimatorSettings estimator = loaded.estimator;
    estimator.kind = kind;
    RenderSettings settings;
    settings.samples = samples;
    return render(*loaded.scene, *loaded.camera, *makeEstimator(estimator),
                  Filter(loaded.film.filter, loaded.film.filterRadius), film, settings, {})
        .seconds;
}

}  // namespace
}  // namespace etendue

/// Arguments: the project's folder, then the cameras' names (scenes/cameras/…); default: those
/// whose connections do not take a trace each.
int main(int argc, char** argv) {
    using namespace etendue;
    const std::filesystem::path project = argc > 1 ? argv[1] : ".";
    std::vector<std::string> cameras(argv + std::min(argc, 2), argv + argc);
    if (cameras.empty())
        cameras = {"thin-lens",     "pinhole", "double-gauss",
                   "double-gauss+", "fisheye", "anamorphic"};
    constexpr std::uint32_t samples = 4;
    constexpr int size = 128, rounds = 7;

    std::vector<LoadedScene> scenes;
    for (const std::string& camera : cameras) {
        const std::string pixels = std::to_string(size);
        LoadOptions options{
            {"film.width=" + pixels, "film.height=" + pixels}, 1, fitCacheDirectory()};
        options.camera = project / "scenes/cameras" / (camera + ".toml");
        // RGB like the others: what the lens itself costs. Dispersion is timed in a row of its own.
        options.disperses = camera.ends_with("+");
        if (options.disperses)
            options.camera =
                project / "scenes/cameras" / (camera.substr(0, camera.size() - 1) + ".toml");
        scenes.push_back(loadScene(project / "scenes/cornell-box/scene.toml", options));
    }
    fmt::print("{:<22}{:>10}{:>16}{:>22}\n", "camera", "estimator", "ns per sample",
               "ratio to " + cameras.front());
    for (const char* kind : {"pt", "lt", "bdpt"}) {
        std::vector<std::vector<double>> times(cameras.size());
        for (int round = 0; round < rounds; ++round)
            for (std::size_t i = 0; i < cameras.size(); ++i)
                times[i].push_back(secondsOf(scenes[i], kind, samples) * 1e9 /
                                   (1.0 * size * size * samples));
        for (std::size_t i = 0; i < cameras.size(); ++i) {
            std::vector<double> ratios;
            for (int round = 0; round < rounds; ++round)
                ratios.push_back(times[i][static_cast<std::size_t>(round)] /
                                 times[0][static_cast<std::size_t>(round)]);
            fmt::print("{:<22}{:>10}{:>16.0f}{:>22.2f}\n", cameras[i], kind, median(times[i]),
                       median(ratios));
        }
        std::fflush(stdout);
    }
    return 0;
}
