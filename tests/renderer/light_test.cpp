// What holds for every light. Each kind has tests of its own besides.
#include "renderer/light.h"

#include <doctest/doctest.h>

#include "renderer/frame.h"
#include "renderer/sampling.h"
#include "tests/renderer/light_fixtures.h"
#include "tests/support/chi_square_sphere.h"
#include "tests/support/estimate.h"

using namespace etendue;

namespace {

constexpr float smallestNormal = std::numeric_limits<float>::min();

/// Fit to be multiplied on: floats hold it, its density, and their quotient.
bool isUsable(const LightSample& s, bool isInfinite) {
    return isFinite(s.direction) && std::abs(length(s.direction) - 1.0f) < 1e-6f &&
           isFinite(s.radiance) && isFinite(s.normal) && std::isinf(s.distance) == isInfinite &&
           !std::isnan(s.distance) && isFinite(s.position) && isFinite(s.positionError) &&
           std::isfinite(s.pdfSolidAngle) && s.pdfSolidAngle >= smallestNormal &&
           isFinite(s.radiance / Spectrum(s.pdfSolidAngle));
}

bool isUsable(const EmittedRay& r) {
    return isFinite(r.origin) && isFinite(r.originError) && isFinite(r.direction) &&
           std::abs(length(r.direction) - 1.0f) < 1e-6f && isFinite(r.radiance) &&
           r.cosTheta > 0.0f && std::isfinite(r.pdf.pdfArea) && r.pdf.pdfArea >= smallestNormal &&
           std::isfinite(r.pdf.pdfSolidAngle) && r.pdf.pdfSolidAngle >= smallestNormal;
}

EmitterHit hitOf(const LightSample& s) { return {s.direction, s.distance, s.normal}; }

}  // namespace

TEST_CASE("Light: edge random numbers and places give a finite sample or none") {
    const float edges[] = {0.0f, 0x1p-32f, 0.5f, 1.0f - 0x1p-24f};
    // On the panel, in its plane, 1e-20 from it and from the point lights, and far away.
    const Vec3 places[] = {{0, 1.1f, 0},       {-0.5f, 1.0f, -0.4f},
                           {5, 1.0f, -0.4f},   {1e-20f, 1.1f, 1e-20f},
                           {0, 0, 0},          {0.2f, 1.0f, 0.3f},
                           {1e15f, 0, 0},      {0, -1e15f, 1e15f},
                           {0.1f, 1.0f, 0.0f}, {0.1f, std::nextafter(1.0f, 0.0f), 0.0f}};
    for (const NamedLight& kind : everyLight())
        for (const float x : edges)
            for (const float y : edges) {
                CAPTURE(kind.name);
                for (const Vec3 place : places)
                    if (const auto s = kind.light->sample(place, {x, y}))
                        CHECK(isUsable(*s, kind.light->isInfinite()));
                for (const float z : edges)
                    for (const float w : edges)
                        if (const auto ray = kind.light->emit({x, y}, {z, w}))
                            CHECK(isUsable(*ray));
            }
}

TEST_CASE("Light: receivers 1e-20 from a light at the origin get a finite sample or none") {
    const auto triangles = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const auto area = makeAreaLight(triangles, Spectrum(1e7f), true);
    const auto point = makePointLight({}, Spectrum(1e7f));
    const auto spot = makeSpotLight({}, {0, 0, 1}, Spectrum(1e7f), 10, 90);
    for (const Light* light : {area.get(), point.get(), spot.get()})
        for (const float distance :
             {0.0f, 1e-45f, 1e-20f, 1e-18f, 1e-16f, 1e-10f, 1.0f, 1e10f, 1e15f, 1e19f, 1e30f})
            for (const Vec3 axis : {Vec3{0, 0, 1}, Vec3{0.6f, 0, 0.8f}, Vec3{1, 0, 0}})
                for (const Vec2 u : {Vec2{0, 0}, Vec2{0x1p-32f, 0x1p-32f}, Vec2{0.3f, 0.6f}})
                    if (const auto s = light->sample(axis * distance, u))
                        CHECK(isUsable(*s, false));
}

TEST_CASE("Light: sample() reports the density and radiance that a ray would find there") {
    for (const NamedLight& kind : everyLight()) {
        CAPTURE(kind.name);
        int differences = 0, samples = 0;
        for (std::uint32_t i = 0; i < 2000; ++i) {
            RandomStream random(1, i, 0, RandomDomain::test);
            // Where one of the light's own rays passes, so that even a narrow cone is met.
            const Vec2 u = random.next2();
            const auto ray = kind.light->emit(u, random.next2());
            if (!ray) continue;
            const auto s = kind.light->sample(ray->origin + ray->direction * 1.5f, random.next2());
            if (!s) continue;
            ++samples;
            if (s->isDirac)
                differences += !isBlack(kind.light->radiance(hitOf(*s))) ||
                               kind.light->pdfSolidAngle(hitOf(*s)) != 0.0f ||
                               s->pdfSolidAngle != 1.0f;
            else
                differences += kind.light->radiance(hitOf(*s)) != s->radiance ||
                               kind.light->pdfSolidAngle(hitOf(*s)) != s->pdfSolidAngle;
        }
        CHECK(differences == 0);
        CHECK(samples > 400);
    }
}

