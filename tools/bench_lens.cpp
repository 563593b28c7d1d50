#include "tools/bench_lens.h"

#include <cmath>

#include "lens/thread_time.h"
#include "renderer/random.h"

namespace etendue {

namespace {

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
    lens.rayNs = nanosecondsPer(queries, [&](const Query& query) {
        const auto ray = camera.sampleRay(query.film, query.aperture, query.wavelengths);
        return ray ? ray->weight : 0.0f;
    });
    lens.connectNs = nanosecondsPer(queries, [&](const Query& query) {
        const auto connection = camera.connect(query.target, query.aperture, query.wavelengths);
        return connection ? connection->distance : 0.0f;
    });
    return lens;
}

}  // namespace etendue
