#include "renderer/shapes.h"

#include <doctest/doctest.h>

#include <limits>
#include <stdexcept>

#include "tests/renderer/mesh_measures.h"

namespace etendue {
namespace {

constexpr double piDouble = std::numbers::pi;
// Positions are rounded to float: each of a triangle's at most three factors is off by 2⁻²⁴ of the
// shape's size, which is below 2 in every shape here.
constexpr double roundingTolerance = 1e-6;

const std::vector<Vec2> vaseProfile = {{0, 0},       {0.35f, 0},    {0.35f, 0},    {0.5f, 0.4f},
                                       {0.3f, 0.8f}, {0.15f, 1.0f}, {0.2f, 1.15f}, {0, 1.2f}};
// Outside up, then inside down.
const std::vector<Vec2> glassProfile = {{0, 0},     {0.4f, 0.1f},   {0.5f, 1},
                                        {0.45f, 1}, {0.36f, 0.15f}, {0, 0.1f}};

struct NamedMesh {
    const char* name;
    Mesh mesh;
};

std::vector<NamedMesh> closedShapes() {
    return {{"sphere of 3", makeSphere(3)},
            {"sphere of 32", makeSphere(32)},
            {"box", makeBox()},
            {"cylinder of 3", makeCylinder(3, true)},
            {"cylinder of 50", makeCylinder(50, true)},
            {"torus", makeTorus(0.3f, 23, 11)},
            {"smallest torus", makeTorus(0.9f, 3, 3)},
            {"vase", makeLathe(vaseProfile, 31)},
            {"smooth vase", makeLathe(vaseProfile, 17, 7)},
            {"glass", makeLathe(glassProfile, 24)},
            {"double cone", makeLathe(std::vector<Vec2>{{0, -1}, {1, 0}, {0, 1}}, 5)}};
}

std::vector<NamedMesh> openShapes() {
    return {{"rectangle", makeRectangle()},
            {"fine rectangle", makeRectangle(7)},
            {"disc", makeDisc(9)},
            {"pipe", makeCylinder(12, false)},
            {"bowl", makeLathe(std::vector<Vec2>{{0, 0}, {0.7f, 0.3f}, {1, 1}}, 12)}};
}

std::vector<NamedMesh> allShapes() {
    std::vector<NamedMesh> shapes = closedShapes();
    for (NamedMesh& shape : openShapes()) shapes.push_back(std::move(shape));
    return shapes;
}

/// ∫ f over [low, high] by Simpson's rule.
template <class F>
double integrate(F f, double low, double high) {
    constexpr int steps = 1000;
    const double h = (high - low) / steps;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double x = low + i * h;
        sum += (f(x) + 4 * f(x + h / 2) + f(x + h)) * h / 6;
    }
    return sum;
}

}  // namespace

TEST_CASE("Shapes: closed ones are watertight and their front side is outside") {
    for (const NamedMesh& shape : closedShapes()) {
        const Mesh& mesh = shape.mesh;
        CAPTURE(shape.name);
        const EdgeCounts edges = countEdges(mesh);
        CHECK(edges.boundary == 0);
        CHECK(edges.faulty == 0);
        CHECK(volumeOf(mesh) > 0);
    }
}

TEST_CASE("Shapes: open ones end where they should and nowhere else") {
    const int sides[] = {4, 28, 9, 24, 12};
    const std::vector<NamedMesh> shapes = openShapes();
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        CAPTURE(shapes[i].name);
        const EdgeCounts edges = countEdges(shapes[i].mesh);
        CHECK(edges.boundary == sides[i]);
        CHECK(edges.faulty == 0);
    }
}

TEST_CASE("Shapes: arrays fit together, and no triangle is without area") {
    for (const NamedMesh& shape : allShapes()) {
        const Mesh& mesh = shape.mesh;
        CAPTURE(shape.name);
        CHECK(mesh.materialNames == std::vector<std::string>{""});
        CHECK(mesh.materialOfTriangle == std::vector<std::uint16_t>(mesh.triangles.size(), 0));
        CHECK(mesh.textureCoordinates.size() == mesh.positions.size());
        CHECK((mesh.normals.empty() || mesh.normals.size() == mesh.positions.size()));

        std::vector<bool> isUsed(mesh.positions.size());
        double thinnest = 1;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            for (const std::uint32_t vertex : mesh.triangles[i]) isUsed.at(vertex) = true;
            const std::array<Vec3d, 3> p = cornersOf(mesh, i);
            const double longest =
                std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
            thinnest = std::min(thinnest, length(areaVector(p)) / (longest * longest));
        }
        CHECK(std::ranges::find(isUsed, false) == isUsed.end());
        CHECK(thinnest > 0.01);  // far above rounding, far below the thinnest that is meant
    }
}

