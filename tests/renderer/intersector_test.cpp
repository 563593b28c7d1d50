#include "renderer/intersector.h"

#include <doctest/doctest.h>

#include <cmath>

#include "renderer/mesh_normals.h"
#include "renderer/random.h"
#include "renderer/sampling.h"
#include "renderer/shapes.h"
#include "renderer/visibility.h"
#include "tests/support/scenes.h"

using namespace etendue;

namespace {

struct Escapes {
    int tried = 0, failed = 0;
};

std::string sphereScene(double radius, Vec3 center, bool isInstanced) {
    const std::string sphere = "shape = \"sphere\"\nsmooth = false\nsegments = 40\n";
    const std::string transform =
        "transform = [{rotate = [1, 2, 3, 40]}, {scale = " + std::to_string(radius * 1e6) +
        "e-6}, {translate = [" + std::to_string(center.x) + ", " + std::to_string(center.y) + ", " +
        std::to_string(center.z) + "]}]\n";
    if (!isInstanced) return "[[mesh]]\n" + sphere + transform;
    return "[[mesh]]\nname = \"s\"\nhidden = true\n" + sphere + "[[instance]]\nmesh = \"s\"\n" +
           transform + "[[instance]]\nmesh = \"s\"\ntransform = [{translate = [-1e7, 0, 0]}]\n";
}

/// Rays leave random points of a faceted sphere: outward ones must escape it, inward ones must meet
/// it.
Escapes leaveSphere(const std::string& text, double radius, Vec3 center, int count) {
    const LoadedScene loaded = sceneFromText(text);
    const Scene& scene = *loaded.scene;
    Escapes result;
    for (int i = 0; i < count; ++i) {
        RandomStream random(7, static_cast<std::uint32_t>(i), 0, RandomDomain::test);
        const Vec3 aim = sampleUnitSphere(random.next2());
        const Vec3 origin =
            center + sampleUnitSphere(random.next2()) * static_cast<float>(3.0 * radius);
        const Vec3 target = center + aim * static_cast<float>(0.9 * radius);
        const auto point = scene.closestHit({origin, normalize(target - origin)});
        if (!point) {
            ++result.failed;
            continue;
        }
        const Vec3 local = sampleCosineHemisphere(random.next2());
        const Vec3 out = Frame::fromZ(point->geometricNormal).worldFromLocal(local);
        // Nearly tangent rays leave the facet's plane by less than rounding can resolve.
        result.tried += 2;
        if (scene.closestHit({offsetOrigin(*point, out), out})) ++result.failed;
        if (!scene.closestHit({offsetOrigin(*point, -out), -out})) ++result.failed;
    }
    return result;
}

}  // namespace

TEST_CASE("Intersector: a ray that leaves a surface does not meet it again, at any scale") {
    for (const double radius : {1e-4, 1e-2, 1.0, 1e3, 1e6})
        for (const bool isInstanced : {false, true}) {
            CAPTURE(radius);
            CAPTURE(isInstanced);
            const Escapes e = leaveSphere(sphereScene(radius, {}, isInstanced), radius, {}, 20000);
            CHECK(e.tried == 40000);
            CHECK(e.failed == 0);
        }
}

TEST_CASE("Intersector: nor does it far from the origin, where float coordinates are coarse") {
    const Vec3 center{1000.0f, -2000.0f, 500.0f};
    for (const bool isInstanced : {false, true}) {
        CAPTURE(isInstanced);
        const Escapes e = leaveSphere(sphereScene(1.0, center, isInstanced), 1.0, center, 20000);
        CHECK(e.failed == 0);
    }
}

TEST_CASE("Intersector: rays that are not finite are refused and counted") {
    const LoadedScene loaded = sceneFromText(sphereScene(1.0, {}, false));
    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    const Intersector& intersector = loaded.scene->intersector();
    const Vec3 z{0, 0, 1};
    CHECK_FALSE(intersector.closestHit({{nan, 0, 0}, z}));
    CHECK_FALSE(intersector.closestHit({{0, infinity, 0}, z}));
    CHECK_FALSE(intersector.closestHit({{0, 0, 2e18f}, z}));
    CHECK_FALSE(intersector.closestHit({{}, {0, nan, 0}}));
    CHECK_FALSE(intersector.closestHit({{}, {}}));
    CHECK_FALSE(intersector.closestHit({{}, z, nan}));
    CHECK(intersector.isOccluded({{nan, 0, 0}, z}));
    CHECK(loaded.scene->refusedRays() == 7);
    CHECK(intersector.closestHit({{}, z}));
}

