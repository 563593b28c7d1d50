#include "renderer/scene_loader.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/scenes.h"

using namespace etendue;

namespace {

struct BadScene {
    const char* what;
    const char* text;
    std::vector<const char*> expected;  // fragments of the message
    ExitCode code = ExitCode::badInput;
};

const std::vector<BadScene> badScenes = {
    {"an unknown table", "[flim]\nwidth = 3\n", {"scene.toml:1", "flim", "film"}},
    {"an unknown key", "[film]\nwidht = 3\n", {"scene.toml:2", "film.widht", "width"}},
    {"a wrong type", "[film]\nwidth = \"wide\"\n", {"scene.toml:2", "film.width", "wide"}},
    {"a width of zero", "[film]\nwidth = 0\n", {"scene.toml:2", "film.width"}},
    {"a fraction of a pixel", "[film]\nwidth = 3.5\n", {"scene.toml:2", "film.width"}},
    {"an unknown filter", "[film]\nfilter = \"gausian\"\n", {"scene.toml:2", "gaussian"}},
    {"an unknown estimator", "[estimator]\nkind = \"ptt\"\n", {"scene.toml:2", "pt"}},
    {"negative samples", "[estimator]\nsamples = -4\n", {"scene.toml:2", "estimator.samples"}},
    {"techniques of longer paths than there are",
     "[estimator]\nkind = \"bdpt\"\ntechniques = \"s9t99,t14,s13\"\n",
     {"scene.toml:3: estimator.techniques: nothing is within max_depth = 12 edges: s9t99 needs "
      "107, s13 needs 13, t14 needs 13"}},
    {"a camera without a place", "[camera]\nto = [0, 0, 1]\n", {"camera.from"}},
    {"a camera that looks nowhere",
     "[camera]\nfrom = [1, 2, 3]\nto = [1, 2, 3]\n",
     {"scene.toml:3", "camera.to"}},
    {"up along the view",
     "[camera]\nfrom = [0, 0, 0]\nto = [0, 5, 0]\n",
     {"camera.up", "parallel"}},
    {"a position that is not finite",
     "[camera]\nfrom = [0, nan, 0]\nto = [0, 0, 1]\n",
     {"scene.toml:2", "camera.from"}},
    {"a thin lens without f-number",
     "[camera]\nmodel = \"thin-lens\"\nfrom = [0, 0, 0]\nto = [0, 0, 1]\n",
     {"camera.f_number"}},
    {"a negative f-number",
     "[camera]\nmodel = \"thin-lens\"\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nf_number = "
     "-2\nfocus_distance = 1\n",
     {"scene.toml:5", "camera.f_number"}},
    {"focus inside the lens",
     "[camera]\nmodel = \"thin-lens\"\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nf_number = "
     "2\nfocus_distance = 0.1\n",
     {"scene.toml:6", "camera.focus_distance", "0.2"}},
    {"focus beyond the frame",
     "[camera]\nmodel = \"thin-lens\"\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nf_number = "
     "2\nfocus_pixel = [1000, 1]\n",
     {"scene.toml:6: camera.focus_pixel: must lie in the frame of 720 × 480 pixels"}},
    {"focus above the frame",
     "[camera]\nmodel = \"thin-lens\"\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nf_number = "
     "2\nfocus_pixel = [1, -1]\n",
     {"scene.toml:6: camera.focus_pixel: must lie in the frame of 720 × 480 pixels"}},
    {"fov and focal length",
     "[camera]\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nfov = 40\nfocal_length_mm = 50\n",
     {"scene.toml:4", "fov"}},
    {"a pinhole's f-number",
     "[camera]\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nf_number = 2\n",
     {"scene.toml:4", "f_number"}},
    {"a lens and a model",
     "[camera]\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nmodel = \"pinhole\"\nlens = \"a.toml\"\n",
     {"scene.toml:4", "camera.model", "either"}},
    {"a lens that is not there",
     "[camera]\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nlens = \"a.toml\"\n",
     {"scene.toml:4", "camera.lens", "a.toml"},
     ExitCode::missingFile},
    {"a material without a name", "[[material]]\ntype = \"diffuse\"\n", {"scene.toml:1", "name"}},
    {"two materials of one name",
     "[[material]]\nname = \"a\"\n[[material]]\nname = \"a\"\n",
     {"scene.toml:4", "earlier"}},
    {"an unknown type", "[[material]]\nname = \"a\"\ntype = \"glas\"\n", {"scene.toml:3", "glas"}},
    {"reflectance above one",
     "[[material]]\nname = \"a\"\ncolor = [1.2, 1, 1]\n",
     {"scene.toml:3", "color"}},
    {"two numbers for a colour",
     "[[material]]\nname = \"a\"\ncolor = [1, 1]\n",
     {"scene.toml:3", "color", "3"}},
    {"negative emission",
     "[[material]]\nname = \"a\"\nemission = [-1, 0, 0]\n",
     {"scene.toml:3", "emission"}},
    {"an ior of zero",
     "[[material]]\nname = \"a\"\ntype = \"dielectric\"\nior = 0\n",
     {"scene.toml:4", "ior"}},
    {"a key of another type",
     "[[material]]\nname = \"a\"\ntype = \"diffuse\"\nior = 1.5\n",
     {"scene.toml:4", "ior"}},
    {"an unknown metal",
     "[[material]]\nname = \"a\"\ntype = \"conductor\"\nmetal = \"glod\"\n",
     {"scene.toml:4", "gold"}},
    {"a missing texture",
     "[[material]]\nname = \"a\"\ncolor = \"none.png\"\n",
     {"scene.toml:3", "none.png"},
     ExitCode::missingFile},
    {"emission behind a mask",
     "[[material]]\nname = \"a\"\nemission = [1, 1, 1]\nopacity = 0.5\n",
     {"scene.toml:4", "opacity"}},
    {"a mesh of nothing", "[[mesh]]\nname = \"a\"\n", {"scene.toml:1", "file", "shape"}},
    {"a missing OBJ",
     "[[mesh]]\nfile = \"none.obj\"\n",
     {"scene.toml:2", "none.obj"},
     ExitCode::missingFile},
    {"an unknown shape", "[[mesh]]\nshape = \"spere\"\n", {"scene.toml:2", "sphere"}},
    {"two segments", "[[mesh]]\nshape = \"sphere\"\nsegments = 2\n", {"scene.toml:3", "segments"}},
    {"an unknown material",
     "[[material]]\nname = \"red\"\n[[mesh]]\nshape = \"box\"\nmaterial = \"rde\"\n",
     {"scene.toml:5", "red"}},
    {"a material where there is none",
     "[[mesh]]\nshape = \"box\"\nmaterial = \"glas\"\n",
     {"scene.toml:3: mesh[0].material: ", "(there are none), got \"glas\""}},
    {"an instance where no mesh has a name",
     "[[mesh]]\nshape = \"box\"\n[[instance]]\nmesh = \"crate\"\n",
     {"scene.toml:4: instance[0].mesh: ", "(there are none), got \"crate\""}},
    {"a scale of zero",
     "[[mesh]]\nshape = \"box\"\ntransform = [{scale = 0}]\n",
     {"scene.toml:3", "scale", "zero"}},
    {"a flattening scale",
     "[[mesh]]\nshape = \"box\"\ntransform = [{scale = [1, 0, 1]}]\n",
     {"scene.toml:3", "scale"}},
    {"a rotation about nothing",
     "[[mesh]]\nshape = \"box\"\ntransform = [{rotate = [0, 0, 0, 90]}]\n",
     {"scene.toml:3", "rotate", "axis"}},
    {"two operations in one step",
     "[[mesh]]\nshape = \"box\"\ntransform = [{scale = 2, translate = [1, 0, 0]}]\n",
     {"scene.toml:3", "transform"}},
    {"an unknown operation",
     "[[mesh]]\nshape = \"box\"\ntransform = [{scael = 2}]\n",
     {"scene.toml:3", "scael"}},
    {"vertices out of float's reach",
     "[[mesh]]\nshape = \"box\"\ntransform = [{scale = 1e10}, {scale = 1e10}]\n",
     {"1e15"}},
    {"an instance of nothing",
     "[[mesh]]\nshape = \"box\"\nname = \"crate\"\n[[instance]]\nmesh = \"craet\"\n",
     {"scene.toml:5", "crate"}},
    {"a lathe of one point",
     "[[mesh]]\nshape = \"lathe\"\nprofile = [[1, 0]]\n",
     {"scene.toml:3", "mesh[0].profile"}},
    {"a lathe of a negative radius",
     "[[mesh]]\nshape = \"lathe\"\nsegments = 8\nprofile = [[1, 0], [-1, 1]]\n",
     {"scene.toml:4: mesh[0].profile: ", "profile[1] has the radius -1"}},
    {"a lathe that folds over",
     "[[mesh]]\nshape = \"lathe\"\nprofile = [[1, 0], [1, 1]]\ncrease_angle = 180\n",
     {"scene.toml:4: mesh[0].crease_angle"}},
    {"an unknown light", "[[light]]\ntype = \"lamp\"\n", {"scene.toml:2", "type"}},
    {"negative intensity",
     "[[light]]\ntype = \"point\"\nposition = [0, 0, 0]\nintensity = [-1, 1, 1]\n",
     {"scene.toml:4", "intensity"}},
    {"a spot inside out",
     "[[light]]\ntype = \"spot\"\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nintensity = [1, 1, "
     "1]\ninner_angle = 50\nouter_angle = 40\n",
     {"scene.toml:6", "inner_angle"}},
    {"a direction of zero",
     "[[light]]\ntype = \"directional\"\ndirection = [0, 0, 0]\nirradiance = [1, 1, 1]\n",
     {"scene.toml:3", "direction"}},
    {"an environment that is squeezed",
     "[[light]]\ntype = \"environment\"\nimage = \"scene.toml\"\nrotation = [{scale = 2}]\n",
     {"scene.toml"}},
    {"a missing include",
     "include = [\"none.toml\"]\n",
     {"scene.toml:1", "none.toml"},
     ExitCode::missingFile},
    {"a camera farther than anything may be",
     "[camera]\nfrom = [0, 0, 1e16]\nto = [0, 0, 0]\n",
     {"scene.toml:2", "camera.from[2]", "from -1e+15 to 1e+15"}},
    {"a point light farther than anything may be",
     "[[light]]\ntype = \"point\"\nposition = [-1e16, 0, 0]\nintensity = [1, 1, 1]\n",
     {"scene.toml:3", "light[0].position[0]", "from -1e+15 to 1e+15"}},
    {"a mesh shrunk beyond what floats turn back",
     "[[mesh]]\nshape = \"box\"\ntransform = [{scale = 1e-12}, {scale = 1e-12}]\n",
     {"scene.toml:3", "mesh[0].transform", "more than 1e12 times"}},
    {"a mesh shrunk to nothing",
     "[[mesh]]\nshape = \"box\"\ntransform = [{scale = 1e-80}, {scale = 1e-80}]\n",
     {"scene.toml:3", "mesh[0].transform"}},
    {"a mesh flattened by what adds up",
     "[[mesh]]\nshape = \"box\"\ntransform = [{scale = [1, 1, 1e-9]}, {rotate = [1, 0, 0, 90]}, "
     "{scale = [1, 1e-9, 1]}]\n",
     {"scene.toml:3", "mesh[0].transform"}},
    {"a scene that includes itself", "include = [\"scene.toml\"]\n", {"include"}},
    {"no TOML at all", "v 0 0 0\n", {"scene.toml:1"}},
};

const char* quad = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\n";

}  // namespace

