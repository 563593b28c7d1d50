// makeLathe; what all shapes have in common is tested in shapes_test.cpp.
#include <doctest/doctest.h>

#include <limits>
#include <stdexcept>

#include "renderer/shapes.h"
#include "tests/renderer/mesh_measures.h"

namespace etendue {
namespace {

constexpr double piDouble = std::numbers::pi;
// Float positions: each is off by 2⁻²⁴ of the shape's size, which is below 3 here.
constexpr double roundingTolerance = 1e-6;

const std::vector<Vec2> vaseProfile = {{0, 0},       {0.35f, 0},    {0.35f, 0},    {0.5f, 0.4f},
                                       {0.3f, 0.8f}, {0.15f, 1.0f}, {0.2f, 1.15f}, {0, 1.2f}};
// Outside up, then inside down.
const std::vector<Vec2> glassProfile = {{0, 0},     {0.4f, 0.1f},   {0.5f, 1},
                                        {0.45f, 1}, {0.36f, 0.15f}, {0, 0.1f}};

}  // namespace

TEST_CASE("makeLathe: area and volume are those of the turned polyline") {
    for (const auto& profile : {vaseProfile, glassProfile}) {
        for (const int segments : {3, 16, 101}) {
            const Mesh mesh = makeLathe(profile, segments);
            CHECK(areaOf(mesh) ==
                  doctest::Approx(turnedArea(profile, segments)).epsilon(10 * roundingTolerance));
            CHECK(volumeOf(mesh) ==
                  doctest::Approx(turnedVolume(profile, segments)).epsilon(10 * roundingTolerance));
        }
    }
}

TEST_CASE("makeLathe: counts two triangles per cell, one at the axis") {
    CHECK(makeLathe(std::vector<Vec2>{{1, 0}, {1, 1}}, 10).triangles.size() == 20);
    CHECK(makeLathe(std::vector<Vec2>{{0, 0}, {1, 1}}, 10).triangles.size() == 10);
    CHECK(makeLathe(std::vector<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 10).triangles.size() == 40);
    CHECK(makeLathe(std::vector<Vec2>{{0, 0}, {1, 0.5f}, {0, 1}}, 10, 5).triangles.size() ==
          10 * (2 * 10 - 2));
}

TEST_CASE("makeLathe: a profile that comes down has its front side inside") {
    std::vector<Vec2> reversed(vaseProfile.rbegin(), vaseProfile.rend());
    CHECK(volumeOf(makeLathe(reversed, 31)) ==
          doctest::Approx(-volumeOf(makeLathe(vaseProfile, 31))).epsilon(1e-12));
}

TEST_CASE("makeLathe: normals on an unevenly drawn half circle point away from its centre") {
    std::vector<Vec2> circle;
    for (const float share : {0.0f, 0.07f, 0.2f, 0.25f, 0.4f, 0.55f, 0.6f, 0.8f, 0.91f, 1.0f}) {
        const bool isPole = share == 0.0f || share == 1.0f;
        circle.push_back({isPole ? 0.0f : std::sin(pi * share), -std::cos(pi * share)});
    }
    const Mesh mesh = makeLathe(circle, 16);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        CHECK(length(mesh.normals[i] - mesh.positions[i]) < 1e-5f);
}

TEST_CASE("makeLathe: a joint is a crease when it turns by more than the angle given") {
    // Turns by 30° upward from a cone of 45°: the wall's normals there are one or two directions.
    const std::vector<Vec2> profile = {
        {1, 0}, {2, 1}, {2 + std::cos(pi * 75 / 180), 1 + std::sin(pi * 75 / 180)}};
    const int segments = 8;
    CHECK(makeLathe(profile, segments, 1, 31).positions.size() == 3 * (segments + 1));
    CHECK(makeLathe(profile, segments, 1, 29).positions.size() == 4 * (segments + 1));

    const Mesh creased = makeLathe(profile, segments, 1, 29);
    const auto elevation = [&](std::size_t i) {
        return std::asin(creased.normals[i].z) * 180 / pi;
    };
    CHECK(elevation(segments + 1) == doctest::Approx(-45).epsilon(1e-5));
    CHECK(elevation(2 * (segments + 1)) == doctest::Approx(-15).epsilon(1e-5));
}

TEST_CASE("makeLathe: a pole's normal is along the axis, a tip's is not") {
    const auto northNormal = [](float height) {
        const Mesh mesh = makeLathe(std::vector<Vec2>{{1, 0}, {0, height}}, 8);
        return mesh.normals.back();
    };
    CHECK(northNormal(0.3f) == Vec3{0, 0, 1});  // turns by 2 · 16.7° over the pole
    CHECK(northNormal(0.5f).z < 0.9f);          // turns by 2 · 26.6°
}

TEST_CASE("makeLathe: a tip's vertices look along the middle of their triangles") {
    const Mesh mesh = makeLathe(std::vector<Vec2>{{1, 0}, {0, 2}}, 7);
    for (const auto& [a, b, tip] : mesh.triangles) {
        const Vec2 u = {mesh.textureCoordinates[a].x, mesh.textureCoordinates[b].x};
        CHECK(mesh.textureCoordinates[tip].x == doctest::Approx((u.x + u.y) / 2));
        CHECK(mesh.positions[tip] == Vec3{0, 0, 2});
        const Vec3 middle = mesh.normals[a] + mesh.normals[b], n = mesh.normals[tip];
        CHECK(std::abs(n.x * middle.y - n.y * middle.x) < 1e-6f);
        CHECK(n.x * middle.x + n.y * middle.y > 0);
    }
}

TEST_CASE("makeLathe: a point given twice is a corner") {
    const std::vector<Vec2> smooth = {{1, 0}, {1.1f, 1}, {1, 2}};
    const std::vector<Vec2> cornered = {{1, 0}, {1.1f, 1}, {1.1f, 1}, {1, 2}};
    CHECK(makeLathe(smooth, 8).positions.size() == 27);
    CHECK(makeLathe(cornered, 8).positions.size() == 36);
    // And between corners the subdivided curve is straight.
    for (const Vec3 p : makeLathe(cornered, 8, 4).positions)
        CHECK(std::hypot(p.x, p.y) == doctest::Approx(1.1f - 0.1f * std::abs(p.z - 1)));
}

TEST_CASE("makeLathe: subdivision passes through the points and bulges between them") {
    // On a circle in equal steps h the curve of Catmull and Rom passes halfway through the points'
    // weighted mean (−1, 9, 9, −1) / 16, at the radius (9 cos(h/2) − cos(3h/2)) / 8. At the axis
    // the reflected profile goes on as the circle does.
    const int pieces = 8;
    std::vector<Vec2> circle;
    for (int i = 0; i <= pieces; ++i) {
        const float angle = pi * static_cast<float>(i) / pieces;
        circle.push_back({i % pieces == 0 ? 0.0f : std::sin(angle), -std::cos(angle)});
    }
    const Mesh mesh = makeLathe(circle, 4, 2);
    const double h = piDouble / pieces;
    const double halfway = (9 * std::cos(h / 2) - std::cos(3 * h / 2)) / 8;
    std::size_t next = 4;  // after the pole's vertices
    for (int row = 1; row < 2 * pieces; ++row, next += 5) {
        CHECK(length(toDouble(mesh.positions[next])) ==
              doctest::Approx(row % 2 == 0 ? 1.0 : halfway).epsilon(roundingTolerance));
    }
}

// Over knots d = √distance apart, the curve's derivative at p₁ is (p₁−p₀)/d₀ − (p₂−p₀)/(d₀+d₁) +
// (p₂−p₁)/d₁, and a cubic's middle is (p₁+p₂)/2 + d₁ (derivative at p₁ − derivative at p₂) / 8.
TEST_CASE("makeLathe: subdivision is the centripetal curve where points are uneven") {
    const std::vector<Vec2> profile = {{2, 0}, {2.1f, 0.1f}, {2.5f, 1.2f}, {2.2f, 1.3f}};
    std::vector<Vec2T<double>> p;
    for (const Vec2 point : profile) p.push_back({point.x, point.y});
    const auto knot = [&](std::size_t i) {
        return std::sqrt(std::hypot(p[i + 1].x - p[i].x, p[i + 1].y - p[i].y));
    };
    const auto derivative = [&](std::size_t i) {
        const double before = knot(i - 1), after = knot(i);
        return (p[i] - p[i - 1]) * (1 / before) - (p[i + 1] - p[i - 1]) * (1 / (before + after)) +
               (p[i + 1] - p[i]) * (1 / after);
    };
    const Vec2T<double> middle =
        (p[1] + p[2]) * 0.5 + (derivative(1) - derivative(2)) * (knot(1) / 8);

    const int segments = 4;
    const Vec3 found = makeLathe(profile, segments, 2).positions[3 * (segments + 1)];
    CHECK(found.x == doctest::Approx(middle.x).epsilon(roundingTolerance));
    CHECK(found.z == doctest::Approx(middle.y).epsilon(roundingTolerance));
}

TEST_CASE("makeLathe: subdivision turns a coarse profile smooth, whatever its steps") {
    const std::vector<Vec2> profile = {{0.2f, 0}, {0.5f, 0.05f}, {0.6f, 0.6f}, {0.2f, 1.4f}};
    const auto largestTurn = [&](int subdivisions) {
        const Mesh mesh = makeLathe(profile, 3, subdivisions, 179);
        double largest = 0;
        Vec3d before{};
        for (std::size_t i = 4; i < mesh.positions.size(); i += 4) {
            const Vec3d step = normalize(toDouble(mesh.positions[i] - mesh.positions[i - 4]));
            if (i > 4) largest = std::max(largest, std::acos(std::min(1.0, dot(before, step))));
            before = step;
        }
        return largest;
    };
    // The curve has a continuous tangent, so that turns shrink in proportion to the pieces.
    CHECK(largestTurn(1) > 1.0);
    CHECK(largestTurn(64) < 0.6 * largestTurn(32));
    CHECK(largestTurn(128) < 0.6 * largestTurn(64));
}

TEST_CASE("makeLathe: a smooth curve that would cross the axis is refused") {
    const std::vector<Vec2> plunging = {{1, 0}, {1, 1}, {0.01f, 2}, {0.01f, 6}};
    CHECK_NOTHROW(makeLathe(plunging, 8));
    CHECK_THROWS_AS(makeLathe(plunging, 8, 16), std::invalid_argument);
}

TEST_CASE("makeLathe: bad arguments are refused") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Vec2> wall = {{1, 0}, {1, 1}};
    const auto lathe = [](std::vector<Vec2> profile) { return makeLathe(profile, 8); };
    CHECK_THROWS_AS(makeLathe(wall, 2), std::invalid_argument);
    CHECK_THROWS_AS(makeLathe(wall, 8, 0), std::invalid_argument);
    CHECK_THROWS_AS(makeLathe(wall, 8, 4096), std::invalid_argument);
    CHECK_THROWS_AS(makeLathe(wall, 8, 1, nan), std::invalid_argument);
    CHECK_THROWS_AS(makeLathe(wall, 8, 1, 180), std::invalid_argument);
    CHECK_THROWS_WITH_AS(lathe({{1, 0}}), "lathe: the profile needs at least two points",
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(lathe({{1, 0}, {-1, 1}}),
                         "lathe: profile[1] has the radius -1.000000, must not be negative",
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS(lathe({{nan, 0}, {1, 1}}), "lathe: profile[0] is not finite",
                         std::invalid_argument);
    CHECK_THROWS_AS(lathe({{1, 0}, {1, std::numeric_limits<float>::infinity()}}),
                    std::invalid_argument);
    CHECK_THROWS_AS(lathe({{1, 0}, {1, 0}}), std::invalid_argument);
    CHECK_THROWS_AS(lathe({{0, 0}, {0, 1}, {1, 1}}), std::invalid_argument);
}

}  // namespace etendue