TEST_CASE("Shapes: normals are unit and on the front side of their triangles") {
    for (const NamedMesh& shape : allShapes()) {
        const Mesh& mesh = shape.mesh;
        CAPTURE(shape.name);
        double worstLength = 0, smallestCosine = 1;
        for (const Vec3 n : mesh.normals)
            worstLength = std::max(worstLength, std::abs(length(toDouble(n)) - 1));
        for (std::size_t i = 0; i < mesh.triangles.size() && !mesh.normals.empty(); ++i) {
            const Vec3d front = normalize(areaVector(cornersOf(mesh, i)));
            for (const std::uint32_t vertex : mesh.triangles[i])
                smallestCosine =
                    std::min(smallestCosine, dot(front, toDouble(mesh.normals[vertex])));
        }
        CHECK(worstLength < 1e-7);  // √3 · 2⁻²⁵ and a little
        CHECK(smallestCosine > 0.1);
    }
}

TEST_CASE("Shapes: texture coordinates lie in the unit square and are nowhere mirrored") {
    for (const NamedMesh& shape : allShapes()) {
        const Mesh& mesh = shape.mesh;
        CAPTURE(shape.name);
        bool isInside = true, isMirrored = false;
        for (const Vec2 uv : mesh.textureCoordinates)
            isInside = isInside && uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1;
        for (const auto& [i, j, k] : mesh.triangles) {
            const Vec2 a = mesh.textureCoordinates[i];
            const Vec2 b = mesh.textureCoordinates[j] - a, c = mesh.textureCoordinates[k] - a;
            isMirrored = isMirrored || b.x * c.y - b.y * c.x <= 0;
        }
        CHECK(isInside);
        CHECK_FALSE(isMirrored);
    }
}

TEST_CASE("makeSphere: positions are unit, normals the same, texture coordinates their angles") {
    const Mesh mesh = makeSphere(40);
    CHECK(mesh.triangles.size() == 8 * 10 * 10);
    CHECK(mesh.normals == mesh.positions);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3d p = toDouble(mesh.positions[i]);
        CHECK(length(p) == doctest::Approx(1).epsilon(1e-7));
        const double longitude = 2 * piDouble * static_cast<double>(mesh.textureCoordinates[i].x);
        const double latitude =
            piDouble * (static_cast<double>(mesh.textureCoordinates[i].y) - 0.5);
        const Vec3d expected = {std::cos(latitude) * std::cos(longitude),
                                std::cos(latitude) * std::sin(longitude), std::sin(latitude)};
        CHECK(length(p - expected) < roundingTolerance);
    }
}

TEST_CASE("makeSphere: the equator has the sides asked for, rounded up to a multiple of four") {
    for (const auto& [segments, sides] : {std::pair{3, 4}, {4, 4}, {5, 8}, {64, 64}, {65, 68}}) {
        const Mesh mesh = makeSphere(segments);
        CHECK(mesh.triangles.size() == static_cast<std::size_t>(sides * sides / 2));
        // One vertex of the seam is there twice.
        CHECK(std::ranges::count(mesh.positions, 0.0f, &Vec3::z) == sides + 1);
    }
}