TEST_CASE(
    "Scene loader: every bad scene gets one clear error with its place and the right exit code") {
    for (const BadScene& bad : badScenes) {
        CAPTURE(std::string(bad.what));
        try {
            sceneFromText(bad.text);
            FAIL_CHECK("accepted");
        } catch (const InputError& error) {
            const std::string message = error.what();
            CAPTURE(message);
            CHECK(error.code() == bad.code);
            for (const char* fragment : bad.expected)
                CHECK_MESSAGE(message.find(fragment) != std::string::npos, fragment);
        }
    }
}

TEST_CASE("Scene loader: a bare model gets a camera and a soft light") {
    const TemporaryFolder folder;
    const auto file = folder.write("quad.obj", std::string(quad) + "f 4 3 2 1\n");
    const LoadedScene loaded = loadScene(file, {{"film.width=16", "film.height=16"}, 1});
    CHECK(loaded.scene->triangleCount() == 2);
    CHECK(loaded.scene->lights().size() == 1);
    REQUIRE_FALSE(loaded.notes.empty());
    float centre = 0.0f;
    const std::vector<float> pixels = renderPixels(loaded, 16, 1);
    centre = pixels[(8 * 16 + 8) * 3];
    CHECK(centre > 0.05f);
    CHECK(centre < 2.0f);
}

