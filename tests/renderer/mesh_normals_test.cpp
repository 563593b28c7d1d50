#include "renderer/mesh_normals.h"

#include <doctest/doctest.h>

#include "renderer/shapes.h"
#include "tests/renderer/mesh_measures.h"

namespace etendue {
namespace {

/// Three positions per triangle, nothing else shared.
Mesh soup(const std::vector<std::array<Vec3, 3>>& triangles) {
    Mesh mesh;
    mesh.materialNames = {""};
    for (const std::array<Vec3, 3>& corners : triangles) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.materialOfTriangle.push_back(0);
    }
    return mesh;
}

Vec3 normalAt(const Mesh& mesh, std::size_t triangle, std::size_t corner) {
    return mesh.normals[mesh.triangles[triangle][corner]];
}

bool isNear(Vec3 a, Vec3 b) { return length(a - b) < 1e-6f; }

}  // namespace

TEST_CASE("makeFlat: takes the normals away and nothing else") {
    const Mesh sphere = makeSphere(12);
    Mesh mesh = sphere;
    makeFlat(mesh);
    CHECK(mesh.normals.empty());
    CHECK(mesh.positions == sphere.positions);
    CHECK(mesh.triangles == sphere.triangles);
}

TEST_CASE("makeSmooth: a box below a right angle keeps its faces, above it has round corners") {
    Mesh flat = makeBox();
    makeSmooth(flat, 89);
    CHECK(flat.positions.size() == 24);
    for (std::size_t i = 0; i < flat.triangles.size(); ++i) {
        const Vec3 front = toFloat(normalize(areaVector(cornersOf(flat, i))));
        for (std::size_t k = 0; k < 3; ++k) CHECK(isNear(normalAt(flat, i, k), front));
    }
    // Weighted by angles, the three faces count the same, however many triangles they have there.
    Mesh round = makeBox();
    makeSmooth(round, 91);
    for (std::size_t i = 0; i < round.positions.size(); ++i)
        CHECK(isNear(round.normals[i], normalize(round.positions[i])));
}

TEST_CASE("makeSmooth: a sphere's normals are its positions, across the seam too") {
    // A triangle's plane stands across the line to its circumcentre, at the angle asin ρ with the
    // position of each corner, for the circumradius ρ; a mean of such normals is no further off.
    for (const int segments : {16, 64}) {
        Mesh mesh = makeSphere(segments);
        double circumradius = 0;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            const std::array<Vec3d, 3> p = cornersOf(mesh, i);
            const double edges = length(p[1] - p[0]) * length(p[2] - p[1]) * length(p[0] - p[2]);
            circumradius = std::max(circumradius, edges / (2 * length(areaVector(p))));
        }
        makeFlat(mesh);
        makeSmooth(mesh, 60);
        CHECK(mesh.positions.size() == makeSphere(segments).positions.size());
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const Vec3d sine = cross(toDouble(mesh.normals[i]), toDouble(mesh.positions[i]));
            CHECK(dot(mesh.normals[i], mesh.positions[i]) > 0);
            CHECK(length(sine) <= circumradius);
        }
    }
}

TEST_CASE("makeSmooth: a capped cylinder gets back exactly the normals it was made with") {
    const Mesh cylinder = makeCylinder(24, true);
    Mesh mesh = cylinder;
    makeFlat(mesh);
    makeSmooth(mesh, 40);
    CHECK(mesh.positions.size() == cylinder.positions.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t before = cylinder.triangles[i][k], after = mesh.triangles[i][k];
            CHECK(mesh.positions[after] == cylinder.positions[before]);
            CHECK(mesh.textureCoordinates[after] == cylinder.textureCoordinates[before]);
            CHECK(isNear(mesh.normals[after], cylinder.normals[before]));
        }
    }
}

