// Cameras that nobody placed.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "renderer/scene_loader.h"
#include "tests/support/scenes.h"
#include "tests/support/temporary_folder.h"

namespace etendue {
namespace {

/// Its corners touch the sphere that bounds it.
const std::string box =
    "[[mesh]]\nshape = \"box\"\n[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";
const double boxRadius = std::sqrt(3.0);

std::string boxThrough(const std::string& camera, int width, int height) {
    return "[film]\nwidth = " + std::to_string(width) + "\nheight = " + std::to_string(height) +
           "\n" + camera + box;
}

std::filesystem::path shippedCamera(const std::string& name) {
    return std::filesystem::path(__FILE__).parent_path() / "../../scenes/cameras" / name;
}

double distanceOf(const LoadedScene& loaded) { return length(toDouble(loaded.camera->position())); }

void checkSeesBox(const LoadedScene& loaded) {
    const CameraSettings& frame = loaded.camera->settings();
    for (int corner = 0; corner < 8; ++corner) {
        const auto side = [corner](int bit) { return corner & bit ? 1.0f : -1.0f; };
        const auto seen =
            loaded.camera->connect({side(1), side(2), side(4)}, {0.5f, 0.5f}, Wavelengths());
        REQUIRE(seen);
        CHECK(seen->film.x >= 0.0f);
        CHECK(seen->film.x <= static_cast<float>(frame.width));
        CHECK(seen->film.y >= 0.0f);
        CHECK(seen->film.y <= static_cast<float>(frame.height));
    }
}

TEST_CASE("Camera: one that nobody placed stands where it just sees the scene's bounds") {
    const std::string thinLens =
        "model = \"thin-lens\"\nf_number = 8\nfocus_distance = inf\n";  // as wide as its fov says
    for (const std::string& model : {std::string(), thinLens})
        for (const double fov : {20.0, 60.0, 130.0})
            for (const int height : {10, 20, 40}) {
                CAPTURE(model);
                CAPTURE(fov);
                CAPTURE(height);
                const LoadedScene loaded = sceneFromText(boxThrough(
                    "[camera]\n" + model + "fov = " + std::to_string(fov) + "\n", 20, height));
                const double halfTangent =
                    std::min(1.0, height / 20.0) * std::tan(fov * std::numbers::pi / 360.0);
                // A sphere of radius r fills a cone of half angle a from r / sin a. The bounds are
                // rounded up by 1e-6, the position by 6e-8.
                CHECK(distanceOf(loaded) ==
                      doctest::Approx(boxRadius / std::sin(std::atan(halfTangent))).epsilon(3e-6));
                checkSeesBox(loaded);
            }
}

TEST_CASE("Camera: keys of one that nobody placed change what they say and nothing else") {
    const LoadedScene plain = sceneFromText(boxThrough("", 20, 10));
    const double halfTangent = 0.5 * std::tan(35.0 * std::numbers::pi / 360.0);
    CHECK(distanceOf(plain) ==
          doctest::Approx(boxRadius / std::sin(std::atan(halfTangent))).epsilon(3e-6));
    const LoadedScene brighter = sceneFromText(boxThrough("", 20, 10), {"camera.exposure=1"});
    CHECK(brighter.camera->settings().exposureStops == 1.0);
    CHECK(brighter.camera->settings().worldFromLens == plain.camera->settings().worldFromLens);
    const auto a = plain.camera->sampleRay({0, 5}, {0.5f, 0.5f}, {});
    const auto b = brighter.camera->sampleRay({0, 5}, {0.5f, 0.5f}, {});
    REQUIRE((a && b));
    CHECK(length(a->direction - b->direction) == 0.0f);
    const LoadedScene wider = sceneFromText(boxThrough("", 20, 10), {"camera.fov=60"});
    CHECK(distanceOf(wider) < distanceOf(plain));
    const LoadedScene tilted = sceneFromText(boxThrough("[camera]\nup = [1, 0, 0]\n", 20, 10));
    CHECK(tilted.camera->position() == plain.camera->position());
    CHECK(tilted.camera->settings().worldFromLens.y.x > 0.8);
}

TEST_CASE("Camera: another file's sees all of a bare model and of a scene without one") {
    const TemporaryFolder folder;
    const auto model =
        folder.write("quad.obj", "v -1 -1 1\nv 1 -1 1\nv 1 1 -1\nv -1 1 -1\nf 1 2 3 4\n");
    const auto scene = folder.write("scene.toml", boxThrough("", 72, 48));
    for (const char* name : {"pinhole.toml", "thin-lens.toml", "double-gauss-traced.toml"})
        for (const auto& file : {model, scene}) {
            CAPTURE(std::string(name));
            LoadOptions options;
            options.camera = shippedCamera(name);
            const LoadedScene loaded = loadScene(file, options);
            checkSeesBox(loaded);
            CHECK(distanceOf(loaded) < 12.0);
        }
}

TEST_CASE("Camera: a long lens stands farther away than a short one") {
    const auto through = [](const char* lens) {
        return sceneFromText(boxThrough("[camera]\nrepresentation = \"traced\"\nlens = \"" +
                                            (shippedCamera("../lenses") / lens).string() + "\"\n",
                                        72, 48));
    };
    const LoadedScene longer = through("tessar-100mm.toml"), shorter = through("petzval-50mm.toml");
    checkSeesBox(longer);
    checkSeesBox(shorter);
    CHECK(distanceOf(longer) / distanceOf(shorter) == doctest::Approx(2.0).epsilon(0.05));
}

TEST_CASE("Camera: half a place, or one beyond all places, is refused") {
    const TemporaryFolder folder;
    LoadOptions options;
    options.camera = folder.write("camera.toml", "[camera]\nfrom = [0, 1, 9]\n");
    CHECK_THROWS_WITH_AS(loadScene(folder.write("scene.toml", box), options),
                         doctest::Contains("camera.toml:1: camera.to: missing"), InputError);
    CHECK_THROWS_WITH_AS(sceneFromText("[camera]\nfov = 0.01\n[[mesh]]\nshape = \"box\"\n"
                                       "transform = [{scale = 1e12}]\n"),
                         doctest::Contains("scene.toml:1: camera: the whole scene is in view"),
                         InputError);
}

}  // namespace
}  // namespace etendue
