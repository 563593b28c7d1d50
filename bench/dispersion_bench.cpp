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

/// Of two methods' means, rms over the pixels, without the noise: the halves of the seeds have none
/// in common.
double rmsDifference(const PictureNoise& a, const PictureNoise& b) {
    const std::size_t count = a.pictures.size(), half = count / 2;
    const Picture a1 = averageOf(a.pictures, 0, half), a2 = averageOf(a.pictures, half, count),
                  b1 = averageOf(b.pictures, 0, half), b2 = averageOf(b.pictures, half, count);
    double sum = 0.0;
    for (std::size_t i = 0; i < a1.size(); ++i)
        sum += static_cast<double>(a1[i] - b1[i]) * static_cast<double>(a2[i] - b2[i]);
    return std::sqrt(std::max(0.0, sum / static_cast<double>(a1.size())));
}

}  // namespace
}  // namespace etendue

/// Arguments: the project's folder, samples per pixel (64), seeds (16).
int main(int argc, char** argv) {
    using namespace etendue;
    const std::filesystem::path project = argc > 1 ? argv[1] : ".";
    const auto samples = static_cast<std::uint32_t>(argc > 2 ? std::atoi(argv[2]) : 64);
    const int seeds = argc > 3 ? std::atoi(argv[3]) : 16;
    fmt::print("Dispersion over none: {} samples a pixel, {} pictures of 96 × 64\n", samples,
               seeds);
    fmt::print("{:<16}{:<14}{:>10}{:>10}{:>12}{:>14}{:>16}\n", "scene", "camera", "estimator",
               "time", "variance", "efficiency", "difference");
    for (const char* scene : {"cornell-box", "fisheye-room"})
        for (const char* camera : {"double-gauss", "fisheye", "anamorphic"})
            for (const char* kind : {"pt", "lt", "bdpt"}) {
                const auto measure = [&](bool isDispersive) {
                    LoadOptions options{
                        {"film.width=96", "film.height=64", std::string("estimator.kind=") + kind},
                        hardwareThreads(),
                        fitCacheDirectory()};
                    options.camera = project / "scenes/cameras" / (std::string(camera) + ".toml");
                    if (!isDispersive) options.overrides.push_back("camera.dispersion=false");
                    return measureNoise(
                        loadScene(project / "scenes" / scene / "scene.toml", options), samples,
                        seeds);
                };
                const PictureNoise with = measure(true), without = measure(false);
                const double time = with.seconds / without.seconds,
                             variance = with.variance / without.variance;
                fmt::print("{:<16}{:<14}{:>10}{:>10.2f}{:>12.2f}{:>14.3f}{:>15.2f}%\n", scene,
                           camera, kind, time, variance, 1.0 / (time * variance),
                           100.0 * rmsDifference(with, without) / summarize(with.means).mean);
                std::fflush(stdout);
            }
    return 0;
}
