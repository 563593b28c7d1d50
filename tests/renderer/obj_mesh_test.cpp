#include "renderer/obj_mesh.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/renderer/obj_fixture.h"

namespace etendue {
namespace {

/// The normal of triangle `t` at the corner that stands at `p`.
Vec3 normalAt(const Mesh& mesh, std::size_t t, Vec3 p) {
    for (const std::uint32_t i : mesh.triangles[t])
        if (mesh.positions[i] == p) return mesh.normals[i];
    FAIL("no such corner");
    return {};
}

/// Two roundings to float in each of three components.
bool isNear(Vec3 a, Vec3 b) { return length(toDouble(a - b)) < 4 * 0x1p-24; }

}  // namespace

TEST_CASE(
    "buildObjMesh: corners that differ in normal or texture coordinate are vertices of their own") {
    const ObjFixture fixture;
    const auto vertices = [&](const std::string& text) {
        return fixture.load(squareCorners + text).mesh.positions.size();
    };
    CHECK(vertices("f 1 2 3\nf 1 3 4\n") == 4);
    CHECK(vertices("vt 0 0\nvt 1 0\nf 1/1 2/1 3/1\nf 1/2 3/1 4/1\n") == 5);
    CHECK(vertices("vn 0 0 1\nvn 0 1 1\nf 1//1 2//1 3//1\nf 1//2 3//2 4//1\n") == 6);
    // Equal values count as one, however many times they are listed.
    CHECK(vertices(squareCorners + "vn 0 0 1\nvn 0 0 2\nf 1//1 2//1 3//1\nf 5//2 7//2 8//2\n") ==
          4);
}

TEST_CASE("buildObjMesh: texture coordinates that are missing are 0, with a note") {
    const ObjFixture fixture;
    const ObjModel model = fixture.load(squareCorners + "vt 0.25 0.75\nf 1/1 2/1 3/1\nf 1 3 4/1\n");
    checkIsConsistent(model);
    CHECK(fixture.hasNote(
        model, fixture.path("model.obj") + ": 2 corners without texture coordinates set to 0"));
    const auto uv = [&](std::size_t t, std::size_t k) {
        return model.mesh.textureCoordinates[model.mesh.triangles[t][k]];
    };
    CHECK(uv(0, 0) == Vec2{0.25f, 0.75f});
    CHECK(uv(1, 0) == Vec2{0, 0});
    CHECK(uv(1, 2) == Vec2{0.25f, 0.75f});
}

TEST_CASE("buildObjMesh: a smoothed cube's normals are its diagonals, however its faces are cut") {
    // Angles sum to 90° per face, so each corner sees its three faces with equal weight; areas or
    // numbers of triangles would depend on the diagonals.
    const ObjFixture fixture;
    const ObjModel model = fixture.load("s 1\n" + cubeText);
    checkIsConsistent(model);
    REQUIRE(model.mesh.normals.size() == 8);
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 diagonal = model.mesh.positions[i] * 2.0f - Vec3{1, 1, 1};
        CHECK(isNear(model.mesh.normals[i], normalize(diagonal)));
    }
}

TEST_CASE("buildObjMesh: smoothing stays within its group, and off means flat") {
    const ObjFixture fixture;
    // Two walls and a floor around the corner at the origin: walls smoothed, floor in group 2.
    const std::string text =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ns 1\nf 1 3 4\nf 1 4 2\ns GROUP\nf 1 2 3\n";
    for (const std::string group : {"2", "off", "0"}) {
        CAPTURE(group);
        std::string with = text;
        const ObjModel model = fixture.load(with.replace(with.find("GROUP"), 5, group));
        checkIsConsistent(model);
        const float half = std::sqrt(0.5f);
        CHECK(isNear(normalAt(model.mesh, 0, {0, 0, 0}), {half, half, 0}));
        CHECK(isNear(normalAt(model.mesh, 1, {0, 0, 0}), {half, half, 0}));
        CHECK(isNear(normalAt(model.mesh, 0, {0, 1, 0}), {1, 0, 0}));
        CHECK(normalAt(model.mesh, 2, {0, 0, 0}) == Vec3{0, 0, 1});
    }
    CHECK(fixture.load("s off\n" + cubeText).mesh.normals.empty());
    CHECK(fixture.load("s 0\n" + cubeText).mesh.normals.empty());
}

