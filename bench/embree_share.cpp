// Path tracing: camera samples per second, scaling with threads, and the share of the time that is
// spent inside Embree; every figure is a median over interleaved rounds.
#include <fmt/format.h>

#include <cstdio>

#include "bench/bench_scene.h"
#include "bench/embree_probe.h"

namespace etendue {
namespace {

constexpr std::uint32_t samples = 4;
constexpr int rounds = 7, width = 360, height = 240;
constexpr double cameraSamples = 1.0 * width * height * samples;

struct Share {
    double ofTime;  // inside Embree, 0 … 1
    double queriesPerSample;
    double nanosecondsPerQuery;
};

/// One thread. What the timing itself costs is measured beside it and taken off both sides.
Share embreeShare(const LoadedScene& loaded) {
    const TimingCost cost = embreeTimingCost();
    probeEmbree(EmbreeProbe::timing);
    const double start = threadSeconds();
    renderForBench(loaded, "pt", samples, 1);
    const double total = (threadSeconds() - start) * 1e9;
    const EmbreeUse use = embreeUse();
    probeEmbree(EmbreeProbe::off);
    const auto queries = static_cast<double>(use.closestHits + use.occlusions);
    const double inside =
        queries * (use.nanosecondsInside / static_cast<double>(use.timed) - cost.insideNanoseconds);
    return {inside / (total - queries * cost.wholeNanoseconds), queries / cameraSamples,
            inside / queries};
}

void benchScene(const std::string& name, const std::filesystem::path& file) {
    const LoadedScene loaded = loadForBench(file, width, height);
    renderForBench(loaded, "pt", 1, 2);
    probeEmbree(EmbreeProbe::recording);
    renderForBench(loaded, "pt", 1, 1);
    probeEmbree(EmbreeProbe::off);
    std::vector<double> rates, speedups, outside, shares, costs, raw;
    double queries = 0.0;
    for (int i = 0; i < rounds; ++i) {
        const double cpuBefore = threadSeconds();
        const double one = renderForBench(loaded, "pt", samples, 1).seconds;
        const double cpu = threadSeconds() - cpuBefore;
        const double two = renderForBench(loaded, "pt", samples, 2).seconds;
        rates.push_back(cameraSamples / two * 1e-6);
        speedups.push_back(one / two);
        const Share share = embreeShare(loaded);
        queries = share.queriesPerSample;
        shares.push_back(share.ofTime);
        costs.push_back(share.nanosecondsPerQuery);
        raw.push_back(replayNanosecondsPerQuery());
        outside.push_back(cpu * 1e9 / cameraSamples - queries * share.nanosecondsPerQuery);
    }
    fmt::print(
        "{:<14} {:>9} {:>12.3f} {:>10.2f} {:>12.2f} {:>10.0f} {:>10.0f} {:>12.2f} {:>14.0f} "
        "{:>9.0f} %\n",
        name, loaded.scene->triangleCount(), median(rates), median(speedups), queries,
        median(costs), median(raw), 1e3 / median(raw), median(outside), 100.0 * median(shares));
    std::fflush(stdout);
}

}  // namespace

void benchEmbreeShare(const std::filesystem::path& project, const std::string& wanted) {
    fmt::print("{:<14} {:>9} {:>12} {:>10} {:>12} {:>10} {:>10} {:>12} {:>14} {:>11}\n", "scene",
               "triangles", "Msamples/s*", "1→2 thr.", "rays/sample", "ns/ray", "raw ns",
               "raw Mrays/s", "ns/s. outside", "in Embree");
    struct Row {
        const char *name, *file;
    };
    for (const Row& row : {Row{"still-life", "scenes/still-life/scene.toml"},
                           {"fine-shapes", "bench/fine-shapes.toml"},
                           {"bunny", "bench/bunny.toml"},
                           {"cornell-box", "scenes/cornell-box/scene.toml"}}) {
        const std::string name = row.name;
        if (!wanted.empty() && name != wanted) continue;
        if (name == "bunny" && !std::filesystem::exists("/usr/share/glmark2/models/bunny.obj"))
            fmt::print("bunny: not installed (tools/setup.sh --test)\n");
        else
            benchScene(name, project / row.file);
    }
    fmt::print(
        "* camera samples, two threads. raw: the same queries asked again, nothing between them.\n"
        "  ns/s. outside: of one thread, per camera sample. Medians of {} rounds\n",
        rounds);
}

}  // namespace etendue