TEST_CASE("Scene loader: a bare model that emits gets no further light") {
    const TemporaryFolder folder;
    folder.write("m.mtl", "newmtl lamp\nKd 0 0 0\nKe 3 3 3\n");
    const auto file =
        folder.write("quad.obj", std::string("mtllib m.mtl\n") + quad + "usemtl lamp\nf 4 3 2 1\n");
    CHECK(loadScene(file, {{}, 1}).scene->lights().size() == 1);
}

TEST_CASE("Scene loader: the scene's own material replaces the MTL's of the same name") {
    const TemporaryFolder folder;
    folder.write("m.mtl", "newmtl a\nKd 0.1 0.1 0.1\nnewmtl b\nKd 0.2 0.2 0.2\n");
    folder.write("quad.obj",
                 std::string("mtllib m.mtl\n") + quad + "usemtl a\nf 4 3 2\nusemtl b\nf 4 2 1\n");
    const auto file = folder.write(
        "scene.toml",
        "[[material]]\nname = \"b\"\ncolor = [0.7, 0.7, 0.7]\n[[mesh]]\nfile = \"quad.obj\"\n");
    const LoadedScene loaded = loadScene(file, {{}, 1});
    const auto albedoAt = [&](float x, float z) {
        const auto point = loaded.scene->closestHit({{x, 1.0f, z}, {0, -1, 0}});
        REQUIRE(point);
        return point->material->bsdf->albedo({})[0];
    };
    CHECK(albedoAt(0.5f, 0.0f) == doctest::Approx(0.1));
    CHECK(albedoAt(-0.5f, 0.0f) == doctest::Approx(0.7));
}

