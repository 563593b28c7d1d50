// Light tracing through a fisheye: aiming through the aperture, against drawing a point of the
// outermost surface, against path tracing with next-event estimation. Equal means, and the variance
// of each at equal samples, with a picture of each.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "bench/picture_noise.h"
#include "lens/fit_cache.h"
#include "renderer/srgb.h"

/// Arguments: the project's folder, a folder for the pictures, samples per pixel (512), seeds (16).
int main(int argc, char** argv) {
    using namespace etendue;
    const std::filesystem::path project = argc > 1 ? argv[1] : ".", out = argc > 2 ? argv[2] : ".";
    const auto samples = static_cast<std::uint32_t>(argc > 3 ? std::atoi(argv[3]) : 512);
    const int seeds = argc > 4 ? std::atoi(argv[4]) : 16;
    struct Method {
        const char* name;
        std::vector<std::string> keys;
    };
    const Method methods[] = {
        {"aperture", {"estimator.kind=lt"}},
        {"outer-pupil", {"estimator.kind=lt", "estimator.pupil_sampling=outer"}},
        {"path-tracing", {"estimator.kind=pt"}}};
    fmt::print("{:<14}{:>12}{:>12}{:>14}{:>18}{:>14}\n", "method", "mean", "± 99 %", "variance",
               "ratio to aperture", "seconds");
    double aimed = 0.0;
    for (const Method& method : methods) {
        LoadOptions options{{"film.width=96", "film.height=64", "camera.dispersion=false"},
                            hardwareThreads(),
                            fitCacheDirectory()};
        options.overrides.insert(options.overrides.end(), method.keys.begin(), method.keys.end());
        const LoadedScene loaded = loadScene(project / "scenes/fisheye-room/scene.toml", options);
        const PictureNoise m = measureNoise(loaded, samples, seeds);
        const Summary mean = summarize(m.means);
        if (aimed == 0.0) aimed = m.variance;
        fmt::print("{:<14}{:>12.6f}{:>12.6f}{:>14.3g}{:>18.2f}{:>14.1f}\n", method.name, mean.mean,
                   studentQuantile(0.99, static_cast<double>(seeds - 1)) * mean.standardError,
                   m.variance, m.variance / aimed, m.seconds);
        std::fflush(stdout);
        writePng(out / fmt::format("pupil-{}.png", method.name), loaded.film.width,
                 loaded.film.height, srgbBytes(m.pictures.front(), 0.0f));
    }
    return 0;
}
