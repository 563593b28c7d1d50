// What it does to a picture's brightness to stop each pixel by its own noise, beside uniform
// sampling and beside stopping the whole picture as --error does: all on the same samples.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <utility>

#include "bench/stopping_rules.h"
#include "statistics/statistics.h"

namespace etendue {
namespace {

constexpr std::size_t tileSide = 8, tileCount = stoppingPixels / (tileSide * tileSide);

std::size_t tileOf(std::size_t pixel) {
    return pixel / stoppingWidth / tileSide * (stoppingWidth / tileSide) +
           pixel % stoppingWidth / tileSide;
}

/// Whose bright samples are so rare that the relative error seen in n of them rises with their
/// mean. To the first order it does where cov(ln s², mean) = μ₃ / (n σ²) is above
/// cov(ln mean², mean) = 2 σ² / (n μ); of a gamma distribution the two are equal.
std::vector<bool> longTailed(const Streams& streams) {
    const double mean = meanOf(imageOf(streams, streams.length));
    std::vector<bool> result;
    for (std::size_t p = 0; p < stoppingPixels; ++p) {
        const double m = meanOf(streams.of(p)), n = static_cast<double>(streams.length);
        double variance = 0.0, third = 0.0;
        for (const float value : streams.of(p)) {
            variance += std::pow(double{value} - m, 2) / n;
            third += std::pow(double{value} - m, 3) / n;
        }
        result.push_back(third * (m * m + 0.01 * mean * mean) > 2.0 * m * variance * variance);
    }
    return result;
}

/// Per cent of the truth, with the half width of the interval.
struct Bias {
    double value = 0.0, halfWidth = 0.0;
    double surely() const { return std::abs(value) - halfWidth; }
};

/// Of the pixels that `isIn` names, together.
template <class IsIn>
Bias biasOf(const Rule& rule, const Means& truth, double level, const IsIn& isIn) {
    std::vector<double> differences(rule.images.size());
    double whole = 0.0;
    for (std::size_t p = 0; p < stoppingPixels; ++p) {
        if (!isIn(p)) continue;
        whole += truth[p];
        for (std::size_t i = 0; i < differences.size(); ++i)
            differences[i] += rule.images[i][p] - rule.references[i][p];
    }
    if (whole == 0.0) return {};
    const Summary s = summarize(differences);
    const double t = studentQuantile(1.0 - level, static_cast<double>(s.count - 1));
    return {100.0 * s.mean / whole, 100.0 * t * s.standardError / whole};
}

/// The root of the mean of (a − r)² / (r² + floor), per cent.
double errorOf(const Rule& rule, const Means& truth) {
    const double floor = 0.01 * meanOf(truth) * meanOf(truth);
    Means errors;
    for (const Means& image : rule.images)
        for (std::size_t p = 0; p < stoppingPixels; ++p)
            errors.push_back(std::pow(image[p] - truth[p], 2) / (truth[p] * truth[p] + floor));
    return 100.0 * std::sqrt(meanOf(errors));
}

void print(const Rule& rule, const Means& truth, const std::vector<bool>& isLongTailed) {
    fmt::print("  {:<16}{:>8.1f}{:>8.1f}", rule.name, meanOf(rule.samples), errorOf(rule, truth));
    const auto printBias = [](Bias b) { fmt::print("{:>+9.2f} ± {:<5.2f}", b.value, b.halfWidth); };
    printBias(biasOf(rule, truth, 0.01, [](std::size_t) { return true; }));
    printBias(biasOf(rule, truth, 0.01, [&](std::size_t p) { return isLongTailed[p]; }));
    printBias(biasOf(rule, truth, 0.01, [&](std::size_t p) { return !isLongTailed[p]; }));
    Bias worst;
    int biased = 0;
    for (std::size_t tile = 0; tile < tileCount; ++tile) {
        const Bias b = biasOf(rule, truth, sidakLevel(0.01, tileCount),
                              [&](std::size_t p) { return tileOf(p) == tile; });
        biased += b.surely() > 0.0;
        if (worst.halfWidth == 0.0 || (b.halfWidth > 0.0 && b.surely() > worst.surely())) worst = b;
    }
    printBias(worst);
    fmt::print("{:>5}\n", biased);
}

void compareRules(const std::string& name, const LoadedScene& loaded, std::size_t length,
                  std::uint64_t seeds) {
    Streams streams = drawStreams(loaded, length, 0);
    std::vector<Contest> contests{{0.1, streams}, {0.05, streams}};
    const std::vector<bool> isLongTailed = longTailed(streams);
    Means truth(stoppingPixels);
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        // Pilots are the samples of the seed before. The differences remain uncorrelated: whatever
        // the pilots say, those of the seed itself have the mean 0.
        const Streams pilot = std::exchange(streams, drawStreams(loaded, length, seed));
        for (Contest& contest : contests) contest.run(streams, pilot);
        const Means all = imageOf(streams, length);
        for (std::size_t p = 0; p < stoppingPixels; ++p)
            truth[p] += all[p] / static_cast<double>(seeds);
    }
    for (const Contest& contest : contests) {
        fmt::print("{}, {:g} %; {:.0f} % of the pixels long-tailed\n", name, 100.0 * contest.limit,
                   100.0 * meanOf(isLongTailed));
        for (const Rule* rule : {&contest.uniform, &contest.picture, &contest.pixel,
                                 &contest.pixelFrom64, &contest.byPilot})
            print(*rule, truth, isLongTailed);
    }
    std::fflush(stdout);
}

void compareScenes(const std::filesystem::path& project, std::size_t samples, std::uint64_t seeds) {
    struct Sight {
        const char* scene;
        const char* estimator;
        std::vector<std::string> keys{};
    };
    // Without connections to the lens, which would fall on pixels that have stopped, too.
    const std::vector<std::string> noSplats{"estimator.techniques=t2,t3,t4,t5,t6,t7,t8,t9"};
    const Sight sights[] = {{"cornell-box", "pt"},
                            {"diffuse-box", "pt"},
                            {"still-life", "pt"},
                            {"hidden-light", "pt"},
                            {"hidden-light", "bdpt", noSplats}};
    for (const Sight& sight : sights) {
        std::vector<std::string> keys = sight.keys;
        keys.push_back(std::string("estimator.kind=") + sight.estimator);
        compareRules(std::string(sight.scene) + ", " + sight.estimator,
                     loadForBench(project / "scenes" / sight.scene / "scene.toml", stoppingWidth,
                                  stoppingHeight, keys, hardwareThreads()),
                     samples, seeds);
    }
}

}  // namespace
}  // namespace etendue

/// Arguments: the project's folder, most samples of a pixel (512), seeds (24).
int main(int argc, char** argv) {
    using namespace etendue;
    const std::filesystem::path project = argc > 1 ? argv[1] : ".";
    const auto samples = static_cast<std::size_t>(argc > 2 ? std::atoi(argv[2]) : 512);
    const auto seeds = static_cast<std::uint64_t>(argc > 3 ? std::atoi(argv[3]) : 24);
    try {
        fmt::print("{} × {} pixels, at most {} samples, {} seeds; per cent\n", stoppingWidth,
                   stoppingHeight, samples, seeds);
        fmt::print("{:<18}{:>8}{:>8}{:>14}{:>18}{:>18}{:>15}{:>10}\n", "  rule", "samples", "error",
                   "bias ± 99 %", "long-tailed", "others", "worst tile", "biased");
        compareScenes(project, samples, seeds);
    } catch (const std::exception& error) {
        fmt::print(stderr, "stopping_bench: {}\n", error.what());
        return 1;
    }
}