TEST_CASE("Scene loader: a light mesh with degenerate faces is the light without them") {
    const std::string lamp =
        "[[material]]\nname = \"lamp\"\nemission = [2, 2, 2]\n[[mesh]]\nmaterial = \"lamp\"\nfile "
        "= ";
    const TemporaryFolder folder;
    folder.write("plain.obj", std::string(quad) + "f 4 3 2\nf 4 2 1\n");
    folder.write("degenerate.obj", std::string(quad) + "f 4 3 2\nf 1 1 2\nf 4 2 1\nf 3 3 3\n");
    const LoadedScene plain = loadScene(folder.write("a.toml", lamp + "\"plain.obj\"\n"), {{}, 1});
    const LoadedScene degenerate =
        loadScene(folder.write("b.toml", lamp + "\"degenerate.obj\"\n"), {{}, 1});
    CHECK(degenerate.scene->lights()[0].power() == plain.scene->lights()[0].power());
    CHECK(degenerate.scene->triangleCount() == 2);
}

TEST_CASE("Scene loader: a light of no area at all is an error or no light, never a crash") {
    const TemporaryFolder folder;
    folder.write("none.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    const auto file = folder.write("scene.toml",
                                   "[[material]]\nname = \"lamp\"\nemission = [2, 2, "
                                   "2]\n[[mesh]]\nmaterial = \"lamp\"\nfile = \"none.obj\"\n");
    CHECK_THROWS_AS(loadScene(file, {{}, 1}), InputError);
}

TEST_CASE("Scene loader: a bare model that reaches farther than anything may is refused") {
    const TemporaryFolder folder;
    const auto file = folder.write("far.obj", "v 0 0 0\nv 1e16 0 0\nv 0 1e14 0\nf 1 2 3\n");
    CHECK_THROWS_WITH_AS(loadScene(file, {{}, 1}), doctest::Contains("far.obj: a vertex beyond"),
                         InputError);
}

TEST_CASE("Scene loader: includes add their tables, and overrides come last") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "parts");
    folder.write("parts/box.toml",
                 "[[material]]\nname = \"red\"\ncolor = [1, 0, 0]\n[[mesh]]\nfile = "
                 "\"quad.obj\"\nmaterial = \"red\"\n");
    folder.write("parts/quad.obj", std::string(quad) + "f 4 3 2 1\n");
    const auto file =
        folder.write("scene.toml", "include = [\"parts/box.toml\"]\n[film]\nwidth = 20\n");
    const LoadedScene loaded =
        loadScene(file, {{"film.width=30", "material.red.color=[0, 1, 0]"}, 1});
    CHECK(loaded.film.width == 30);
    CHECK(loaded.scene->triangleCount() == 2);
    const auto point = loaded.scene->closestHit({{0, 1, 0}, {0, -1, 0}});
    REQUIRE(point);
    CHECK(point->material->bsdf->albedo({})[1] == 1.0f);
}