TEST_CASE("buildObjMesh: where smoothed normals cancel or look to the back, faces keep their own") {
    const ObjFixture fixture;
    const ObjModel leaf = fixture.load(squareCorners + "s 1\nf 1 2 3\nf 3 2 1\n");
    checkIsConsistent(leaf);
    CHECK(normalAt(leaf.mesh, 0, {0, 0, 0}) == Vec3{0, 0, 1});
    CHECK(normalAt(leaf.mesh, 1, {0, 0, 0}) == Vec3{0, 0, -1});
    CHECK(leaf.notes.size() == 1);  // that there is no material
}

TEST_CASE("buildObjMesh: faces without normals among others are flat, unless smoothed") {
    const ObjFixture fixture;
    const std::string text =
        squareCorners + "v 0 0 1\nvn 1 1 5\nf 1//1 2//1 3//1\nSMOOTH\nf 1 5 2\nf 1 4 5\n";
    const auto load = [&](const std::string& smooth) {
        std::string with = text;
        const ObjModel model = fixture.load(with.replace(with.find("SMOOTH"), 6, smooth));
        checkIsConsistent(model);
        return model.mesh;
    };
    const Mesh flat = load("");
    CHECK(isNear(normalAt(flat, 0, {0, 0, 0}), normalize(Vec3{1, 1, 5})));
    CHECK(normalAt(flat, 1, {0, 0, 0}) == Vec3{0, 1, 0});
    CHECK(normalAt(flat, 2, {0, 0, 0}) == Vec3{1, 0, 0});
    const Mesh smooth = load("s 4");
    const float half = std::sqrt(0.5f);
    CHECK(isNear(normalAt(smooth, 1, {0, 0, 0}), {half, half, 0}));
    CHECK(normalAt(smooth, 1, {1, 0, 0}) == Vec3{0, 1, 0});
}

TEST_CASE("buildObjMesh: normals of length 0 or looking to the back are replaced, and counted") {
    const ObjFixture fixture;
    const ObjModel model = fixture.load(
        squareCorners +
        "vn 0 0 0\nvn 1 0 -1\nvn 0 3 4\nvn 1e-15 0 0\nf 1//1 2//2 3//3\nf 1//3 3//3 4//4\n");
    checkIsConsistent(model);
    CHECK(fixture.hasNote(model, fixture.path("model.obj") +
                                     ": 2 normals of length 0 or looking to the back replaced"));
    CHECK(normalAt(model.mesh, 0, {0, 0, 0}) == Vec3{0, 0, 1});
    CHECK(normalAt(model.mesh, 0, {1, 0, 0}) == Vec3{0, 0, 1});
    CHECK(isNear(normalAt(model.mesh, 0, {1, 1, 0}), {0, 0.6f, 0.8f}));
    CHECK(isNear(normalAt(model.mesh, 1, {0, 1, 0}), {1, 0, 0}));
}

TEST_CASE("buildObjMesh: normals that all look to the back of a triangle are turned around") {
    const ObjFixture fixture;
    const ObjModel model = fixture.load(
        squareCorners + "vn 0 0.6 -0.8\nvn 0 0 -1\nf 1//1 2//1 3//2\nf 1//2 3//2 4//2\n");
    checkIsConsistent(model);
    CHECK(fixture.hasNote(model,
                          fixture.path("model.obj") +
                              ": 2 triangles wound against their normals: normals turned around"));
    CHECK(isNear(normalAt(model.mesh, 0, {0, 0, 0}), {0, -0.6f, 0.8f}));
    CHECK(normalAt(model.mesh, 1, {0, 0, 0}) == Vec3{0, 0, 1});
}

TEST_CASE("buildObjMesh: triangles without area are left out, and counted") {
    const ObjFixture fixture;
    const ObjModel model = fixture.load(squareCorners +
                                        "v 2 2 0\nv 1e-22 0 0\nv 0 1e-22 0\n"
                                        "f 1 2 3\nf 1 2 2\nf 1 3 5\nf 1 1 1\nf 1 6 7\nf 2 3 3 4\n");
    checkIsConsistent(model);
    CHECK(model.mesh.triangles.size() == 2);
    CHECK(
        fixture.hasNote(model, fixture.path("model.obj") + ": 5 triangles without area left out"));
    CHECK(fixture.errorOf(squareCorners + "f 1 1 2\n") ==
          fixture.path("model.obj") + ": no triangle has an area");
    CHECK(fixture.errorOf("v 1e17 0 0\nv 1e17 1 0\nv 1e17 2 5\nf 1 2 3\n") == "");
}

}  // namespace etendue