// The surface of a triangle inscribed in the unit sphere lies Σ λᵢ λⱼ eᵢⱼ² / 2 below the sphere, to
// second order, with barycentric λ and edges e; its mean is s = Σ e² / 24. Hence the sphere loses
// the share 3 E[s] of its volume, and, since volume = Σ area · height / 3 with height 1 − ρ² / 2
// and ρ the triangle's circumradius, the share 3 E[s] − E[ρ²] / 2 of its area.
// A row at polar angle θ is δ = π / 2n high and its sides are h = δ (π/2) sin θ / θ long; with w
// uniform along the quadrant, its triangles have the edges h, √(δ² + w² h²), √(δ² + (1−w)² h²).
// Averaged over w: Σ e² = 2 δ² + 5/3 h², ρ² = (δ² + 2/3 h² + h⁴ / 30 δ²) / 4. The next order
// is smaller by e², of which the longest is below 9 / n² (checked too).
TEST_CASE("makeSphere: area and volume fall short as its tessellation says") {
    for (const int n : {1, 2, 4, 8, 16, 32, 64}) {
        CAPTURE(n);
        const Mesh mesh = makeSphere(4 * n);
        const double areaDeficit = n * n * (1 - areaOf(mesh) / (4 * piDouble));
        const double volumeDeficit = n * n * (1 - volumeOf(mesh) / (4 * piDouble / 3));
        CHECK(areaDeficit > 0);
        CHECK(areaDeficit < 0.81);
        CHECK(volumeDeficit > 0);
        CHECK(volumeDeficit < 1.5);
        CHECK(longestEdge(mesh) < 3.0 / n);

        const double rowSquared = piDouble * piDouble / 4;  // n² δ²
        const auto overSphere = [](auto f) {
            return integrate([&](double t) { return f(t) * std::sin(t); }, 1e-9, piDouble / 2);
        };
        const auto sideSquared = [&](double t) {
            const double h = piDouble / 2 * std::sin(t) / t;
            return rowSquared * h * h;
        };
        const double sagitta =
            overSphere([&](double t) { return (2 * rowSquared + 5.0 / 3 * sideSquared(t)) / 24; });
        const double circumradiusSquared = overSphere([&](double t) {
            const double h2 = sideSquared(t);
            return (rowSquared + 2.0 / 3 * h2 + h2 * h2 / (30 * rowSquared)) / 4;
        });
        const double nextOrder = 9.0 / (n * n);
        CHECK(std::abs(volumeDeficit / (3 * sagitta) - 1) < nextOrder);
        CHECK(std::abs(areaDeficit / (3 * sagitta - circumradiusSquared / 2) - 1) < nextOrder);
    }
}

TEST_CASE("makeSphere: its triangles are of nearly equal size") {
    const Mesh mesh = makeSphere(100);
    double smallest = 1, largest = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double area = length(areaVector(cornersOf(mesh, i)));
        smallest = std::min(smallest, area);
        largest = std::max(largest, area);
    }
    // h δ / 2 is π/2 times larger at the pole than at the equator; the rows there are curved, and
    // the pole's own triangles chords of a quadrant, which changes it by less than a quarter.
    CHECK(largest / smallest < 1.25 * piDouble / 2);
}

TEST_CASE("makeRectangle: has area 4 and normal +z whatever its subdivision") {
    for (const auto& [subdivisions, triangles] : {std::pair{1, 2u}, {10, 200u}, {100, 20000u}}) {
        const Mesh mesh = makeRectangle(subdivisions);
        CHECK(mesh.triangles.size() == triangles);
        CHECK(mesh.normals.empty());
        CHECK(areaOf(mesh) == doctest::Approx(4).epsilon(roundingTolerance));
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
            CHECK(areaVector(cornersOf(mesh, i)).z > 0);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const Vec2 uv = mesh.textureCoordinates[i];
            CHECK(length(mesh.positions[i] - Vec3{2 * uv.x - 1, 2 * uv.y - 1, 0}) < 1e-6f);
        }
    }
}

TEST_CASE("makeBox: six faces, each with the whole texture upright") {
    const Mesh mesh = makeBox();
    CHECK(mesh.triangles.size() == 12);
    CHECK(mesh.positions.size() == 24);
    CHECK(mesh.normals.empty());
    CHECK(areaOf(mesh) == 24);
    CHECK(volumeOf(mesh) == doctest::Approx(8).epsilon(1e-14));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        CHECK(abs(mesh.positions[i]) == Vec3{1, 1, 1});
        if (i < 16) CHECK(mesh.positions[i].z == 2 * mesh.textureCoordinates[i].y - 1);
    }
}

