// What a lens' dispersion costs each estimator, in time and in noise, and what leaving it out does
// to the picture.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "bench/picture_noise.h"
#include "lens/fit_cache.h"

namespace etendue {
namespace {

Picture averageOf(const std::vector<Picture>& pictures, std::size_t first, std::size_t end) {
    Picture average(pictures.front().size());
    for (std::size_t p = first; p < end; ++p)
        for (std::size_t i = 0; i < average.size(); ++i)
            average[i] += pictures[p][i] / static_cast<float>(end - first);
    return average;
}

/// Of two methods' means, rms over the pixels, relative to the first picture's mean; without the
/// noise: the halves of the seeds have none in common.
double relativeDifference(const PictureNoise& a, const PictureNoise& b) {
    const std::size_t count = a.pictures.size(), half = count / 2;
    const Picture a1 = averageOf(a.pictures, 0, half), a2 = averageOf(a.pictures, half, count),
                  b1 = averageOf(b.pictures, 0, half), b2 = averageOf(b.pictures, half, count);
    double sum = 0.0;
    for (std::size_t i = 0; i < a1.size(); ++i)
        sum += static_cast<double>(a1[i] - b1[i]) * static_cast<double>(a2[i] - b2[i]);
    return std::sqrt(std::max(0.0, sum / static_cast<double>(a1.size()))) / summarize(a.means).mean;
}

}  // namespace
}  // namespace etendue

/// Arguments: the project's folder, samples per pixel (64), seeds (16).
int main(int argc, char** argv) {
    using namespace etendue;
    const std::filesystem::path project = argc > 1 ? argv[1] : ".";
    const auto samples = static_cast<std::uint32_t>(argc > 2 ? std::atoi(argv[2]) : 64);
    const int seeds = argc > 3 ? std::atoi(argv[3]) : 16;
    const auto measure = [&](const char* camera, const char* kind,
                             const std::vector<std::string>& keys) {
        LoadOptions options{
            {"film.width=96", "film.height=64", std::string("estimator.kind=") + kind},
            hardwareThreads(),
            fitCacheDirectory()};
        options.camera = project / "scenes/cameras" / (std::string(camera) + ".toml");
        options.overrides.insert(options.overrides.end(), keys.begin(), keys.end());
        return measureNoise(loadScene(project / "scenes/fisheye-room/scene.toml", options), samples,
                            seeds);
    };
    const std::vector<std::string> rgb{"camera.dispersion=false"},
        spectral{"camera.dispersion=false", "film.color=spectral"};
    fmt::print("Dispersion over RGB: {} samples a pixel, {} pictures of 96 × 64\n", samples, seeds);
    fmt::print("{:<14}{:>10}{:>10}{:>12}{:>14}\n", "camera", "estimator", "time", "variance",
               "efficiency");
    for (const char* camera : {"double-gauss", "fisheye", "anamorphic"})
        for (const char* kind : {"pt", "lt", "bdpt"}) {
            const PictureNoise with = measure(camera, kind, {}),
                               without = measure(camera, kind, rgb);
            const double time = with.seconds / without.seconds,
                         variance = with.variance / without.variance;
            fmt::print("{:<14}{:>10}{:>10.2f}{:>12.2f}{:>14.3f}\n", camera, kind, time, variance,
                       1.0 / (time * variance));
            std::fflush(stdout);
            if (std::string(kind) != "lt") continue;
            const PictureNoise undispersed = measure(camera, kind, spectral);
            fmt::print(
                "{:<14}  without dispersion pixels change by {:.1f} % of the mean, rms; in RGB by "
                "{:.1f} %\n",
                "", 100.0 * relativeDifference(with, undispersed),
                100.0 * relativeDifference(with, without));
        }
    return 0;
}
