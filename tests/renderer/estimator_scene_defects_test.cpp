// Defects that other renderers' trackers report of what is in the scene: shading normals, mirrored
// instances, degenerate lamps, skies.
#include <doctest/doctest.h>

#include <cmath>

#include "renderer/image_io.h"
#include "tests/renderer/small_scenes.h"

using namespace etendue;

TEST_SUITE_BEGIN("statistical");

namespace {

constexpr int width = 12;

std::vector<Picture> pictures(LoadedScene& loaded, const std::string& kind, std::uint32_t samples,
                              std::uint64_t firstSeed) {
    loaded.estimator.kind = kind;
    std::vector<Picture> result;
    for (std::uint64_t seed = 0; seed < 16; ++seed)
        result.push_back(renderPixels(loaded, samples, firstSeed + seed, 2));
    return result;
}

void checkSame(const std::vector<Picture>& a, const std::vector<Picture>& b, double bound) {
    const PictureComparison comparison = comparePictures(a, b, width, 4);
    CAPTURE(comparison.smallestP);
    CAPTURE(comparison.relativeBias);
    CAPTURE(comparison.relativeBiasHalfWidth);
    CHECK(comparison.agree());
    CHECK(comparison.isEquivalent(bound));
}

/// Left for right.
std::vector<Picture> mirrored(std::vector<Picture> all) {
    constexpr std::size_t row = 3 * width;
    for (Picture& picture : all) {
        const Picture original = picture;
        for (std::size_t i = 0; i < picture.size(); ++i)
            picture[i] = original[i / row * row + (row / 3 - 1 - i % row / 3) * 3 + i % 3];
    }
    return all;
}

/// A room in which left is not right. `last` is the last step of every transform. Of instances each
/// has another one far below: a mesh that is placed once is none.
std::string lopsidedRoom(const std::string& last, bool asInstances) {
    std::string text = material("grey", grey) + material("lamp", black, 9.0) +
                       "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nroughness = 0.6\n";
    int count = 0;
    const auto add = [&](const std::string& shape, const std::string& of,
                         const std::string& place) {
        if (!asInstances) {
            text += mesh(shape, of, place + last);
            return;
        }
        const std::string name = "part" + std::to_string(++count);
        text += mesh(shape, of, "") + "name = \"" + name + "\"\nhidden = true\n";
        for (const std::string away : {"", ", {translate = [0, -50, 0]}"})
            text += "[[instance]]\nmesh = \"" + name + "\"\ntransform = [" + place + last + away +
                    "]\n";
    };
    add("rectangle", "grey", "{scale = 3}, {rotate = [1, 0, 0, -90]}");
    add("rectangle", "grey", "{scale = 3}, {translate = [0, 1, -1]}");
    add("box", "grey", "{scale = 0.4}, {translate = [0.5, 0.4, 0]}");
    add("sphere", "glass", "{scale = 0.4}, {translate = [-0.6, 0.5, 0.3]}");
    // Facing right and down: with its back in front it would light next to nothing.
    add("rectangle", "lamp",
        "{scale = 0.4}, {rotate = [1, 0, 0, 90]}, {rotate = [0, 0, 1, 40]}, {translate = [-1, 2, "
        "0.3]}");
    return text;
}

}  // namespace

TEST_CASE("Estimators: shading normals far off the surface's, on a floor and on a ball") {
    // Of radiance nothing is asked; importance needs Veach's factor.
    const TemporaryFolder folder;
    folder.write("bumps.obj", bumpyFloor(40.0));
    LoadedScene loaded = loadScene(
        folder.write("scene.toml",
                     film() + thinLens("from = [0.2, 1.6, 3.9]\nto = [0, 0.4, 0]\n", 2.0, "3.4") +
                         material("grey", grey) + material("lamp", black, 9.0) +
                         "[[mesh]]\nfile = \"bumps.obj\"\nmaterial = \"grey\"\n" +
                         mesh("sphere", "grey", "{scale = 0.7}, {translate = [0.3, 0.8, 0]}") +
                         "segments = 12\n" +
                         mesh("rectangle", "lamp",
                              "{scale = 0.8}, {rotate = [1, 0, 0, 90]}, {translate = [-0.4, 2.2, "
                              "0.3]}")),
        {{}, 8});
    const auto reference = pictures(loaded, "pt", 256, 1);
    for (const char* kind : {"lt", "bdpt"}) {
        CAPTURE(std::string(kind));
        checkSame(pictures(loaded, kind, 256, 1001), reference, 0.02);
    }
}