TEST_CASE("Light: emit() reports the densities that emissionPdf() finds for its ray") {
    for (const NamedLight& kind : everyLight()) {
        CAPTURE(kind.name);
        int differences = 0, rays = 0;
        for (std::uint32_t i = 0; i < 2000; ++i) {
            RandomStream random(2, i, 0, RandomDomain::test);
            const Vec2 u = random.next2();
            const auto ray = kind.light->emit(u, random.next2());
            if (!ray) continue;
            ++rays;
            const EmitterHit hit{-ray->direction, 1.0f, ray->normal};
            const EmissionPdf pdf = kind.light->emissionPdf(hit);
            differences += pdf.pdfArea != ray->pdf.pdfArea ||
                           pdf.pdfSolidAngle != ray->pdf.pdfSolidAngle || !isUsable(*ray);
            if (!ray->isDiracPosition && !ray->isDiracDirection)
                differences += kind.light->radiance(hit) != ray->radiance;
        }
        CHECK(differences == 0);
        CHECK(rays > 1900);  // all but the dark corners
    }
}

TEST_CASE("Light: the mean flux of emitted rays is the power") {
    const auto lights = everyLight();
    for (const NamedLight& kind : lights) {
        CAPTURE(kind.name);
        const Summary flux = estimate(20'000, 3, [&](RandomStream& random) {
            const Vec2 u = random.next2();
            return fluxOf(kind.light->emit(u, random.next2()));
        });
        CAPTURE(flux.mean);
        CAPTURE(kind.light->power());
        // A ray's flux is a product of some ten rounded factors.
        CHECK(meanPValue(flux, kind.light->power(), 10 * 0x1p-24) >
              sidakLevel(falseAlarmLevel, lights.size()));
    }
}