TEST_CASE("makeSmooth: a crease may end inside the surface") {
    // Four triangles around a point, the upper two bent along their common side by 2 atan 0.5 =
    // 53°, the lower two by 43°, upper and lower by 36°. The crease is the upper side alone: around
    // its lower end the triangles still join one another the other way round.
    const Vec3 middle{0, 0, 0}, left{-1, 0, -0.5f}, right{1, 0, -0.5f};
    const Vec3 top{0, 1, 0}, bottom{0, -1, -0.8f};
    Mesh mesh = soup({{middle, top, left},
                      {middle, left, bottom},
                      {middle, bottom, right},
                      {middle, right, top}});
    makeSmooth(mesh, 50);
    for (std::size_t i = 1; i < 4; ++i) CHECK(isNear(normalAt(mesh, i, 0), normalAt(mesh, 0, 0)));
    const float cosine = dot(normalAt(mesh, 0, 1), normalAt(mesh, 3, 2));
    CHECK(cosine == doctest::Approx(0.6).epsilon(1e-6));  // cos(2 atan 0.5)
}

TEST_CASE("makeSmooth: triangles that touch in a point only keep their own normals") {
    Mesh mesh =
        soup({{Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {Vec3{0, 0, 0}, {-1, 0, 0.1f}, {-1, -1, 0}}});
    makeSmooth(mesh, 180);
    CHECK(isNear(normalAt(mesh, 0, 0), {0, 0, 1}));
    CHECK_FALSE(isNear(normalAt(mesh, 1, 0), {0, 0, 1}));
}

TEST_CASE("makeSmooth: an edge of three triangles, or of two that disagree, is a crease") {
    const Vec3 a{0, 0, 0}, b{0, 1, 0}, right{1, 0, 0}, left{-1, 0, 0.2f}, up{0.1f, 0, 1};
    const auto keepsItsOwn = [](Mesh mesh) {
        makeSmooth(mesh, 180);
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            const Vec3 front = toFloat(normalize(areaVector(cornersOf(mesh, i))));
            for (std::size_t k = 0; k < 3; ++k)
                if (!isNear(normalAt(mesh, i, k), front)) return false;
        }
        return true;
    };
    CHECK_FALSE(keepsItsOwn(soup({{a, right, b}, {a, b, left}})));
    CHECK(keepsItsOwn(soup({{a, right, b}, {a, b, left}, {a, b, up}})));
    CHECK(keepsItsOwn(soup({{a, right, b}, {a, left, b}})));
}

TEST_CASE("makeSmooth: triangles without area change nothing for the others") {
    const std::vector<std::array<Vec3, 3>> roof = {{Vec3{0, 0, 0}, {1, 0, -0.2f}, {0, 1, 0}},
                                                   {Vec3{0, 1, 0}, {-1, 0, -0.2f}, {0, 0, 0}}};
    std::vector<std::array<Vec3, 3>> withSlivers = roof;
    withSlivers.push_back({Vec3{0, 0, 0}, {0, 1, 0}, {0, 0, 0}});
    withSlivers.push_back({Vec3{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    Mesh expected = soup(roof), mesh = soup(withSlivers);
    makeSmooth(expected, 60);
    makeSmooth(mesh, 60);
    CHECK(isNear(normalAt(expected, 0, 0), normalAt(expected, 1, 2)));
    for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t k = 0; k < 3; ++k) CHECK(normalAt(mesh, i, k) == normalAt(expected, i, k));
    for (std::size_t i = 2; i < 4; ++i)
        for (std::size_t k = 0; k < 3; ++k) CHECK(normalAt(mesh, i, k) == Vec3{0, 0, 1});
}

TEST_CASE("makeSmooth: two leaves back to back keep their own sides") {
    const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    Mesh mesh = soup({{a, b, c}, {a, c, b}});
    makeSmooth(mesh, 180);
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK(normalAt(mesh, 0, k) == Vec3{0, 0, 1});
        CHECK(normalAt(mesh, 1, k) == Vec3{0, 0, -1});
    }
}

TEST_CASE("makeSmooth: an empty mesh stays empty") {
    Mesh mesh;
    makeSmooth(mesh, 40);
    CHECK(mesh.positions.empty());
    CHECK(mesh.normals.empty());
}

}  // namespace etendue