TEST_CASE("Estimators: a tilted plane of one radiance is even, whatever connects it to the lens") {
    LoadedScene loaded =
        sceneFromText(film() + thinLens(atOrigin, 1.4, "1") + material("shine", black, 1.0) +
                      mesh("rectangle", "shine",
                           "{scale = 4}, {rotate = [0, 1, 0, 65]}, {translate = [0, 0, -1.5]}"));
    const auto reference = pictures(loaded, "pt", 64, 1);
    checkSame(pictures(loaded, "lt", 1024, 1001), reference, 0.05);
    checkSame(pictures(loaded, "bdpt", 64, 1001), reference, 0.01);
}

TEST_CASE("Estimators: a mirrored scene is the mirrored picture") {
    const std::string from = "from = [-0.2, 1, 3.9]\nto = [0, 0.9, 0]\n";
    const std::string flip = ", {scale = [-1, 1, 1]}";
    for (const bool asInstances : {false, true}) {
        CAPTURE(asInstances);
        LoadedScene plain =
            sceneFromText(film() + thinLens(standing, 2.0, "3.4") + lopsidedRoom("", asInstances));
        LoadedScene flipped =
            sceneFromText(film() + thinLens(from, 2.0, "3.4") + lopsidedRoom(flip, asInstances));
        for (const char* kind : kinds) {
            CAPTURE(std::string(kind));
            checkSame(mirrored(pictures(flipped, kind, 128, 1001)), pictures(plain, kind, 128, 1),
                      0.1);
        }
    }
}

TEST_CASE("Estimators: a lamp with faces of no area is the lamp without them") {
    // Nine squares; of the other faces two use a corner twice, one has its corners in a line.
    std::string corners, faces;
    for (int j = 0; j <= 3; ++j)
        for (int i = 0; i <= 3; ++i)
            corners += "v " + number(-1 + i / 1.5) + " " + number(-1 + j / 1.5) + " 0\n";
    for (int j = 0; j < 3; ++j)
        for (int i = 1; i <= 3; ++i) {
            const int v = 4 * j + i;
            faces += "f " + std::to_string(v) + " " + std::to_string(v + 1) + " " +
                     std::to_string(v + 5) + " " + std::to_string(v + 4) + "\n";
        }
    const TemporaryFolder folder;
    folder.write("plain.obj", corners + faces);
    folder.write("degenerate.obj", corners + "f 1 1 2\n" + faces + "f 5 6 7\nf 3 3 3\n");
    const auto with = [&](const std::string& file) {
        return loadScene(
            folder.write(file + ".toml",
                         film() + thinLens(standing, 2.0, "3.4") + room(1.0, 0.0) +
                             material("panel", black, 9.0) + "[[mesh]]\nfile = \"" + file +
                             "\"\nmaterial = \"panel\"\ntransform = [{scale = 0.4}, {rotate = [1, "
                             "0, 0, 90]}, {translate = [-0.4, 2.1, 0.3]}]\n"),
            {{}, 8});
    };
    LoadedScene plain = with("plain.obj"), degenerate = with("degenerate.obj");
    for (const char* kind : kinds) {
        CAPTURE(std::string(kind));
        checkSame(pictures(degenerate, kind, 64, 1001), pictures(plain, kind, 64, 1), 0.1);
    }
}

TEST_CASE("Estimators: an empty scene under a sky of an image is the sky") {
    const TemporaryFolder folder;
    ExrChannels texels{{"R", "G", "B"}, {}};
    RandomStream random(6, 0, 0, RandomDomain::test);
    for (int i = 0; i < 8 * 4 * 3; ++i) texels.pixels.push_back(random.next());
    writeExr(folder / "sky.exr", {8, 4, 0, 0, 8, 4}, {texels}, {});
    LoadedScene loaded = loadScene(
        folder.write("scene.toml", film() + pinhole(atOrigin, 100.0) +
                                       "[[light]]\ntype = \"environment\"\nimage = \"sky.exr\"\n"),
        {{}, 8});
    const auto reference = pictures(loaded, "pt", 256, 1);
    checkSame(pictures(loaded, "lt", 512, 1001), reference, 0.04);
    checkSame(pictures(loaded, "bdpt", 256, 1001), reference, 0.02);
    // Of escaping camera paths alone it is path tracing's, sample by sample.
    loaded.estimator.techniques = TechniqueSet::parse("s0").value();
    const auto escaping = pictures(loaded, "bdpt", 4, 1), traced = pictures(loaded, "pt", 4, 1);
    for (std::size_t seed = 0; seed < traced.size(); ++seed)
        for (std::size_t i = 0; i < traced[seed].size(); ++i)
            // Two roundings each.
            CHECK(std::abs(escaping[seed][i] - traced[seed][i]) <= 4 * 0x1p-24f * traced[seed][i]);
}

TEST_SUITE_END();
