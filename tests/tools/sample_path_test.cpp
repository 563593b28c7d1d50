// A sample traced again is the very same sample.
#include "tools/sample_path.h"

#include <doctest/doctest.h>

#include "renderer/parallel.h"
#include "tests/lens/prescriptions.h"
#include "tests/support/scenes.h"
#include "tests/tools/every_material_scene.h"

using namespace etendue;

namespace {

constexpr int width = 16, height = 12;

struct Case {
    explicit Case(const std::vector<std::string>& overrides,
                  const std::string& scene = everyMaterialScene)
        : loaded(sceneFromText(scene, overrides)),
          filter(loaded.film.filter, loaded.film.filterRadius),
          view{*loaded.scene, *loaded.camera, filter, loaded.film.color == FilmColor::xyz},
          estimator(makeEstimator(loaded.estimator)) {}

    SamplePath retrace(SampleId id) const {
        SamplePath path;
        retraceSample(view, *estimator, loaded.estimator, id, path);
        return path;
    }

    LoadedScene loaded;
    Filter filter;
    View view;
    std::unique_ptr<Estimator> estimator;
};

template <class Check>
void forEachSample(const Check& check) {
    const FlushDenormals flush;
    for (std::uint32_t sample = 0; sample < 40; ++sample)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) check(SampleId{7, x, y, sample});
}

bool isNear(const Spectrum& a, const Spectrum& b, float tolerance) {
    return maxLane(a - b) <= tolerance * maxLane(a) && maxLane(b - a) <= tolerance * maxLane(a);
}

void checkAgainstEstimator(const Case& c, std::size_t leastLit) {
    std::size_t wrong = 0, lit = 0, wrongSums = 0;
    forEachSample([&](SampleId id) {
        Sample sample;
        c.estimator->takeSample(c.view, id, {}, sample);
        Spectrum ownPixel, splatted;
        for (const Contribution& found : sample.contributions)
            (found.isSplat ? splatted : ownPixel) += found.value * found.weight;
        const SamplePath path = c.retrace(id);
        wrong += path.ownPixel != ownPixel || path.splatted != splatted;
        lit += !isBlack(ownPixel);
        Spectrum ownSum, splatSum;
        for (const Contribution& term : path.contributions)
            (term.isSplat ? splatSum : ownSum) += term.value * term.weight;
        // A dozen terms, each rounded a few times.
        wrongSums += !isNear(ownSum, ownPixel, 1e-5f) || !isNear(splatSum, splatted, 1e-5f);
    });
    CHECK(wrong == 0);
    CHECK(wrongSums == 0);
    CHECK(lit > leastLit);
}

}  // namespace

TEST_CASE("Sample path: path tracing traced again is the estimator's value, to the bit") {
    for (const std::string& setting :
         {std::string("estimator.russian_roulette_depth=2"), std::string("estimator.max_depth=1"),
          std::string("film.color=spectral"), dispersiveGlass}) {
        CAPTURE(setting);
        checkAgainstEstimator(Case({setting}), 2000);
    }
    const std::string lens = lensFile("double-gauss-50mm-f1.1.toml").string();
    const std::string scene = dispersiveFrame(lens) + everyMaterialRoom + lampAndSky + pointAndSun;
    for (const std::string& glass : {std::string("film.color=auto"), dispersiveGlass}) {
        CAPTURE(glass);
        checkAgainstEstimator(Case({glass}, scene), 1000);
    }
}

TEST_CASE(
    "Sample path: every vertex of path tracing lies where the ray from the one before leads") {
    const Case c({});
    std::size_t vertices = 0, off = 0, densities = 0;
    forEachSample([&](SampleId id) {
        const SamplePath path = c.retrace(id);
        const auto& walk = path.cameraPath.vertices;
        for (std::size_t i = 1; i < walk.size(); ++i) {
            ++vertices;
            const Vec3 back = walk[i - 1].point.position - walk[i].point.position;
            off += dot(walk[i].wo, back * (1.0f / length(back))) < 0.9999f;
            densities += walk[i].density.fromCamera > 0.0f;
        }
    });
    CHECK(vertices > 10000);
    CHECK(off == 0);
    CHECK(densities == vertices);
}

TEST_CASE("Sample path: the first vertex of path tracing is that of bidirectional walks") {
    // The camera sample of both is the same, and so is the first vertex with all that it carries.
    const Case pt({}), bdpt({"estimator.kind=bdpt"});
    std::size_t same = 0, different = 0;
    forEachSample([&](SampleId id) {
        const SamplePath a = pt.retrace(id), b = bdpt.retrace(id);
        if (a.cameraPath.vertices.size() < 2) return;
        const PathVertex &u = a.cameraPath.vertices[1], &v = b.cameraPath.vertices[1];
        const bool isSame = u.density.fromCamera == v.density.fromCamera &&
                            u.point.position == v.point.position && u.throughput == v.throughput;
        (isSame ? same : different) += 1;
    });
    CHECK(same > 2000);
    CHECK(different == 0);
}

TEST_CASE("Sample path: bidirectional contributions end on the vertices that are shown") {
    for (const std::string kind : {"lt", "bdpt"}) {
        CAPTURE(kind);
        const Case c({"estimator.kind=" + kind});
        std::size_t contributions = 0, tooLong = 0;
        forEachSample([&](SampleId id) {
            const SamplePath path = c.retrace(id);
            REQUIRE(path.lightPaths.size() == 1);
            CHECK(path.camera.has_value() == (kind == "bdpt"));
            for (const Contribution& found : path.contributions) {
                ++contributions;
                const auto s = static_cast<std::size_t>(found.technique.s);
                const auto t = static_cast<std::size_t>(found.technique.t);
                const bool isHit = s == 0 && path.cameraPath.escape;
                tooLong += s >= 2 && s > path.lightPaths[0].vertices.size();
                tooLong += t >= 2 && t > path.cameraPath.vertices.size() + (isHit ? 1 : 0);
            }
        });
        CHECK(contributions > 2000);
        CHECK(tooLong == 0);
    }
}

TEST_CASE("Sample path: what a light path brings to the lens follows from the vertex shown") {
    // s = 2 through the lens: the throughput of the vertex, its scattering, and the importance.
    const Case c({"estimator.kind=lt", "estimator.light_paths=3"});
    std::size_t checked = 0, wrong = 0;
    forEachSample([&](SampleId id) {
        const SamplePath path = c.retrace(id);
        REQUIRE(path.lightPaths.size() == 3);
        for (const Contribution& found : path.contributions) {
            if (found.technique.s != 2) continue;
            ++checked;
            // One of the three light paths has a vertex that the film point sees.
            bool isFound = false;
            for (const LightSubpath& light : path.lightPaths) {
                if (light.vertices.size() < 2) continue;
                const Vec3 seen = light.vertices[1].point.position;
                const auto ray = c.view.camera.sampleRay(found.film, {0.5f, 0.5f}, {});
                if (!ray) continue;
                const Vec3 toward = seen - ray->origin;
                isFound |= dot(toward, ray->direction) > 0.99f * length(toward);
            }
            wrong += !isFound;
        }
    });
    CHECK(checked > 500);
    CHECK(wrong == 0);
}
