#include "renderer/sampling.h"

#include <doctest/doctest.h>

#include <functional>
#include <vector>

#include "renderer/frame.h"
#include "renderer/random.h"
#include "renderer/transform.h"
#include "statistics/statistics.h"

using namespace etendue;

namespace {

/// χ² of a map whose image, through `unitSquare`, must be uniform.
double uniformityP(const std::function<Vec2(Vec2)>& unitSquareFromSample) {
    constexpr int cells = 20, count = cells * cells * 250;
    std::vector<double> observed(cells * cells), expected(cells * cells, 250.0);
    for (std::uint32_t i = 0; i < count; ++i) {
        RandomStream random(9, i, 0, RandomDomain::test);
        const Vec2 p = unitSquareFromSample(random.next2());
        const auto x = static_cast<std::size_t>(std::clamp(p.x * cells, 0.0f, cells - 1.0f));
        const auto y = static_cast<std::size_t>(std::clamp(p.y * cells, 0.0f, cells - 1.0f));
        ++observed[y * cells + x];
    }
    return chiSquareTest(observed, expected).pValue;
}

float turns(float y, float x) {
    const float t = std::atan2(y, x) / (2 * pi);
    return t < 0 ? t + 1 : t;
}

const std::vector<float> edges{0.0f, 0x1p-32f, 0x1.fffffep-1f};

}  // namespace

TEST_CASE("Sampling: every map has the density it claims") {
    // Each map is followed by the inverse of its claimed distribution: (radius², angle) on the
    // disc, and so on. What comes out must be uniform.
    const double level = sidakLevel(0.01, 5);
    CHECK(uniformityP([](Vec2 u) {
              const Vec2 d = sampleUnitDisc(u);
              return Vec2{d.x * d.x + d.y * d.y, turns(d.y, d.x)};
          }) > level);
    CHECK(uniformityP([](Vec2 u) {
              const Vec3 d = sampleCosineHemisphere(u);  // cdf of cosθ: cos²θ
              return Vec2{d.z * d.z, turns(d.y, d.x)};
          }) > level);
    CHECK(uniformityP([](Vec2 u) {
              const Vec3 d = sampleUnitSphere(u);
              return Vec2{0.5f * (d.z + 1), turns(d.y, d.x)};
          }) > level);
    CHECK(uniformityP([](Vec2 u) {
              const Vec3 d = sampleCone(u, 0.3f);
              return Vec2{(1 - d.z) / 0.3f, turns(d.y, d.x)};
          }) > level);
    CHECK(uniformityP([](Vec2 u) {
              const Vec2 b = sampleTriangle(u);  // cdf of b1 + b2 = s: s²
              const float s = b.x + b.y;
              return Vec2{s * s, b.y / s};
          }) > level);
}

TEST_CASE("Sampling: random numbers at the edge give points on the domain") {
    for (const float x : edges)
        for (const float y : edges) {
            const Vec2 u{x, y};
            const Vec2 disc = sampleUnitDisc(u);
            CHECK(disc.x * disc.x + disc.y * disc.y <= 1.0f + 1e-6f);
            // Unit to a few roundings of 2⁻²⁴.
            CHECK(std::abs(length(sampleCosineHemisphere(u)) - 1.0f) < 1e-6f);
            CHECK(std::abs(length(sampleUnitSphere(u)) - 1.0f) < 1e-6f);
            CHECK(std::abs(length(sampleCone(u, 1e-6f)) - 1.0f) < 1e-6f);
            const Vec2 b = sampleTriangle(u);
            CHECK(b.x >= 0.0f);
            CHECK(b.y >= 0.0f);
            CHECK(b.x + b.y <= 1.0f + 1e-7f);
        }
}

TEST_CASE("Sampling: the unit circle is the library's to its last bits") {
    // One rounding of the result, and one of the argument, each half an ulp of 1.
    constexpr double tolerance = 0x1p-23;
    for (int i = 0; i <= 100000; ++i) {
        const float turns = static_cast<float>(i) / 100000;
        const Vec2 p = onUnitCircle(turns);
        const double angle = 2.0 * std::numbers::pi * turns;
        REQUIRE(std::abs(p.x - std::cos(angle)) < tolerance);
        REQUIRE(std::abs(p.y - std::sin(angle)) < tolerance);
    }
}

TEST_CASE("Vec3: renormalizing undoes a rounding") {
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const Vec3 unit = sampleUnitSphere(RandomStream(1, i, 0).next2());
        // Off by ε the square of the length is off by 2ε; what is left is 3/2 ε² and rounding.
        const Vec3d off = normalize(toDouble(unit)) * (1.0 + 1e-5);
        REQUIRE(std::abs(length(renormalize(off)) - 1.0) < 2e-10);
    }
}

TEST_CASE("Frame: orthonormal around any normal, the poles included") {
    std::vector<Vec3> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -0.0f}};
    normals.pop_back();
    for (std::uint32_t i = 0; i < 1000; ++i)
        normals.push_back(sampleUnitSphere(RandomStream(1, i, 0).next2()));
    for (const Vec3 n : normals) {
        const Frame f = Frame::fromZ(n);
        CHECK(std::abs(dot(f.x, f.y)) < 1e-6f);
        CHECK(std::abs(dot(f.x, f.z)) < 1e-6f);
        CHECK(std::abs(length(f.x) - 1) < 1e-6f);
        CHECK(dot(cross(f.x, f.y), n) == doctest::Approx(1.0).epsilon(1e-5));
        const Vec3 v{0.3f, -0.5f, 0.8f};
        CHECK(length(f.worldFromLocal(f.localFromWorld(v)) - v) < 1e-6f);
    }
}

TEST_CASE("Transform: inverse, composition and normals") {
    const Transform t = Transform::translate({1, 2, 3}) *
                        Transform::rotate(normalize(Vec3d{1, 2, -1}), 50) *
                        Transform::scale({2, -0.5, 3});
    const Vec3d p{0.3, -4.0, 1.5}, a{1, 0.2, 0}, b{0, 1, -0.3};
    CHECK(length(t.inverse().point(t.point(p)) - p) < 1e-14);
    CHECK(t.determinant() == doctest::Approx(-3.0));
    // The normal of the transformed plane, up to length and sign.
    const Vec3d n = normalize(t.normal(cross(a, b))),
                m = normalize(cross(t.vector(a), t.vector(b)));
    CHECK(std::abs(dot(n, m)) == doctest::Approx(1.0).epsilon(1e-14));
    // A quarter turn about y carries +z to +x.
    CHECK(length(Transform::rotate({0, 1, 0}, 90).vector({0, 0, 1}) - Vec3d{1, 0, 0}) < 1e-15);
}
