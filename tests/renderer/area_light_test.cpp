#include <doctest/doctest.h>

#include <array>

#include "renderer/light.h"
#include "tests/renderer/light_fixtures.h"
#include "tests/support/chi_square_sphere.h"
#include "tests/support/estimate.h"

using namespace etendue;

namespace {

/// Where a ray from within a box meets its inside.
EmitterHit hitOfBox(Vec3 low, Vec3 high, Vec3 direction) {
    const auto distance = [&](int axis) {
        return (direction[axis] < 0.0f ? low[axis] : high[axis]) / direction[axis];
    };
    int nearest = distance(0) < distance(1) ? 0 : 1;
    if (distance(2) < distance(nearest)) nearest = 2;
    const float inward = direction[nearest] < 0.0f ? 1.0f : -1.0f;
    return {direction,
            distance(nearest),
            {nearest == 0 ? inward : 0, nearest == 1 ? inward : 0, nearest == 2 ? inward : 0}};
}

/// Directions to a light all around, at all distances and angles, against their density.
DirectionTest testBox(int rows, int columns, std::uint32_t count) {
    const Vec3 low{-1.0f, -0.6f, -1.3f}, high{0.7f, 0.9f, 0.8f};
    const auto light = makeAreaLight(boxFromInside(low, high), Spectrum(1.0f), false);
    return testDirections(
        {rows, columns, {}}, count, 1,
        [&](RandomStream& random) -> std::optional<Vec3> {
            const auto s = light->sample({}, random.next2());
            if (!s) return {};
            return s->direction;
        },
        [&](Vec3 d) { return light->pdfSolidAngle(hitOfBox(low, high, d)); });
}

/// Irradiance at a receiver that looks along `normal`.
Summary irradiance(const Light& light, Vec3 receiver, Vec3 normal, std::uint32_t count,
                   std::uint64_t seed) {
    return estimate(count, seed, [&](RandomStream& random) {
        return irradianceOf(light.sample(receiver, random.next2()), normal);
    });
}

// A panel above the origin that faces down, and its corners as seen from there.
const Vec3 panelCorner{-0.4f, 1.0f, -0.7f}, panelX{1.2f, 0.1f, 0}, panelY{0, 0.3f, 0.9f};
std::vector<EmissiveTriangle> panel(int columns, int rows) {
    return rectangle(panelCorner, panelX, panelY, columns, rows);
}
const std::vector<Vec3> panelCorners{panelCorner, panelCorner + panelX,
                                     panelCorner + panelX + panelY, panelCorner + panelY};

/// An icosahedron whose faces are split in four `levels` times, all vertices at `radius`.
std::vector<EmissiveTriangle> sphere(Vec3 center, float radius, int levels) {
    const float g = 0.5f * (1.0f + std::sqrt(5.0f));
    const std::array<Vec3, 12> v{{{-1, g, 0},
                                  {1, g, 0},
                                  {-1, -g, 0},
                                  {1, -g, 0},
                                  {0, -1, g},
                                  {0, 1, g},
                                  {0, -1, -g},
                                  {0, 1, -g},
                                  {g, 0, -1},
                                  {g, 0, 1},
                                  {-g, 0, -1},
                                  {-g, 0, 1}}};
    constexpr std::array<std::array<std::size_t, 3>, 20> faces{
        {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    std::vector<EmissiveTriangle> triangles;
    for (const auto& f : faces)
        triangles.push_back({normalize(v[f[0]]), normalize(v[f[1]]), normalize(v[f[2]])});
    for (int level = 0; level < levels; ++level) {
        std::vector<EmissiveTriangle> finer;
        for (const auto& [a, b, c] : triangles) {
            const Vec3 ab = normalize(a + b), bc = normalize(b + c), ca = normalize(c + a);
            for (const EmissiveTriangle& t :
                 {EmissiveTriangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
                finer.push_back(t);
        }
        triangles = finer;
    }
    for (auto& [a, b, c] : triangles)
        for (Vec3* p : {&a, &b, &c}) *p = center + *p * radius;
    return triangles;
}

}  // namespace

TEST_CASE("AreaLight: directions from within a box follow the density, which integrates to one") {
    const DirectionTest result = testBox(12, 16, 100'000);
    CHECK(result.chiSquare.countInEmptyCells == 0.0);
    CHECK(result.chiSquare.pValue > falseAlarmLevel);
    // The density jumps at the box's edges, where cells are cut to 1/256 of their width: of 192
    // cells some hundred hold an edge, and of each 1/256 may count wrongly, with signs at random.
    CHECK(result.integral == doctest::Approx(1.0).epsilon(0.5 / 256 / 10));
}

TEST_CASE("AreaLight: directions from within a box, on a fine grid and with more samples" *
          doctest::test_suite("statistical")) {
    CHECK(testBox(50, 101, 1'000'000).chiSquare.pValue > sidakLevel(falseAlarmLevel, 2));
    CHECK(testBox(16, 16, 10'000'000).chiSquare.pValue > sidakLevel(falseAlarmLevel, 2));
}

TEST_CASE("AreaLight: emitted directions follow their density on one side and on both") {
    const auto triangles = rectangle({0, 0, 0}, {1, 0, 0.5f}, {0, 1, 0.3f});
    for (const bool isTwoSided : {false, true}) {
        const auto light = makeAreaLight(triangles, Spectrum(1.0f), isTwoSided);
        const Vec3 normal = light->emit({0.5f, 0.5f}, {0.25f, 0.25f})->normal;
        const DirectionTest result = testDirections(
            {30, 61, Frame::fromZ(normal)}, 100'000, 2,
            [&](RandomStream& random) -> std::optional<Vec3> {
                const Vec2 u = random.next2();
                const auto ray = light->emit(u, random.next2());
                if (!ray) return {};
                return ray->direction;
            },
            [&](Vec3 d) {
                return light->emissionPdf({-d, 1.0f, normal}).pdfSolidAngle;
            });
        CHECK(result.chiSquare.countInEmptyCells == 0.0);
        CHECK(result.chiSquare.pValue > sidakLevel(falseAlarmLevel, 2));
        CHECK(result.integral == doctest::Approx(1.0).epsilon(1e-5));
    }
}

TEST_CASE("AreaLight: positions are uniform over 20000 triangles and within each") {
    // Unit squares, so that a position tells its triangle and where in it it lies.
    constexpr int columns = 100, rows = 100, bins = 4;
    const auto light = makeAreaLight(
        rectangle({0, 0, 0}, {columns, 0, 0}, {0, rows, 0}, columns, rows), Spectrum(1.0f), false);
    std::vector<double> byTriangle(columns * rows * 2), within(2 * bins * bins);
    constexpr std::uint32_t count = 400'000;
    for (std::uint32_t i = 0; i < count; ++i) {
        RandomStream random(3, i, 0, RandomDomain::test);
        const auto ray = light->emit(random.next2(), {0.3f, 0.3f});
        REQUIRE(ray);
        const auto split = [](float coordinate, int size) {
            const int whole = std::min(static_cast<int>(coordinate), size - 1);
            return std::pair(whole, coordinate - static_cast<float>(whole));
        };
        const auto [column, x] = split(ray->origin.x, columns);
        const auto [row, y] = split(ray->origin.y, rows);
        const bool isUpper = y > x;
        ++byTriangle[static_cast<std::size_t>((row * columns + column) * 2 + isUpper)];
        // The two triangles of a square, each unfolded to the unit square by area.
        const float longer = isUpper ? y : x, shorter = isUpper ? x : y;
        const int s = std::min(static_cast<int>(longer * longer * bins), bins - 1);
        const int t =
            std::min(static_cast<int>(shorter / std::max(longer, 1e-6f) * bins), bins - 1);
        ++within[static_cast<std::size_t>((isUpper * bins + s) * bins + t)];
    }
    for (const auto& observed : {byTriangle, within}) {
        const std::vector<double> expected(observed.size(),
                                           count / static_cast<double>(observed.size()));
        CHECK(chiSquareTest(observed, expected).pValue > sidakLevel(falseAlarmLevel, 2));
    }
}

TEST_CASE("AreaLight: one of a million triangles is still covered finely") {
    // A float of 24 bits leaves each triangle 16 values of u.x; 50 strips of equal area would show
    // it.
    constexpr int columns = 1000, rows = 500, strips = 50, acrossStrips = 20;
    const auto light = makeAreaLight(
        rectangle({0, 0, 0}, {columns, 0, 0}, {0, rows, 0}, columns, rows), Spectrum(1.0f), false);
    const float middle = 0.75f;  // of u.x: in a row that begins there
    std::vector<double> observed(strips * acrossStrips);
    int count = 0;
    for (std::uint32_t i = 0; i < 100'000; ++i) {
        RandomStream random(4, i, 0, RandomDomain::test);
        const float ux = middle + std::floor(random.next() * 17.0f) * 0x1p-24f;
        const auto ray = light->emit({ux, random.next()}, {0.3f, 0.3f});
        REQUIRE(ray);
        const float x = ray->origin.x, y = ray->origin.y - 0.75f * rows;
        if (x <= 0.0f || x > 1.0f || y > x) continue;  // 17 values reach into the next triangle
        ++count;
        const int s = std::min(static_cast<int>(x * x * strips), strips - 1);
        const int t = std::min(static_cast<int>(y / x * acrossStrips), acrossStrips - 1);
        ++observed[static_cast<std::size_t>(s * acrossStrips + t)];
    }
    REQUIRE(count > 80'000);
    const std::vector<double> expected(observed.size(), count / double{strips * acrossStrips});
    CHECK(chiSquareTest(observed, expected).pValue > falseAlarmLevel);
}

TEST_CASE("AreaLight: irradiance from a rectangle is Lambert's, however finely it is divided") {
    const Vec3 normal = normalize(Vec3{0.1f, 1.0f, -0.2f});
    const double expected = polygonIrradiance(panelCorners, 3.0, {}, normal);
    const std::array<int, 3> divisions{1, 10, 100};  // 2, 200 and 20000 triangles
    for (const int division : divisions) {
        CAPTURE(division);
        const auto light = makeAreaLight(panel(division, division), Spectrum(3.0f), false);
        const Summary result = irradiance(*light, {}, normal, 20'000, 5);
        // Corners of the divided panel are rounded by 6e-8 m, its area and cosines by 1e-6 of them.
        CHECK(meanPValue(result, expected, 2e-6) > sidakLevel(falseAlarmLevel, divisions.size()));
        CHECK(result.standardError < 2e-3 * expected);
        CHECK(
            light->power() ==
            doctest::Approx(3.0 * std::numbers::pi * length(cross(panelX, panelY))).epsilon(1e-5));
    }
}

TEST_CASE("AreaLight: faces without area change nothing") {
    const auto triangles = panel(3, 3);
    std::vector<EmissiveTriangle> withDegenerate;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        withDegenerate.push_back(triangles[i]);
        const auto& [a, b, c] = triangles[i];
        if (i % 4 == 0) withDegenerate.push_back({a, a, b});
        if (i % 7 == 0) withDegenerate.push_back({c, c, c});
    }
    withDegenerate.insert(withDegenerate.begin(), {panelCorner, panelCorner, panelCorner});
    const auto plain = makeAreaLight(triangles, Spectrum(2.0f), false);
    const auto mixed = makeAreaLight(withDegenerate, Spectrum(2.0f), false);
    CHECK(plain->power() == mixed->power());
    int differences = 0;
    for (std::uint32_t i = 0; i < 5000; ++i) {
        RandomStream random(6, i, 0, RandomDomain::test);
        const Vec2 u = random.next2();
        const auto a = plain->sample({}, u), b = mixed->sample({}, u);
        differences += a.has_value() != b.has_value() ||
                       (a && (a->position != b->position || a->pdfSolidAngle != b->pdfSolidAngle));
    }
    CHECK(differences == 0);
}

TEST_CASE("AreaLight: a light of no area at all is dark") {
    const auto light = makeAreaLight({{{1, 1, 1}, {1, 1, 1}, {2, 2, 2}}}, Spectrum(1.0f), true);
    CHECK(light->power() == 0.0f);
    CHECK_FALSE(light->sample({}, {0.5f, 0.5f}));
    CHECK_FALSE(light->emit({0.5f, 0.5f}, {0.5f, 0.5f}));
}

TEST_CASE("AreaLight: a sphere of triangles lights like a sphere") {
    const Vec3 center{0.2f, 2.0f, -0.5f};
    const double distanceSquared = lengthSquared(toDouble(center));
    for (const float radius : {1e-6f, 0.5f}) {
        constexpr float radiance = 1e7f;
        const auto triangles = sphere(center, radius, 3);
        const auto light = makeAreaLight(triangles, Spectrum(radiance), false);
        const Summary result =
            irradiance(*light, {}, toFloat(normalize(toDouble(center))), 50'000, 7);
        const double outer =
            std::numbers::pi * radiance * double{radius} * double{radius} / distanceSquared;
        // The mesh lies between its sphere and the one that its faces touch, and of two convex
        // bodies of equal radiance the one inside the other lights less.
        const double coordinateRounding = 2.0 * 0x1p-23 / radius;
        double inner = 1.0;
        for (const auto& [a, b, c] : triangles)
            inner = std::min(
                inner, length(toDouble(a) + toDouble(b) + toDouble(c) - toDouble(center) * 3.0) /
                           (3.0 * radius));
        const double margin = studentQuantile(1.0 - falseAlarmLevel, 1e6) * result.standardError;
        CAPTURE(radius);
        CHECK(result.mean < outer * (1.0 + 2.0 * coordinateRounding) + margin);
        CHECK(result.mean > outer * (inner * inner - 2.0 * coordinateRounding) - margin);
        CHECK(result.standardError < 0.01 * result.mean);
    }
}

TEST_CASE("AreaLight: one side is dark, two sides shine twice the power") {
    const auto triangles = panel(1, 1);
    const auto oneSided = makeAreaLight(triangles, Spectrum(1.0f), false);
    const auto twoSided = makeAreaLight(triangles, Spectrum(1.0f), true);
    const Vec3 front{0, 3, 0.5f}, back{0, -1, 0};
    const bool isUpFront = oneSided->sample(front, {0.5f, 0.5f}).has_value();
    const Vec3 lit = isUpFront ? front : back, dark = isUpFront ? back : front;
    CHECK(oneSided->sample(lit, {0.5f, 0.5f}));
    CHECK_FALSE(oneSided->sample(dark, {0.5f, 0.5f}));
    CHECK(twoSided->sample(lit, {0.5f, 0.5f}));
    const auto s = twoSided->sample(dark, {0.5f, 0.5f});
    REQUIRE(s);
    const EmitterHit fromBehind{s->direction, s->distance, s->normal};
    CHECK(dot(s->direction, s->normal) > 0.0f);
    CHECK(isBlack(oneSided->radiance(fromBehind)));
    CHECK(oneSided->pdfSolidAngle(fromBehind) == 0.0f);
    CHECK(oneSided->emissionPdf(fromBehind).pdfSolidAngle == 0.0f);
    CHECK(twoSided->power() == 2.0f * oneSided->power());
    // From its plane nothing is seen.
    const EmitterHit grazing{{1, 0, 0}, 1.0f, {0, 1, 0}};
    CHECK(isBlack(twoSided->radiance(grazing)));
    CHECK(twoSided->pdfSolidAngle(grazing) == 0.0f);
}

TEST_CASE("AreaLight: the position lies within its error bound of the triangle's plane") {
    int outside = 0, loose = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
        RandomStream random(8, i, 0, RandomDomain::test);
        const float scale = std::pow(10.0f, 12.0f * random.next() - 6.0f);
        const auto point = [&] {
            return Vec3{random.next() + 3.0f, random.next(), random.next() - 0.5f} * scale;
        };
        const EmissiveTriangle t{point(), point(), point()};
        const auto light = makeAreaLight({t}, Spectrum(1.0f), true);
        const auto ray = light->emit(random.next2(), {0.3f, 0.4f});
        if (!ray) continue;
        const Vec3d a = toDouble(t.a);
        const Vec3d n = normalize(cross(toDouble(t.b) - a, toDouble(t.c) - a));
        const double distance = std::abs(dot(toDouble(ray->origin) - a, n));
        outside += distance > dot(abs(n), toDouble(ray->originError));
        loose += maxComponent(ray->originError) > 1e-6f * maxComponent(abs(ray->origin)) * 2.0f;
    }
    CHECK(outside == 0);
    CHECK(loose == 0);
}