TEST_CASE("Scene loader: includes that double at every level are refused") {
    const TemporaryFolder folder;
    for (int i = 0; i < 12; ++i) {
        const std::string next = "\"" + std::to_string(i + 1) + ".toml\"";
        folder.write(std::to_string(i) + ".toml", "include = [" + next + ", " + next + "]\n");
    }
    folder.write("12.toml", "");
    CHECK_THROWS_WITH_AS(loadScene(folder / "0.toml", {{}, 1}),
                         doctest::Contains(".toml:1: include: includes add up to more than 1000"),
                         InputError);
    CHECK(loadScene(folder / "4.toml", {{}, 1}).scene != nullptr);  // 511 files
}

TEST_CASE("Scene loader: the hash follows the contents of every file and the overrides") {
    const TemporaryFolder folder;
    const auto write = [&](const std::string& faces) {
        folder.write("quad.obj", quad + faces);
        return folder.write("scene.toml", "[[mesh]]\nfile = \"quad.obj\"\n");
    };
    const auto file = write("f 4 3 2 1\n");
    const std::string first = loadScene(file, {{}, 1}).hash;
    CHECK(first.size() == 32);
    CHECK(loadScene(file, {{}, 1}).hash == first);
    CHECK(loadScene(file, {{"film.width=31"}, 1}).hash != first);
    write("f 1 2 3 4\n");
    CHECK(loadScene(file, {{}, 1}).hash != first);
}

TEST_CASE("Scene loader: the thin lens is focused where the distance from the sensor says") {
    const std::string text =
        "[film]\nwidth = 101\nheight = 101\n[camera]\nmodel = \"thin-lens\"\nfrom = [0, 0, 0]\nto "
        "= [0, 0, 1]\n"
        "f_number = 2\nfocus_distance = 2\n";
    const LoadedScene loaded = sceneFromText(text);
    // u + v = 2 m and 1/u + 1/v = 1/f: rays of the image's centre cross at u in front of the lens.
    const double u = 0.5 * (2.0 + std::sqrt(2.0 * (2.0 - 4 * 0.05)));
    for (const Vec2 lens : {Vec2{0.1f, 0.2f}, Vec2{0.9f, 0.6f}}) {
        const auto ray = loaded.camera->sampleRay({50.5f, 50.5f}, lens, {});
        REQUIRE(ray);
        const Vec3 p = ray->origin + ray->direction * (static_cast<float>(u) / ray->direction.z);
        // Float rounding of a position of 2 m.
        CHECK(std::abs(p.x) < 1e-6f);
        CHECK(std::abs(p.y) < 1e-6f);
    }
}

TEST_CASE("Scene loader: an environment with negative light is refused at the line that names it") {
    const TemporaryFolder folder;
    writeExr(folder / "sky.exr", {2, 1, 0, 0, 2, 1}, {{{"R", "G", "B"}, {1, 1, 1, 1, -1, 1}}}, {});
    const auto file =
        folder.write("scene.toml", "[[light]]\ntype = \"environment\"\nimage = \"sky.exr\"\n");
    try {
        loadScene(file, {{}, 1});
        FAIL_CHECK("accepted");
    } catch (const InputError& error) {
        const std::string message = error.what();
        CAPTURE(message);
        CHECK(message.find("scene.toml:3") != std::string::npos);
        CHECK(message.find("(1, 0)") != std::string::npos);
    }
}

TEST_CASE("Scene loader: a float image is no reflectance or opacity where it leaves 0 to 1") {
    const TemporaryFolder folder;
    const auto write = [&](const char* name, std::vector<float> pixels) {
        writeExr(folder / name, {2, 1, 0, 0, 2, 1}, {{{"R", "G", "B"}, std::move(pixels)}}, {});
    };
    write("share.exr", {0, 1, 0.5f, 1, 0, 0});
    write("bright.exr", {1, 1, 1, 1, 1.5f, 1});
    write("negative.exr", {0, 0, 0, -0.25f, 0, 0});
    const auto load = [&](const std::string& material) {
        return loadScene(folder.write("scene.toml", "[[material]]\nname = \"m\"\n" + material +
                                                        "[[mesh]]\nshape = \"sphere\"\n"
                                                        "material = \"m\"\n"),
                         {{}, 1});
    };
    for (const char* key : {"color", "opacity"}) {
        CAPTURE(key);
        load(std::string(key) + " = \"share.exr\"\n");
        for (const char* image : {"bright.exr", "negative.exr"}) {
            if (std::string(key) == "opacity" && std::string(image) == "bright.exr") continue;
            CAPTURE(image);
            try {
                load(std::string(key) + " = \"" + image + "\"\n");
                FAIL_CHECK("accepted");
            } catch (const InputError& error) {
                const std::string message = error.what();
                CAPTURE(message);
                CHECK(message.find(image) != std::string::npos);
                CHECK(message.find("texel (1, 0)") != std::string::npos);
            }
        }
    }
    // Of an opacity its first channel counts.
    load("opacity = \"bright.exr\"\n");
}

