// Scenes that look through a lens of glass.
#include <doctest/doctest.h>

#include <cmath>

#include "renderer/scene_loader.h"
#include "tests/support/scenes.h"
#include "tests/support/temporary_folder.h"

namespace etendue {
namespace {

const Wavelengths green;

std::string lensFile(const std::string& name) {
    return (std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses" / name).string();
}

std::string sceneWith(const std::string& lens, const std::string& more) {
    return "[film]\nwidth = 72\nheight = 48\n[camera]\nfrom = [0, 1, 4]\nto = [0, 1, 0]\nlens = "
           "\"" +
           lensFile(lens) + "\"\nterms = 12\ndegree = 5\n" + more +
           "[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";
}

LoadedScene loaded(const TemporaryFolder& folder, const std::string& text) {
    LoadOptions options;
    options.fitCache = folder.path() / "fits";
    return loadScene(folder.write("scene.toml", text), options);
}

std::string errorOf(const TemporaryFolder& folder, const std::string& text) {
    try {
        loaded(folder, text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST_CASE("Scene: a lens of glass, by its polynomials and by its trace, sees the same") {
    const TemporaryFolder folder;
    const auto with = [&](const char* representation) {
        return loaded(folder, sceneWith("double-gauss-100mm.toml",
                                        std::string("f_number = 8\nfocus_distance = 4\n"
                                                    "representation = \"") +
                                            representation + "\"\n"));
    };
    const LoadedScene traced = with("traced"), twoPoint = with("two-point"),
                      sensorState = with("sensor-state");
    CHECK(traced.fNumber == 8.0);
    CHECK(traced.focusDistance == doctest::Approx(4.0));
    for (const Vec2 film : {Vec2{36, 24}, Vec2{5, 40}, Vec2{70, 2}})
        for (const Vec2 u : {Vec2{0.3f, 0.2f}, Vec2{0.9f, 0.6f}}) {
            const auto exact = traced.camera->sampleRay(film, u, green);
            REQUIRE(exact.has_value());
            for (const LoadedScene* fitted : {&twoPoint, &sensorState}) {
                const auto ray = fitted->camera->sampleRay(film, u, green);
                REQUIRE(ray.has_value());
                // Of 10,000 rays, twelve terms of degree five put the worst off by 0.036 mrad in
                // the two-point form and 0.044 in the other, its throughput by 0.017 % and 0.043 %
                // (lens fit --terms 12 --degree 5 --f-number 8 --focus 4). Twice that; floats are
                // nothing to it.
                CHECK(length(ray->direction - exact->direction) <= 0.9e-4f);
                CHECK(std::abs(ray->weight - exact->weight) <= 0.9e-3f * exact->weight);
            }
        }
    // On the axis a uniform field of one reads one.
    double sum = 0.0;
    constexpr int grid = 40;
    for (int i = 0; i < grid * grid; ++i) {
        const Vec2 u{(static_cast<float>(i % grid) + 0.5f) / grid,
                     (static_cast<float>(i / grid) + 0.5f) / grid};
        const auto ray = twoPoint.camera->sampleRay({36, 24}, u, green);
        if (ray) sum += ray->weight;
    }
    CHECK(sum / (grid * grid) == doctest::Approx(1.0).epsilon(1e-3));
}

TEST_CASE("Scene: a lens is fitted once and then taken from the cache") {
    const TemporaryFolder folder;
    const std::string text = sceneWith("tessar-100mm.toml", "");
    const LoadedScene first = loaded(folder, text), second = loaded(folder, text);
    CHECK_FALSE(first.notes.empty());
    CHECK(second.notes.empty());
    CHECK(first.hash == second.hash);
    const auto a = first.camera->sampleRay({10, 10}, {0.4f, 0.7f}, green);
    const auto b = second.camera->sampleRay({10, 10}, {0.4f, 0.7f}, green);
    REQUIRE(a.has_value());
    REQUIRE(b.has_value());
    CHECK(a->direction == b->direction);
    CHECK(a->weight == b->weight);
}

TEST_CASE("Scene: a wide filter's film points beyond the edge still have rays") {
    const TemporaryFolder folder;
    const LoadedScene scene =
        loaded(folder,
               "[film]\nwidth = 72\nheight = 48\nfilter = \"gaussian\"\nfilter_radius = 2\n"
               "[camera]\nfrom = [0, 1, 4]\nto = [0, 1, 0]\nlens = \"" +
                   lensFile("tessar-100mm.toml") + "\"\nf_number = 11\nterms = 12\ndegree = 5\n");
    CHECK(scene.camera->sampleRay({-1.9f, 24}, {0.0f, 0.5f}, green).has_value());
    CHECK(scene.camera->sampleRay({36, 49.9f}, {0.0f, 0.5f}, green).has_value());
}

TEST_CASE("Scene: what a lens cannot be set to is an error at its key") {
    const TemporaryFolder folder;
    const auto error = [&](const std::string& more) {
        return errorOf(folder, sceneWith("tessar-100mm.toml", more));
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    CHECK(has(error("f_number = 1.4\n"), "scene.toml:10: camera.f_number"));
    CHECK(has(error("focus_distance = 0.2\n"), "scene.toml:10: camera.focus_distance"));
    CHECK(has(error("blades = 2\n"), "scene.toml:10: camera.blades"));
    CHECK(has(error("representation = \"two-pint\"\n"), "two-point"));
    CHECK(has(error("zoom = \"57 mm\"\n"), "57 mm"));
    CHECK(has(error("fov = 40\n"), "camera.fov"));
    CHECK(error("f_number = 5.6\nblades = 7\nblade_rotation = 10\nblade_roundness = 0.3\n") == "");
}

}  // namespace
}  // namespace etendue
