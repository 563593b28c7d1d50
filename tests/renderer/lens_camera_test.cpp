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
    CHECK(has(error("zoom = \"57 mm\"\n"), "camera.zoom: this lens does not zoom"));
    CHECK(has(error("fov = 40\n"), "camera.fov"));
    CHECK(error("f_number = 5.6\nblades = 7\nblade_rotation = 10\nblade_roundness = 0.3\n") == "");
}

/// Two rays from one film point through opposite parts of the aperture cross at the depth that is
/// sharp there: metres along the axis from the lens' origin.
double sharpDepth(const Camera& camera, Vec2 film) {
    const auto a = camera.sampleRay(film, {0.5f, 0.1f}, green);
    const auto b = camera.sampleRay(film, {0.5f, 0.9f}, green);
    REQUIRE((a && b));
    const Vec3d apart = toDouble(b->origin) - toDouble(a->origin);
    const Vec3d da = toDouble(a->direction), db = toDouble(b->direction);
    // The nearest points of the two lines.
    const double along = dot(da, db), closing = 1.0 - along * along;
    const double t = (dot(apart, da) - dot(apart, db) * along) / closing;
    const Vec3d meeting = toDouble(a->origin) + da * t;
    return dot(meeting - toDouble(camera.position()), toDouble(camera.forward()));
}

const std::string wallAtFourMetres =
    "[[mesh]]\nshape = \"rectangle\"\ntransform = [{scale = 50}, {translate = [0, 1, 0]}]\n";

TEST_CASE("Scene: a lens is focused on a point, on what a pixel shows, or by its sensor") {
    const TemporaryFolder folder;
    // Stopped down, where spherical aberration no longer moves the focus.
    const std::string traced = "representation = \"traced\"\nf_number = 11\n";
    const auto depthWith = [&](const std::string& focus) {
        return sharpDepth(
            *loaded(folder, sceneWith("double-gauss-100mm.toml", traced + focus + wallAtFourMetres))
                 .camera,
            {36, 24});
    };
    // The exact rays at 550 nm and near the axis; the focus is the paraxial one at the d line.
    const doctest::Approx fourMetres = doctest::Approx(4.0).epsilon(0.02);
    CHECK(depthWith("focus_point = [0.5, 1.5, 0]\n") == fourMetres);
    CHECK(depthWith("focus_pixel = [36, 24]\n") == fourMetres);
    CHECK(depthWith("focus_point = [0, 1, 2]\n") == doctest::Approx(2.0).epsilon(0.02));
    // x x' = f²: for a shift of 2.6 mm the plane lies f²/2.6 mm = 3.8 m before the front focus.
    const LoadedScene shifted =
        loaded(folder, sceneWith("double-gauss-100mm.toml", traced + "sensor_shift_mm = 2.6\n"));
    const LoadedScene same = loaded(
        folder,
        sceneWith("double-gauss-100mm.toml",
                  traced + "focus_distance = " + std::to_string(shifted.focusDistance) + "\n"));
    CHECK(shifted.focusDistance == doctest::Approx(4.1).epsilon(0.03));
    const auto a = shifted.camera->sampleRay({10, 10}, {0.3f, 0.4f}, green);
    const auto b = same.camera->sampleRay({10, 10}, {0.3f, 0.4f}, green);
    REQUIRE((a && b));
    CHECK(length(a->direction - b->direction) < 1e-6f);
}

TEST_CASE("Scene: so is a thin lens") {
    const TemporaryFolder folder;
    const auto depthWith = [&](const std::string& focus) {
        const std::string text =
            "[film]\nwidth = 72\nheight = 48\n[camera]\nmodel = \"thin-lens\"\nfrom = [0, 1, 4]\n"
            "to = [0, 1, 0]\nf_number = 1\n" +
            focus + wallAtFourMetres + "[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";
        return sharpDepth(*loaded(folder, text).camera, {20, 30});
    };
    // Rays 40 mm apart, their directions rounded to 6e-8: they cross 4 m away to 4 m · 4 m · 1e-7 /
    // 40 mm = 4e-5 m, and a few roundings more.
    constexpr double rounding = 1e-3;
    CHECK(depthWith("focus_point = [0.5, 1.5, 0]\n") == doctest::Approx(4.0).epsilon(rounding));
    CHECK(depthWith("focus_pixel = [3, 4]\n") == doctest::Approx(4.0).epsilon(rounding));
    CHECK(depthWith("sensor_shift_mm = 0.5\n") == doctest::Approx(5.05).epsilon(rounding));
}