TEST_CASE("Scene loader: of a metal's image in an MTL the mean counts, with a note") {
    const TemporaryFolder folder;
    writeExr(folder / "red.exr", {2, 1, 0, 0, 2, 1}, {{{"R", "G", "B"}, {1, 0, 0, 0.5f, 0, 0}}},
             {});
    folder.write("ball.mtl", "newmtl m\nmap_Kd red.exr\nPm 1\n");
    const auto file = folder.write(
        "ball.obj",
        "mtllib ball.mtl\nusemtl m\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nvt 0 0\nf 3/1 2/1 1/1\n");
    const LoadedScene loaded = loadScene(file, {{}, 1});
    CHECK(std::any_of(loaded.notes.begin(), loaded.notes.end(), [](const std::string& note) {
        return note.find("map_Kd") != std::string::npos;
    }));
    const auto point = loaded.scene->closestHit({{0.5f, 1, -0.5f}, {0, -1, 0}});
    REQUIRE(point);
    const Spectrum albedo =
        point->material->bsdf->albedo(BsdfContext{point->uv, Transport::radiance});
    CHECK(albedo[0] > 0.6f);
    CHECK(albedo[0] < 0.9f);
    CHECK(albedo[1] < 0.2f);
}

TEST_CASE("Scene loader: a spot may be sharp at any angle") {
    CHECK_NOTHROW(
        sceneFromText(std::string(ballScene) +
                      "[[light]]\ntype = \"spot\"\nposition = [0, 2, 0]\ndirection = [0, -1, "
                      "0]\nintensity = [1, 1, 1]\nouter_angle = 25.3\ninner_angle = 25.3\n"));
}

TEST_CASE("Scene loader: techniques of longer paths than there are get a note beside others") {
    const auto notesFor = [](const char* techniques) {
        return sceneFromText(ballScene, {"estimator.kind=bdpt", "estimator.max_depth=4",
                                         "estimator.techniques=" + std::string(techniques)})
            .notes;
    };
    CHECK(notesFor("s0,t1,s4,t5,s3t2").empty());
    const std::vector<std::string> notes = notesFor("s0,s5,t6,s3t3");
    REQUIRE(notes.size() == 1);
    CHECK(notes[0] ==
          "estimator.techniques: beyond max_depth = 4 edges: s3t3 needs 5, s5 needs 5, t6 needs 5");
}

TEST_CASE("Scene loader: an error in a file that the scene names says where it is named") {
    const TemporaryFolder folder;
    folder.write("a.txt", "name = 1\n");
    const auto error = [&](const std::string& text) {
        try {
            loadScene(folder.write("scene.toml", text), {{}, 1});
        } catch (const InputError& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    const std::string named = " (named by " + (folder / "scene.toml").string() + ":2, ";
    for (const auto& [text, key] : std::vector<std::pair<const char*, const char*>>{
             {"[camera]\nlens = \"a.txt\"\n", "camera.lens"},
             {"[[mesh]]\nfile = \"a.txt\"\n", "mesh[0].file"},
             {"[[light]]\nimage = \"a.txt\"\ntype = \"environment\"\n", "light[0].image"},
             {"[[material]]\ncolor = \"a.txt\"\nname = \"m\"\n", "material[0].color"},
             {"[[material]]\nopacity = \"a.txt\"\nname = \"m\"\n", "material[0].opacity"}}) {
        const std::string message = error(text);
        CAPTURE(message);
        CHECK(message.starts_with((folder / "a.txt").string()));
        CHECK(message.ends_with(named + key + ")"));
    }
}
