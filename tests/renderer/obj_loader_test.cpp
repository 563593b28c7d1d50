#include "renderer/obj_loader.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/renderer/obj_fixture.h"

namespace etendue {

TEST_CASE("loadObj: a cube of quadrilaterals is closed, outward, and shares its corners") {
    const ObjFixture fixture;
    const ObjModel model = fixture.load(cubeText);
    checkIsConsistent(model);
    CHECK(model.mesh.name == "model");
    CHECK(model.mesh.positions.size() == 8);
    CHECK(model.mesh.triangles.size() == 12);
    CHECK(model.mesh.normals.empty());
    CHECK(std::abs(volumeOf(model.mesh) - 1.0) <= 12 * 0x1p-53);  // twelve roundings below 1
    CHECK(areaOf(model.mesh) == 6.0);
    CHECK(countEdges(model.mesh).faulty == 0);
    CHECK(countEdges(model.mesh).boundary == 0);
    CHECK(model.files == std::vector{fixture.file()});
}

TEST_CASE("loadObj: the same model, however it is written") {
    const ObjFixture fixture;
    const Mesh plain = fixture.load(squareCorners + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n").mesh;
    const std::string variants[] = {
        "\xEF\xBB\xBF" + squareCorners + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1",
        "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nvt 0 0\r\nvn 0 0 1\r\nf 1/1/1 2/1/1 3/1/1\r\n",
        "v 0 0 0\rv 1 0 0\rv 1 1 0\rvt 0 0\rvn 0 0 1\rf 1/1/1 2/1/1 3/1/1\r",
        squareCorners + "vt 0 0\nvn 0 0 1\nf 1/1/1 \\\n2/1/1\\\r\n 3/1/1 # f 4/1/1\n# f 1 2 3 \\\n",
        squareCorners + "vt 0 0\nvn 0 0 1\nf -4/-1/-1 -3/-1/-1 -2/-1/-1\n",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\nf -3/1/-1 2/-1/1 -1/1/1\nv 7 7 7\nvt 1 1\n",
        "f 1/1/1 2/1/1 3/1/1\nvn 0 0 1\nvt 0 0\n" + squareCorners,
        "\t v  0\t0.0 +0e5 1\nv 10e-1 0 0 1 1 1\nv 1 .1e+1 0\nvt 0 0 0\nvn 0 0 1\n"
        "f  1/1/1\t2/1/1   3/1/1 \t\n",
    };
    for (const std::string& text : variants) {
        CAPTURE(text);
        const Mesh mesh = fixture.load(text).mesh;
        CHECK(mesh.positions == plain.positions);
        CHECK(mesh.normals == plain.normals);
        CHECK(mesh.textureCoordinates == plain.textureCoordinates);
        CHECK(mesh.triangles == plain.triangles);
    }
}

TEST_CASE("loadObj: materials come from every MTL file, in the order of use") {
    const ObjFixture fixture;
    fixture.makeFolder("sub");
    fixture.write("a.mtl", "newmtl one\nKd 0.1\nnewmtl two words\nKd 0.2\n");
    fixture.write("sub/b c.mtl",
                  "newmtl one\nKd 0.9\nnewmtl\nKd 0.3\nnewmtl four\nKd 0.4\nmap_Kd t.png\n");
    fixture.write("d.mtl", "newmtl five\nKd 0.5\n");
    fixture.write("sub/t.png", "");
    const ObjModel model = fixture.load(
        "mtllib d.mtl ./a.mtl d.mtl\nmtllib sub\\b c.mtl\n" + squareCorners +
        "usemtl two words\t\nf 1 2 3\nusemtl\nf 1 3 4\nusemtl four\nf 1 2 4\nusemtl one\n"
        "f 2 3 4\nusemtl two words\nf 1 2 3\nusemtl none\nusemtl\tfive\nf 1 2 3\nusemtl gone\nf 1 "
        "2 3\n");
    checkIsConsistent(model);
    CHECK(model.mesh.materialNames ==
          std::vector<std::string>{"two words", "", "four", "one", "none", "five", "gone"});
    CHECK(model.mesh.materialOfTriangle == std::vector<std::uint16_t>{0, 1, 2, 3, 0, 5, 6});
    const float reds[] = {0.2f, 0.3f, 0.4f, 0.1f, 0.5f, 0.5f, 0.5f};
    for (std::size_t i = 0; i < 7; ++i) {
        CHECK(model.materials[i].name == model.mesh.materialNames[i]);
        CHECK(model.materials[i].diffuse.x == reds[i]);
    }
    CHECK(model.materials[2].diffuseMap == fixture.path("sub/t.png"));
    CHECK(model.files == std::vector<std::filesystem::path>{fixture.file(), fixture.path("d.mtl"),
                                                            fixture.path("a.mtl"),
                                                            fixture.path("sub/b c.mtl")});
    CHECK(fixture.hasNote(
        model, fixture.path("model.obj") + ": no MTL file defines \"gone\", \"none\": grey"));
}

TEST_CASE("loadObj: a missing MTL file makes its materials grey, with notes") {
    const ObjFixture fixture;
    const ObjModel model =
        fixture.load("mtllib gone.mtl\nmtllib\n" + squareCorners + "usemtl red\nf 1 2 3\n");
    CHECK(model.materials.at(0).diffuse == Vec3{0.5f, 0.5f, 0.5f});
    CHECK(model.notes ==
          std::vector<std::string>{fixture.path("model.obj:1: no file \"gone.mtl\" with materials"),
                                   fixture.path("model.obj:2: mtllib names no file"),
                                   fixture.path("model.obj: no MTL file defines \"red\": grey")});
    CHECK(fixture.hasNote(fixture.load(squareCorners + "f 1 2 3\n"),
                          fixture.path("model.obj: faces without a material: grey")));
}

TEST_CASE("loadObj: errors of the MTL file and of missing files name them") {
    const ObjFixture fixture;
    fixture.write("bad.mtl", "newmtl red\nKd 1 x 1\n");
    CHECK(fixture.errorOf("mtllib bad.mtl\n" + cubeText) ==
          fixture.path("bad.mtl:2: Kd: expected a number from 0 to 1e18, found \"x\""));
    fixture.write("bad.mtl", "newmtl red\nmap_Kd gone.png\n");
    const std::string usesGone = "mtllib bad.mtl\nusemtl red\n" + cubeText;
    CHECK(contains(fixture.errorOf(usesGone), fixture.path("bad.mtl:2: no file \"gone.png\"")));
    CHECK(errorCode([&] { fixture.load(usesGone); }) == ExitCode::missingFile);
    CHECK(errorCode([&] { loadObj(fixture.path("none.obj")); }) == ExitCode::missingFile);
    CHECK(errorMessage([&] { loadObj(fixture.path("")); }) ==
          fixture.path("") + ": is a directory");
}

TEST_CASE("loadObj: lines and points beside faces are ignored") {
    const ObjFixture fixture;
    const ObjModel model = fixture.load(squareCorners + "l 1 2 3\np 1 2\nf 1 2 3\np 3\n");
    CHECK(model.mesh.triangles.size() == 1);
    CHECK(fixture.hasNote(model, fixture.path("model.obj:5: 1 lines (l) ignored")));
    CHECK(fixture.hasNote(model, fixture.path("model.obj:6: 2 points (p) ignored")));
}

TEST_CASE("loadObj: refuses what is no OBJ file, in one message") {
    const ObjFixture fixture;
    const std::string file = fixture.path("model.obj");
    CHECK(fixture.errorOf("") == file + ": no faces (f)");
    CHECK(fixture.errorOf("v 1 2 x\n") == file + ":1: expected a number, found \"x\"");
    CHECK(fixture.errorOf("\xFE\xFF\0v") == file + ": UTF-16 text, expected UTF-8");
    CHECK(fixture.errorOf(std::string("\x7f"
                                      "ELF\0\1",
                                      6)) == file + ": not a text file, byte 4 is 0");
    // tinyobjloader's 0 · 10^999 is not a number.
    CHECK(fixture.errorOf("v 0e999 0 0\n" + squareCorners + "f 1 2 3\n") ==
          file + ": holds numbers that tinyobjloader cannot read");
}

TEST_CASE("loadObj: a file cut off anywhere loads in part or is refused") {
    const ObjFixture fixture;
    fixture.write("a.mtl", "newmtl one\nKd 0.1\n");
    const std::string text =
        "mtllib a.mtl\n" + squareCorners +
        "vt 0 0\nvn 0 0 1\nusemtl one\ns 1\nf 1/1/1 2/1/1 3/1/1 4/-1/-1\nf 1 3 4\n";
    std::size_t loaded = 0;
    for (std::size_t end = 0; end <= text.size(); ++end) {
        CAPTURE(end);
        try {
            checkIsConsistent(fixture.load(text.substr(0, end)));
            ++loaded;
        } catch (const InputError& error) {
            CHECK(std::string(error.what()).starts_with(fixture.path("model.obj")));
        }
    }
    CHECK(loaded > 8);
    CHECK(loaded < 40);
}

TEST_CASE("loadObj: a file gone wrong gives at most a hundred notes") {
    const ObjFixture fixture;
    std::string mtl = "newmtl red\n";
    for (int i = 0; i < 1000; ++i) mtl += "Ni 0\n";
    fixture.write("a.mtl", mtl);
    const ObjModel model = fixture.load("mtllib a.mtl\nusemtl red\n" + cubeText);
    REQUIRE(model.notes.size() == 101);
    CHECK(model.notes.back() == "and 900 more notes");
}

}  // namespace etendue