TEST_CASE("makeDisc and makeCylinder: are the regular polygon and the prism over it") {
    for (const int segments : {3, 7, 64, 1000}) {
        CAPTURE(segments);
        const double polygon = 0.5 * segments * std::sin(2 * piDouble / segments);
        const double side = 2 * std::sin(piDouble / segments);
        CHECK(areaOf(makeDisc(segments)) == doctest::Approx(polygon).epsilon(roundingTolerance));
        CHECK(areaOf(makeCylinder(segments, false)) ==
              doctest::Approx(segments * side).epsilon(roundingTolerance));
        const Mesh capped = makeCylinder(segments, true);
        CHECK(capped.triangles.size() == static_cast<std::size_t>(4 * segments));
        CHECK(areaOf(capped) ==
              doctest::Approx(2 * polygon + segments * side).epsilon(roundingTolerance));
        CHECK(volumeOf(capped) == doctest::Approx(polygon).epsilon(roundingTolerance));
    }
    const Mesh disc = makeDisc(12);
    CHECK(disc.normals.empty());
    CHECK(disc.triangles.size() == 12);
    for (std::size_t i = 0; i < 12; ++i) CHECK(areaVector(cornersOf(disc, i)).z > 0);
}

TEST_CASE("makeCylinder: the wall's normals are radial, the caps' along the axis") {
    const Mesh mesh = makeCylinder(20, true);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3 p = mesh.positions[i];
        const bool isWall = i < 42;
        CHECK(mesh.normals[i] == (isWall ? Vec3{p.x, p.y, 0} : Vec3{0, 0, 2 * p.z - 1}));
    }
}

TEST_CASE("makeTorus: area and volume are those of the turned polygon, normals leave the tube") {
    const float minorRadius = 0.3f;
    const int major = 60, minor = 24;
    const Mesh mesh = makeTorus(minorRadius, major, minor);
    CHECK(mesh.triangles.size() == 2 * 60 * 24);
    std::vector<Vec2> polygon;
    for (int i = 0; i <= minor; ++i) {
        const float angle = 2 * pi * static_cast<float>(i) / minor;
        polygon.push_back({1 + minorRadius * std::cos(angle), minorRadius * std::sin(angle)});
    }
    CHECK(areaOf(mesh) ==
          doctest::Approx(turnedArea(polygon, major)).epsilon(10 * roundingTolerance));
    CHECK(volumeOf(mesh) ==
          doctest::Approx(turnedVolume(polygon, major)).epsilon(10 * roundingTolerance));
    // 4π² r and 2π² r², short by the polygons' shares 1 − sinc ≤ (2π / segments)² / 6 each.
    const double shortfall =
        std::pow(2 * piDouble / major, 2) / 6 + std::pow(2 * piDouble / minor, 2) / 6;
    const double r = minorRadius;
    CHECK(areaOf(mesh) / (4 * piDouble * piDouble * r) < 1);
    CHECK(areaOf(mesh) / (4 * piDouble * piDouble * r) > 1 - shortfall);
    CHECK(volumeOf(mesh) / (2 * piDouble * piDouble * r * r) < 1);
    CHECK(volumeOf(mesh) / (2 * piDouble * piDouble * r * r) > 1 - shortfall);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3 circle = mesh.positions[i] - mesh.normals[i] * minorRadius;
        CHECK(std::abs(circle.z) < 1e-6f);
        CHECK(length(circle) == doctest::Approx(1).epsilon(roundingTolerance));
    }
}

TEST_CASE("Shapes: bad arguments are refused") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_WITH_AS(makeSphere(2), "sphere: segments is 2, must be from 3 to 4096",
                         std::invalid_argument);
    CHECK_THROWS_AS(makeSphere(1 << 20), std::invalid_argument);
    CHECK_THROWS_AS(makeRectangle(0), std::invalid_argument);
    CHECK_THROWS_AS(makeDisc(-5), std::invalid_argument);
    CHECK_THROWS_AS(makeCylinder(2, false), std::invalid_argument);
    CHECK_THROWS_AS(makeTorus(0, 8, 8), std::invalid_argument);
    CHECK_THROWS_AS(makeTorus(1, 8, 8), std::invalid_argument);
    CHECK_THROWS_AS(makeTorus(nan, 8, 8), std::invalid_argument);
    CHECK_THROWS_AS(makeTorus(0.5f, 2, 8), std::invalid_argument);
    CHECK_THROWS_AS(makeTorus(0.5f, 8, 2), std::invalid_argument);
}

}  // namespace etendue