TEST_CASE("Light: rays start where the light is") {
    for (const NamedLight& kind : everyLight()) {
        CAPTURE(kind.name);
        int wrong = 0;
        for (std::uint32_t i = 0; i < 500; ++i) {
            RandomStream random(4, i, 0, RandomDomain::test);
            const Vec2 u = random.next2();
            const auto ray = kind.light->emit(u, random.next2());
            if (!ray) continue;
            wrong += std::abs(dot(ray->direction, ray->normal) - ray->cosTheta) > 1e-6f;
            if (!kind.light->isInfinite()) continue;
            const Vec3 fromCenter = ray->origin - testBounds.center;
            const float along = dot(fromCenter, ray->direction);
            const float across = length(fromCenter - ray->direction * along);
            // Coordinates of a few metres are rounded by less than 1e-6 m.
            wrong += along > -testBounds.radius || across > testBounds.radius + 1e-6f ||
                     ray->originError != Vec3{};
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("Light: rays from infinity start evenly on a disc as wide as the scene") {
    const auto lights = everyLight();
    for (const NamedLight& kind : lights) {
        if (!kind.light->isInfinite()) continue;
        CAPTURE(kind.name);
        constexpr std::uint32_t count = 20'000;
        constexpr int rings = 8, sectors = 9;
        std::vector<double> observed(rings * sectors),
            expected(rings * sectors, count / double{rings * sectors});
        for (std::uint32_t i = 0; i < count; ++i) {
            RandomStream random(5, i, 0, RandomDomain::test);
            const auto ray = kind.light->emit(random.next2(), {0.3f, 0.6f});
            REQUIRE(ray);
            const Vec3 p =
                Frame::fromZ(ray->direction).localFromWorld(ray->origin - testBounds.center);
            const float areaShare = (p.x * p.x + p.y * p.y) / square(testBounds.radius);
            const float turn = std::atan2(p.y, p.x) / (2 * pi) + 0.5f;
            const int ring = std::min(static_cast<int>(areaShare * rings), rings - 1);
            const int sector = std::min(static_cast<int>(turn * sectors), sectors - 1);
            ++observed[static_cast<std::size_t>(ring * sectors + sector)];
        }
        CHECK(chiSquareTest(observed, expected).pValue >
              sidakLevel(falseAlarmLevel, lights.size()));
    }
}

TEST_CASE("Light: constant and point lights draw all directions alike, directional ones just one") {
    const auto constant = makeConstantLight(Spectrum(1.0f), testBounds);
    const auto point = makePointLight({}, Spectrum(1.0f));
    using Direction = std::optional<Vec3>;
    const auto checkUniform = [](const auto& draw, const auto& density) {
        const auto result = testDirections({20, 41, {}}, 50'000, 6, draw, density);
        CHECK(result.chiSquare.pValue > sidakLevel(falseAlarmLevel, 3));
        CHECK(result.integral == doctest::Approx(1.0).epsilon(1e-6));
    };
    checkUniform(
        [&](RandomStream& random) {
            return Direction(constant->sample({}, random.next2())->direction);
        },
        [&](Vec3 d) {
            return constant->pdfSolidAngle({d, 1.0f, -d});
        });
    checkUniform(
        [&](RandomStream& random) {
            return Direction(constant->emit({}, random.next2())->direction);
        },
        [&](Vec3 d) {
            return constant->emissionPdf({-d, 1.0f, d}).pdfSolidAngle;
        });
    checkUniform(
        [&](RandomStream& random) { return Direction(point->emit({}, random.next2())->direction); },
        [&](Vec3 d) {
            return point->emissionPdf({-d, 1.0f, d}).pdfSolidAngle;
        });
    const auto directional = makeDirectionalLight({0, 0, 1}, Spectrum(2.0f), testBounds);
    CHECK(directional->sample({}, {0.1f, 0.2f})->direction == Vec3{0, 0, -1});
    CHECK(directional->emit({0.1f, 0.2f}, {0.3f, 0.4f})->direction == Vec3{0, 0, 1});
    CHECK(directional->sample({}, {0.1f, 0.2f})->radiance == Spectrum(2.0f));
}

TEST_CASE("Light: point light falls off with the square of the distance") {
    const auto light = makePointLight({1, 2, 3}, Spectrum(8.0f));
    CHECK(light->sample({1, 2, 1}, {})->radiance == Spectrum(2.0f));
    CHECK(light->sample({1, 2, 1}, {})->direction == Vec3{0, 0, 1});
    CHECK(light->sample({1, 2, 1}, {})->distance == 2.0f);
    CHECK_FALSE(light->sample({1, 2, 3}, {}));
    CHECK(relativeError(light->power(), 8.0 * 4.0 * std::numbers::pi) < 1e-6);
}

TEST_CASE("Light: emission brings a receiver the light that sampling finds from it" *
          doctest::test_suite("statistical")) {
    // Inside the bounds: in the narrow spot's light, behind the panel, close to the border.
    struct Disc {
        Vec3 center, normal;
        float radius;
    };
    const Disc discs[] = {{{0.6f, -0.3f, 0.5f}, normalize(Vec3{0.2f, 1, -0.1f}), 0.4f},
                          {{-0.2f, 1.6f, 0.2f}, normalize(Vec3{0.1f, -1, 0.1f}), 0.3f},
                          {{0.3f, -0.2f, -1.6f}, normalize(Vec3{-0.5f, 1, 0.6f}), 0.25f}};
    const auto lights = everyLight();
    for (const NamedLight& kind : lights)
        for (const Disc& disc : discs) {
            CAPTURE(kind.name);
            const float discArea = pi * square(disc.radius);
            std::vector<double> sampled, emitted;
            for (std::uint32_t i = 0; i < 100'000; ++i) {
                RandomStream random(7, i, 0, RandomDomain::test);
                const Vec2 p = sampleUnitDisc(random.next2()) * disc.radius;
                const Frame frame = Frame::fromZ(disc.normal);
                const Vec3 receiver = disc.center + frame.x * p.x + frame.y * p.y;
                sampled.push_back(
                    irradianceOf(kind.light->sample(receiver, random.next2()), disc.normal));

                const Vec2 u = random.next2();
                const auto ray = kind.light->emit(u, random.next2());
                const float facing = ray ? -dot(ray->direction, disc.normal) : 0.0f;
                if (facing <= 0.0f) {
                    emitted.push_back(0.0);
                    continue;
                }
                const float t = dot(ray->origin - disc.center, disc.normal) / facing;
                const Vec3 fromCenter = ray->origin + ray->direction * t - disc.center;
                const bool arrives = t > 0.0f && length(fromCenter) < disc.radius;
                emitted.push_back(arrives ? fluxOf(ray) / discArea : 0.0);
            }
            const WelchResult result = welchTest(sampled, emitted);
            CAPTURE(result.difference);
            CAPTURE(result.standardError);
            // Both see exactly nothing where a light does not shine, and a directional light's
            // irradiance is known to rounding.
            CHECK(result.pValue > sidakLevel(falseAlarmLevel, lights.size() * std::size(discs)));
        }
}