TEST_CASE("Scene: what cannot be focused on is named") {
    const TemporaryFolder folder;
    const auto errorWith = [&](const std::string& keys) {
        return errorOf(
            folder, sceneWith("double-gauss-100mm.toml", "representation = \"traced\"\n" + keys));
    };
    CHECK(errorWith("focus_distance = 3\nfocus_point = [0, 0, 0]\n").find("give one of") !=
          std::string::npos);
    CHECK(errorWith("focus_point = [0, 1, 5]\n").find("in front of the lens") != std::string::npos);
    CHECK(errorWith("focus_pixel = [36, 24]\n").find("nothing to be seen") != std::string::npos);
    CHECK(errorWith("focus_point = [0, 1, 3.95]\n").find("focus") != std::string::npos);
    CHECK(errorWith("sensor_shift_mm = 300\n").find("so far back") != std::string::npos);
}

TEST_CASE("Scene: a zoom position that the lens does not have is told at its key") {
    const TemporaryFolder folder;
    CHECK(errorOf(folder, sceneWith("zoom-57-143mm.toml", "zoom = \"57\"\n")) ==
          (folder / "scene.toml").string() +
              ":10: camera.zoom: expected one of \"57 mm\", \"143 mm\", got \"57\"");
}

TEST_CASE("Scene: a sensor off the axis sees the part of the picture that lies there") {
    const TemporaryFolder folder;
    for (const std::string representation : {"traced", "two-point"}) {
        const std::string keys =
            "focus_distance = 4\nrepresentation = \"" + representation + "\"\n";
        const LoadedScene centred = loaded(folder, sceneWith("double-gauss-100mm.toml", keys));
        const LoadedScene moved = loaded(
            folder, sceneWith("double-gauss-100mm.toml", keys + "sensor_offset_mm = [3, -2]\n"));
        // 36 mm on 72 pixels: 3 mm are 6 of them.
        const auto a = centred.camera->sampleRay({26, 20}, {0.7f, 0.4f}, green);
        const auto b = moved.camera->sampleRay({20, 24}, {0.7f, 0.4f}, green);
        REQUIRE((a && b));
        // Two fits, of different domains.
        const float tolerance = representation == "traced" ? 1e-6f : 5e-4f;
        CHECK(length(a->direction - b->direction) <= tolerance);
        const auto back =
            moved.camera->connect(b->origin + b->direction * 3.0f, {0.7f, 0.4f}, green);
        REQUIRE(back);
        CHECK(back->film.x == doctest::Approx(20.0).epsilon(1e-4));
        CHECK(back->film.y == doctest::Approx(24.0).epsilon(1e-4));
    }
}

TEST_CASE("Scene: another file's camera is looked through from where the scene's stands") {
    const TemporaryFolder folder;
    const auto scene = folder.write("scene.toml", sceneWith("double-gauss-100mm.toml", ""));
    LoadOptions options;
    options.camera = folder.write("camera.toml", "[camera]\nmodel = \"pinhole\"\nfov = 30\n");
    const LoadedScene pinhole = loadScene(scene, options);
    CHECK(pinhole.fNumber == 0.0);
    CHECK(length(pinhole.camera->position() - Vec3{0, 1, 4}) == 0.0f);
    CHECK(pinhole.hash != loadScene(scene, {}).hash);
    options.camera = folder.write("camera.toml", "[camera]\nfrom = [0, 1, 9]\n[film]\nwidth = 3\n");
    CHECK_THROWS_WITH_AS(loadScene(scene, options),
                         doctest::Contains("a camera file has a [camera] table and nothing else"),
                         InputError);
}

}  // namespace
}  // namespace etendue
