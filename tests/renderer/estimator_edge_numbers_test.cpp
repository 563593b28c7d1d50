// Random numbers at the edge of their range, in what every sample draws before it meets the scene.
// Lights, BSDFs, distributions and the maps of the unit square have such tests of their own.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "tests/renderer/small_scenes.h"

using namespace etendue;

namespace {

constexpr float edges[] = {0.0f, 0x1p-32f, 0.5f, 1.0f - 0x1p-24f};

}  // namespace

TEST_CASE("Edge numbers: a filter's offset lies in it, where its density is positive") {
    for (const FilterKind kind :
         {FilterKind::box, FilterKind::gaussian, FilterKind::blackmanHarris})
        for (const float radius : {0.01f, 0.5f, 16.0f})
            for (const float x : edges)
                for (const float y : edges) {
                    const Filter filter(kind, radius);
                    const Vec2 offset = filter.sample({x, y});
                    CAPTURE(static_cast<int>(kind));
                    CAPTURE(offset.x);
                    CAPTURE(offset.y);
                    CHECK(std::abs(offset.x) <= radius);
                    CHECK(std::abs(offset.y) <= radius);
                    CHECK(offset.x < radius);
                    CHECK(offset.y < radius);
                    CHECK(filter.pdfFilm(offset) > 0.0f);
                    CHECK(std::isfinite(filter.pdfFilm(offset)));
                }
}

TEST_CASE("Edge numbers: wavelengths lie in the visible range, and the film takes their light") {
    for (const float u : edges) {
        CAPTURE(u);
        const SpectralSample sample = sampleWavelengths(u);
        for (const float nm : sample.wavelengths.nm) {
            CHECK(nm >= Wavelengths::shortestNm);
            CHECK(nm <= Wavelengths::longestNm);
        }
        CHECK(isUsable(sample.onFilm(sample.wavelengths.lanesOf(rgb(1, 1, 1)))));
    }
}

TEST_CASE("Edge numbers: every lens has a finite ray there, or none") {
    const std::string lens =
        "lens = \"" +
        (std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses/tessar-100mm.toml")
            .string() +
        "\"\nterms = 12\ndegree = 5\nf_number = 8\n";
    for (const std::string& camera :
         {std::string("model = \"pinhole\"\n"),
          std::string("model = \"thin-lens\"\nf_number = 0.7\nfocus_distance = inf\n"), lens,
          lens + "blades = 5\nrepresentation = \"sensor-state\"\n",
          lens + "blades = 6\nblade_roundness = 0.5\nrepresentation = \"traced\"\n"}) {
        CAPTURE(camera);
        const LoadedScene loaded =
            sceneFromText(film() + "[camera]\n" + camera + atOrigin + shiningWall(2.0, 1.0));
        int rays = 0;
        for (const float u : edges)
            for (const float x : edges)
                for (const float y : edges)
                    for (const Vec2 film : {Vec2{0, 0}, Vec2{6, 4}, Vec2{12, 8}}) {
                        const Wavelengths wavelengths = sampleWavelengths(u).wavelengths;
                        const auto ray = loaded.camera->sampleRay(film, {x, y}, wavelengths);
                        if (!ray) continue;
                        ++rays;
                        CHECK(isFinite(ray->origin));
                        CHECK(std::abs(length(ray->direction) - 1.0f) < 1e-6f);
                        CHECK(std::isfinite(ray->weight));
                        CHECK(ray->weight >= 0.0f);
                        // Back by the same aperture point.
                        const Vec3 point = ray->origin + ray->direction * 2.0f;
                        const auto back = loaded.camera->connect(point, {x, y}, wavelengths);
                        if (!back) continue;
                        CHECK(std::isfinite(back->film.x));
                        CHECK(std::isfinite(back->film.y));
                        CHECK(std::isfinite(importance(back->ray, back->distance, {0, 0, 1})));
                    }
        CHECK(rays > 0);
    }
}
