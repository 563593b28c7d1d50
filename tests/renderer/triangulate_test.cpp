#include "renderer/triangulate.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "renderer/random.h"
#include "renderer/transform.h"

namespace etendue {
namespace {

using Polygon = std::vector<Vec3>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles triangulated(const Polygon& polygon) {
    Triangles triangles;
    triangulate(polygon, triangles);
    return triangles;
}

Vec3d areaVector(const Polygon& p, const std::array<std::uint32_t, 3>& t) {
    const Vec3d a = toDouble(p[t[0]]), b = toDouble(p[t[1]]), c = toDouble(p[t[2]]);
    return cross(b - a, c - a);
}

/// Triangles cover a simple polygon exactly if there are n - 2 of them, none is turned over, and
/// their areas sum to the polygon's: with pieces that overlap or stick out, the sum is larger.
/// Tolerance: coordinates up to 20 in float; every area is off by at most some 20 · 20 · 2^-24.
void checkCovers(const Polygon& polygon, double area) {
    const Triangles triangles = triangulated(polygon);
    REQUIRE(triangles.size() == polygon.size() - 2);
    const Vec3d normal = normalize(polygonNormal(polygon));
    const double tolerance = 400.0 * 0x1p-24 * static_cast<double>(polygon.size());
    double sum = 0.0;
    for (const auto& t : triangles) {
        const Vec3d v = areaVector(polygon, t);
        CHECK(dot(v, normal) >= -tolerance);
        sum += 0.5 * length(v);
    }
    CHECK(std::abs(sum - area) <= tolerance);
}

/// Corners in the plane, turned and moved somewhere in space.
Polygon inSpace(const std::vector<Vec2>& corners, int direction) {
    const Transform turn = Transform::translate({3, -5, 2}) *
                           Transform::rotate(normalize(Vec3d{1, 2, 3}), 25.0 * direction) *
                           Transform::rotate(normalize(Vec3d{-2, 1, 0.5}), 70.0 * direction);
    Polygon polygon;
    for (const Vec2 c : corners) polygon.push_back(toFloat(turn.point({c.x, c.y, 0})));
    return polygon;
}

void checkCoversEverywhere(const std::vector<Vec2>& corners, double area) {
    for (int direction = 0; direction < 12; ++direction)
        for (std::size_t first = 0; first < std::min<std::size_t>(corners.size(), 8); ++first) {
            CAPTURE(direction);
            CAPTURE(first);
            std::vector<Vec2> turned(corners.begin() + static_cast<std::ptrdiff_t>(first),
                                     corners.end());
            turned.insert(turned.end(), corners.begin(),
                          corners.begin() + static_cast<std::ptrdiff_t>(first));
            checkCovers(inSpace(turned, direction), area);
        }
}

Vec2 onCircle(double radius, double turns) {
    const double angle = 2 * std::numbers::pi * turns;
    return {static_cast<float>(radius * std::cos(angle)),
            static_cast<float>(radius * std::sin(angle))};
}

std::vector<Vec2> star(int tips) {
    std::vector<Vec2> corners;
    for (int i = 0; i < 2 * tips; ++i)
        corners.push_back(onCircle(i % 2 ? 0.4 : 1.0, i / (2.0 * tips)));
    return corners;
}

}  // namespace

TEST_CASE("triangulate: a triangle stays as it is") {
    CHECK(triangulated({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}) == Triangles{{0, 1, 2}});
}

TEST_CASE("triangulate: a convex quadrilateral is halved along its shorter diagonal") {
    const auto usesDiagonal = [](const Triangles& triangles, std::uint32_t a, std::uint32_t b) {
        return std::ranges::all_of(triangles, [=](const auto& t) {
            return std::ranges::count(t, a) == 1 && std::ranges::count(t, b) == 1;
        });
    };
    CHECK(usesDiagonal(triangulated({{-2, 0, 0}, {0, -1, 0}, {2, 0, 0}, {0, 1, 0}}), 1, 3));
    CHECK(usesDiagonal(triangulated({{-1, 0, 0}, {0, -2, 0}, {1, 0, 0}, {0, 2, 0}}), 0, 2));
}

TEST_CASE("triangulate: concave quadrilaterals are covered exactly, whatever their diagonals") {
    checkCoversEverywhere({{0, 0}, {2, -1}, {1, 0}, {2, 1}}, 1.0);
    // The diagonal outside is the shorter one.
    checkCoversEverywhere({{0, 0}, {4, -0.25f}, {2, 0}, {4, 0.25f}}, 0.5);
}

TEST_CASE("triangulate: polygons with many dents are covered exactly") {
    checkCoversEverywhere({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 7.0);
    // 2 · tips triangles from the centre, each with sides 1 and 0.4.
    for (const int tips : {3, 5, 50})
        checkCoversEverywhere(star(tips), tips * 0.4 * std::sin(std::numbers::pi / tips));
    std::vector<Vec2> comb = {
        {0, -1}};  // ten teeth: half the strip of height 1, and the strip below
    for (int i = 0; i <= 20; ++i) comb.push_back({static_cast<float>(20 - i), i % 2 ? 0.0f : 1.0f});
    comb.insert(comb.begin() + 1, {20, -1});
    checkCoversEverywhere(comb, 20 + 10);
}

TEST_CASE("triangulate: corners on straight sides make no triangles without area") {
    const std::vector<Vec2> square = {{0, 0}, {1, 0}, {2, 0}, {3, 0},
                                      {3, 3}, {2, 3}, {0, 3}, {0, 1}};
    Polygon polygon;
    for (const Vec2 c : square) polygon.push_back({c.x, c.y, 0});
    checkCovers(polygon, 9.0);
    for (const auto& t : triangulated(polygon)) CHECK(length(areaVector(polygon, t)) > 0.5);
}

TEST_CASE("triangulate: a hole cut open by a double edge stays a hole") {
    // A square of 4 x 4 with a hole of 2 x 2, then one with two holes.
    checkCoversEverywhere(
        {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}, 12.0);
    checkCoversEverywhere({{0, 0},
                           {1, 1},
                           {1, 3},
                           {2, 3},
                           {2, 1},
                           {1, 1},
                           {0, 0},
                           {7, 0},
                           {6, 1},
                           {5, 1},
                           {5, 3},
                           {6, 3},
                           {6, 1},
                           {7, 0},
                           {7, 4},
                           {0, 4}},
                          28.0 - 2.0 - 2.0);
}

TEST_CASE("triangulate: corners written twice do no harm") {
    // No corner is an ear: the dent is none, the others have no angle.
    checkCoversEverywhere({{2, -1}, {1, 0}, {2, 1}, {2, 1}, {0, 0}, {0, 0}, {2, -1}}, 1.0);
    checkCoversEverywhere({{0, 0}, {1, 0}, {1, 0}, {1, 1}, {1, 1}, {1, 1}, {0, 1}}, 1.0);
}

TEST_CASE("triangulate: random star-shaped polygons are covered exactly") {
    for (std::uint32_t i = 0; i < 300; ++i) {
        CAPTURE(i);
        RandomStream random(7, i, 0, RandomDomain::test);
        const int count = 4 + static_cast<int>(random.next() * 60);
        std::vector<Vec2> corners;
        for (int k = 0; k < count; ++k)
            corners.push_back(onCircle(0.2 + random.next(), k / double(count)));
        const Polygon polygon = inSpace(corners, static_cast<int>(i % 12));
        double area = 0.0;  // in the plane: the sum of the triangles from the centre
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Vec2 a = corners[k], b = corners[(k + 1) % corners.size()];
            area += 0.5 * (double{a.x} * b.y - double{a.y} * b.x);
        }
        checkCovers(polygon, area);
    }
}

TEST_CASE("triangulate: the largest face allowed, wound up in a spiral, is covered exactly") {
    // 2048 corners outward, as many back, half the distance of two windings inside.
    constexpr int half = 2048;
    constexpr double turns = 20;
    const auto spiral = [](int i, double offset) {
        const double t = i / (half - 1.0);
        return onCircle(1.0 + turns * t * 0.5 + offset, turns * t);
    };
    std::vector<Vec2> corners;
    for (int i = 0; i < half; ++i) corners.push_back(spiral(i, 0.25));
    for (int i = half - 1; i >= 0; --i) corners.push_back(spiral(i, 0.0));
    double area = 0.0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec2 a = corners[k], b = corners[(k + 1) % corners.size()];
        area += 0.5 * (double{a.x} * b.y - double{a.y} * b.x);
    }
    checkCovers(inSpace(corners, 1), std::abs(area));
}

TEST_CASE("triangulate: polygons that cross themselves or have no area give n - 2 triangles") {
    CHECK(triangulated({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size() == 2);
    CHECK(triangulated(Polygon(9, Vec3{1, 2, 3})).size() == 7);
    CHECK(triangulated({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}).size() == 3);
    Polygon wound;  // around a square three times
    for (int i = 0; i < 12; ++i)
        wound.push_back({i % 4 == 1 || i % 4 == 2 ? 1.0f : 0.0f, i % 4 > 1 ? 1.0f : 0.0f, 0});
    CHECK(triangulated(wound).size() == 10);
}

}  // namespace etendue