TEST_CASE("Intersector: rays too far to be followed into an instance that shrinks are refused") {
    // In the mesh's space, a million million times the size, Embree would abort the process.
    const LoadedScene loaded = sceneFromText(
        "[[mesh]]\nshape = \"sphere\"\nname = \"s\"\n[[instance]]\nmesh = \"s\"\n"
        "transform = [{scale = 1e-12}, {translate = [5, 0, 0]}]\n");
    const Intersector& intersector = loaded.scene->intersector();
    const Vec3 z{0, 0, -1};
    CHECK_FALSE(intersector.closestHit({{0, 0, 1e9f}, z}));
    CHECK(intersector.isOccluded({{0, 0, 1e9f}, z}));
    CHECK(loaded.scene->refusedRays() == 2);
    CHECK(intersector.closestHit({{0, 0, 1e5f}, z}));
    CHECK(loaded.scene->refusedRays() == 2);
}

TEST_CASE("Intersector: a mirrored instance keeps its front side in front") {
    for (const char* transforms :
         {"transform = [{scale = [-1, 1, 1]}]", "transform = [{scale = -2}]"}) {
        const std::string placed = std::string("[[mesh]]\nshape = \"sphere\"\n") + transforms;
        const std::string instanced =
            std::string(
                "[[mesh]]\nname = \"s\"\nshape = \"sphere\"\nhidden = true\n[[instance]]\nmesh = "
                "\"s\"\n") +
            transforms + "\n[[instance]]\nmesh = \"s\"\ntransform = [{translate = [9, 0, 0]}]\n";
        for (const std::string& text : {placed, instanced}) {
            const LoadedScene loaded = sceneFromText(text);
            const auto point = loaded.scene->closestHit({{0.3f, 0.2f, 5.0f}, {0, 0, -1}});
            REQUIRE(point);
            CHECK(point->geometricNormal.z > 0.9f);
            CHECK(point->shading.z.z > 0.9f);
        }
    }
}

TEST_CASE("Intersector: opacity is the share of rays that meet the surface") {
    const LoadedScene loaded = sceneFromText(R"(
[[material]]
name = "veil"
opacity = 0.3
[[mesh]]
shape = "rectangle"
material = "veil"
)");
    constexpr int count = 40000;
    int hits = 0, occlusions = 0;
    for (int i = 0; i < count; ++i) {
        RandomStream random(3, static_cast<std::uint32_t>(i), 0, RandomDomain::test);
        const Vec2 u = random.next2();
        const Ray ray{{u.x - 0.5f, u.y - 0.5f, 1.0f}, {0, 0, -1}};
        hits += loaded.scene->closestHit(ray).has_value();
        occlusions += loaded.scene->intersector().isOccluded(ray);
    }
    // Four standard errors of a binomial share.
    const double error = 4.0 * std::sqrt(0.3 * 0.7 / count);
    CHECK(std::abs(hits / static_cast<double>(count) - 0.3) < error);
    CHECK(hits == occlusions);
}

TEST_CASE("Visibility: a ray that ends on a surface is not stopped by that surface") {
    // Each end has small coordinates where the ray comes from large ones, and the other way round:
    // the intersector rounds in proportion to both.
    for (const double distance : {0.3, 2.0, 50.0, 3000.0})
        for (const double shift : {0.0, 1e-3, 64.0}) {
            const std::string text =
                "[[mesh]]\nshape = \"rectangle\"\ntransform = [{scale = 0.25}, {rotate = [1, 0, 0, "
                "-90]}, {rotate = [0, 0, 1, 3]}, {translate = [" +
                std::to_string(shift) + ", " + std::to_string(shift) +
                ", 0]}]\n[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";
            const LoadedScene loaded = sceneFromText(text);
            int hits = 0, stopped = 0;
            for (std::uint32_t i = 0; i < 5000; ++i) {
                RandomStream random(3, i, 0, RandomDomain::test);
                const float s = static_cast<float>(shift), d = static_cast<float>(distance);
                const Vec3 from{s + d * (random.next() - 0.5f), s + d, d * (random.next() - 0.5f)};
                const Vec3 aim{s + 0.4f * (random.next() - 0.5f), s, 0.4f * (random.next() - 0.5f)};
                const auto end = loaded.scene->closestHit({from, normalize(aim - from)});
                if (!end) continue;
                ++hits;
                const SurfacePoint start = bareSurfacePoint(from, {}, {0, 1, 0});
                stopped += !isVisible(*loaded.scene, start, *end);
                const LightSample sample{.direction = normalize(end->position - from),
                                         .distance = length(end->position - from),
                                         .position = end->position,
                                         .positionError = end->positionError,
                                         .normal = end->geometricNormal,
                                         .radiance = {}};
                stopped += !isVisible(*loaded.scene, start, sample);
            }
            CAPTURE(distance);
            CAPTURE(shift);
            CHECK(hits > 1000);
            CHECK(stopped == 0);
        }
}
