// Camera samples per second, scaling with threads, and the share of the time that is spent inside
// Embree. Prints a table; every figure is a median over interleaved rounds.
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "renderer/render.h"
#include "renderer/scene_loader.h"

namespace {

/// While on, every Embree query is timed; only one thread renders then. The linker puts these
/// wrappers in the place of Embree's functions (--wrap), so that the renderer itself carries no
/// measuring code.
bool isTiming = false;
std::int64_t embreeNanoseconds = 0, embreeQueries = 0;

using Clock = std::chrono::steady_clock;

double nanosecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

template <class Query>
void timed(const Query& query) {
    if (!isTiming) return query();
    const auto start = Clock::now();
    query();
    embreeNanoseconds +=
        std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
    ++embreeQueries;
}

/// What timing adds to one query: to the whole, and to what counts as inside of it.
struct TimingCost {
    double whole, inside;
};

TimingCost timingCost() {
    constexpr int count = 1000000;
    embreeNanoseconds = 0;
    const auto start = Clock::now();
    for (int i = 0; i < count; ++i) timed([] {});
    return {nanosecondsSince(start) / count, static_cast<double>(embreeNanoseconds) / count};
}

}  // namespace

extern "C" {
void __real_rtcIntersect1(RTCScene, RTCIntersectContext*, RTCRayHit*);
void __real_rtcOccluded1(RTCScene, RTCIntersectContext*, RTCRay*);
void __wrap_rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* rayHit) {
    timed([&] { __real_rtcIntersect1(scene, context, rayHit); });
}
void __wrap_rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray) {
    timed([&] { __real_rtcOccluded1(scene, context, ray); });
}
}

namespace etendue {
namespace {

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// Seconds of one render of `samples` per pixel.
double timeRender(const LoadedScene& loaded, std::uint32_t samples, int threads) {
    Film film({loaded.film.width, loaded.film.height, 0, 0, loaded.film.width, loaded.film.height},
              {}, loaded.film.color);
    RenderSettings settings;
    settings.samples = samples;
    settings.threads = threads;
    return render(*loaded.scene, *loaded.camera, *makeEstimator(loaded.estimator),
                  Filter(loaded.film.filter, loaded.film.filterRadius), film, settings, {})
        .seconds;
}

struct Share {
    double ofTime;  // inside Embree, 0 … 1
    double queriesPerSample;
    double nanosecondsPerQuery;
};

/// One thread. What the timing itself costs is measured beside it and taken off both sides.
Share embreeShare(const LoadedScene& loaded, std::uint32_t samples) {
    isTiming = true;
    const TimingCost cost = timingCost();
    embreeNanoseconds = 0;
    embreeQueries = 0;
    const double total = timeRender(loaded, samples, 1) * 1e9;
    isTiming = false;
    const auto queries = static_cast<double>(embreeQueries);
    const double inside = static_cast<double>(embreeNanoseconds) - queries * cost.inside;
    const double cameraSamples =
        static_cast<double>(loaded.film.width) * loaded.film.height * samples;
    return {inside / (total - queries * cost.whole), queries / cameraSamples, inside / queries};
}

void benchScene(const std::string& name, const std::filesystem::path& file) {
    const std::vector<std::string> overrides{"film.width=360", "film.height=240"};
    const auto start = Clock::now();
    const LoadedScene loaded = loadScene(file, {overrides, 2});
    const double loadSeconds = std::chrono::duration<double>(Clock::now() - start).count();
    constexpr std::uint32_t samples = 4;
    constexpr int rounds = 5;
    timeRender(loaded, 1, 2);
    std::vector<double> rates, speedups, shares, queries, costs;
    const double cameraSamples =
        static_cast<double>(loaded.film.width) * loaded.film.height * samples;
    for (int i = 0; i < rounds; ++i) {
        const double one = timeRender(loaded, samples, 1), two = timeRender(loaded, samples, 2);
        rates.push_back(cameraSamples / two * 1e-6);
        speedups.push_back(one / two);
        const Share share = embreeShare(loaded, samples);
        shares.push_back(share.ofTime);
        queries.push_back(share.queriesPerSample);
        costs.push_back(share.nanosecondsPerQuery);
    }
    fmt::print("{:<14} {:>9} {:>8.2f} {:>12.3f} {:>10.2f} {:>12.1f} {:>10.0f} {:>10.0f} %\n", name,
               loaded.scene->triangleCount(), loadSeconds, median(rates), median(speedups),
               median(queries), median(costs), 100.0 * median(shares));
    std::fflush(stdout);
}

}  // namespace
}  // namespace etendue

/// Arguments: the project's folder; the scene to measure, else all.
int main(int argc, char** argv) {
    const std::filesystem::path project = argc > 1 ? argv[1] : ".";
    const std::string wanted = argc > 2 ? argv[2] : "";
    fmt::print("{:<14} {:>9} {:>8} {:>12} {:>10} {:>12} {:>10} {:>12}\n", "scene", "triangles",
               "load s", "Msamples/s*", "1→2 thr.", "rays/sample", "ns/ray", "in Embree");
    for (const std::string name : {"still-life", "cornell-box", "bunny"}) {
        if (!wanted.empty() && name != wanted) continue;
        if (name == "bunny" && !std::filesystem::exists("/usr/share/glmark2/models/bunny.obj"))
            fmt::print("bunny: not installed (tools/setup.sh --test)\n");
        else
            etendue::benchScene(name,
                                project / (name == "bunny" ? "bench/bunny.toml"
                                                           : "scenes/" + name + "/scene.toml"));
    }
    fmt::print("* camera samples, two threads; medians of 5 rounds\n");
}
