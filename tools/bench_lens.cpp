#include "tools/bench_lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

#include "renderer/random.h"

namespace etendue {

namespace {

/// Of this thread's own, which others on the machine do not add to.
double threadSeconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Of one call of `body`, called for 0 … `count` − 1: the median over several runs.
template <class Body>
double nanosecondsPer(std::size_t count, const Body& body) {
    constexpr std::size_t runs = 9;
    std::array<double, runs> times;
    [[maybe_unused]] volatile float sink = 0.0f;  // lest the calls be left out
    for (double& time : times) {
        float sum = 0.0f;
        const double start = threadSeconds();
        for (std::size_t i = 0; i < count; ++i) sum += body(i);
        time = threadSeconds() - start;
        sink = sum;
    }
    std::nth_element(times.begin(), times.begin() + runs / 2, times.end());
    return count > 0 ? 1e9 * times[runs / 2] / static_cast<double>(count) : 0.0;
}

struct Query {
    Vec2 film, aperture;
    Wavelengths wavelengths;
    Vec3 target;  // on the ray that they make
};

/// Rays that pass, over all of the frame, with targets from half a metre to 50 m away.
std::vector<Query> queriesOf(const LoadedScene& loaded) {
    constexpr std::uint32_t count = 2000;
    std::vector<Query> queries;
    for (std::uint32_t i = 0; i < count; ++i) {
        RandomStream random(0, i, 0, RandomDomain::test);
        const Vec2 film = random.next2();
        Query query{{film.x * static_cast<float>(loaded.film.width),
                     film.y * static_cast<float>(loaded.film.height)},
                    random.next2(),
                    {},
                    {}};
        const auto ray = loaded.camera->sampleRay(query.film, query.aperture, query.wavelengths);
        if (!ray) continue;
        query.target = ray->origin + ray->direction * (0.5f * std::pow(100.0f, random.next()));
        queries.push_back(query);
    }
    return queries;
}

}  // namespace

BenchLens measureLens(const LoadedScene& loaded) {
    BenchLens lens;
    lens.description = loaded.lensModel;
    if (loaded.fit) {
        lens.terms = loaded.fit->terms;
        lens.fitErrorMrad = loaded.fit->directionMrad;
        lens.fitErrorMicrometres = loaded.fit->sensorMicrometres;
    }
    const std::vector<Query> queries = queriesOf(loaded);
    const Camera& camera = *loaded.camera;
    lens.rayNs = nanosecondsPer(queries.size(), [&](std::size_t i) {
        const auto ray =
            camera.sampleRay(queries[i].film, queries[i].aperture, queries[i].wavelengths);
        return ray ? ray->weight : 0.0f;
    });
    lens.connectNs = nanosecondsPer(queries.size(), [&](std::size_t i) {
        const auto connection =
            camera.connect(queries[i].target, queries[i].aperture, queries[i].wavelengths);
        return connection ? connection->distance : 0.0f;
    });
    return lens;
}

}  // namespace etendue
