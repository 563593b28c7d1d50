#include "renderer/ggx.h"

#include <doctest/doctest.h>

#include <initializer_list>
#include <limits>

#include "renderer/fresnel.h"
#include "tests/renderer/bsdf_cases.h"
#include "tests/support/chi_square_sphere.h"

namespace etendue {

namespace {

constexpr double epsilon = std::numeric_limits<float>::epsilon();
constexpr double falseAlarm = 1e-3;

double squared(double x) { return x * x; }

/// Smith's Λ as published (Walter et al. 2007, eq. 34; Heitz 2014, eq. 72).
double textbookLambda(Vec3 v, double alpha) {
    const double tanSquared = (squared(v.x) + squared(v.y)) / squared(v.z);
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * tanSquared) - 1.0);
}

double visibleNormalDensity(const Ggx& ggx, Vec3 wo, Vec3 m) {
    if (m.z <= 0.0f) return 0.0;
    return double{ggx.g1OverCosine(wo)} * std::max(0.0f, dot(wo, m)) * double{ggx.density(m)};
}

/// A grid that is fine where the normals are.
SphereGrid gridForNormals(int rows, int columns, float alpha) {
    return {rows, columns, {}, alpha < 0.05f ? 5.0 : 1.0};
}

}  // namespace

TEST_CASE("Ggx: density is the published one, without cancellation, down to the smallest α") {
    for (const float alpha : {smallestAlpha, 1e-4f, 1e-2f, 0.3f, 1.0f}) {
        const Ggx ggx(alpha);
        for (const float multiple : {0.0f, 0.1f, 1.0f, 5.0f, 100.0f}) {
            const Vec3 m = normalize(Vec3{0.6f * multiple * alpha, -0.8f * multiple * alpha, 1.0f});
            const double tanSquared = (squared(m.x) + squared(m.y)) / squared(m.z);
            const double a2 = squared(alpha);
            const double published =
                a2 / (std::numbers::pi * squared(squared(m.z)) * squared(a2 + tanSquared));
            // The exponent −2 doubles the roundings of its base, α's enter twice.
            CHECK(double{ggx.density(m)} == doctest::Approx(published).epsilon(16.0 * epsilon));
        }
    }
}

TEST_CASE("Ggx: the facets' projected area is that of the surface") {
    // ∫ D cosθ dω, by the midpoint rule in y with tanθ = α sinh y: its error, from the slope 2 at
    // y = 0, is step² / 12 = 5e-8, less than a float's rounding.
    for (const float alpha : {smallestAlpha, 1e-2f, 0.3f, 1.0f}) {
        const Ggx ggx(alpha);
        constexpr int count = 40000;
        const double last = 30.0;
        double sum = 0.0;
        for (int i = 0; i < count; ++i) {
            const double y = (i + 0.5) / count * last, tangent = double{alpha} * std::sinh(y);
            const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
            const Vec3 m = toFloat(Vec3d{tangent * cosine, 0.0, cosine});
            // dω = sinθ dθ dφ = tanθ cos³θ d(tanθ) dφ
            sum += double{ggx.density(m)} * cosine * tangent * cosine * cosine * cosine *
                   double{alpha} * std::cosh(y) * 2.0 * std::numbers::pi * last / count;
        }
        // D carries up to 16 roundings, see above.
        CHECK(sum == doctest::Approx(1.0).epsilon(16.0 * epsilon));
    }
}

TEST_CASE("Ggx: masking is Smith's, alone and height-correlated") {
    for (const float alpha : {1e-4f, 1e-2f, 0.3f, 1.0f})
        for (const float cosO : {0.01f, 0.3f, 0.9f, 1.0f})
            for (const float cosI : {-1.0f, -0.2f, 0.05f, 0.7f}) {
                const Ggx ggx(alpha);
                const Vec3 wo = atCosine(cosO), wi = atCosine(cosI);
                const double lambdaO = textbookLambda(wo, alpha),
                             lambdaI = textbookLambda(wi, alpha);
                const double g1 = 1.0 / (1.0 + lambdaO), g2 = 1.0 / (1.0 + lambdaO + lambdaI);
                CHECK(double{ggx.g1OverCosine(wo)} * double{cosO} ==
                      doctest::Approx(g1).epsilon(8.0 * epsilon));
                CHECK(double{ggx.g2OverCosines(wo, wi)} * double{cosO} * std::abs(double{cosI}) ==
                      doctest::Approx(g2).epsilon(8.0 * epsilon));
                CHECK(g2 <= g1);
            }
}

TEST_CASE("Ggx: densities of visible normals integrate to one") {
    for (const float alpha : {0.01f, 0.1f, 0.36f, 1.0f})
        for (const float cosine : {0.05f, 0.4f, 0.9f, 1.0f}) {
            const Ggx ggx(alpha);
            const Vec3 wo = atCosine(cosine);
            const double integral = integrateSphere(gridForNormals(16, 16, alpha), [&](Vec3 m) {
                return visibleNormalDensity(ggx, wo, m);
            });
            // The integrator's own bound, 1e-7 per cell and 1e-5 of the value.
            CHECK(integral == doctest::Approx(1.0).epsilon(4e-5));
        }
}

TEST_CASE("Ggx: sampled visible normals have their density") {
    const std::initializer_list<float> alphas{0.01f, 0.1f, 0.36f, 1.0f}, cosines{0.05f, 0.4f, 1.0f};
    const double level = sidakLevel(falseAlarm, alphas.size() * cosines.size());
    for (const float alpha : alphas)
        for (const float cosine : cosines) {
            CAPTURE(alpha);
            CAPTURE(cosine);
            const Ggx ggx(alpha);
            const Vec3 wo = atCosine(cosine);
            const DirectionTest test = testDirections(
                gridForNormals(16, 24, alpha), 50000, 1,
                [&](RandomStream& random) {
                    return std::optional<Vec3>(ggx.sampleVisibleNormal(wo, random.next2()));
                },
                [&](Vec3 m) { return visibleNormalDensity(ggx, wo, m); });
            CHECK(test.drawsWhereZero == 0);
            CHECK(test.chiSquare.pValue > level);
        }
}

TEST_CASE("Ggx: the edges of the unit square give unit normals that face the viewer") {
    for (const float alpha : {smallestAlpha, 1e-4f, 0.1f, 1.0f})
        for (const float cosine : {1e-18f, 1e-7f, 1e-3f, 0.5f, 1.0f})
            for (const float u : {0.0f, 0x1p-32f, 0.25f, 0.5f, 0x1.fffffep-1f})
                for (const float v : {0.0f, 0x1p-32f, 0.5f, 0x1.fffffep-1f}) {
                    const Vec3 wo = atCosine(cosine);
                    const Vec3 m = Ggx(alpha).sampleVisibleNormal(wo, {u, v});
                    CHECK(length(m) == doctest::Approx(1.0).epsilon(4.0 * epsilon));
                    CHECK(m.z > 0.0f);
                    CHECK(double{dot(wo, m)} >= -4.0 * epsilon);
                }
}

TEST_CASE("Ggx: refraction obeys Snell's law and stays in the plane of incidence") {
    for (const float eta : {1.5f, 2.4f, 1.0f / 1.5f, 1.01f})
        for (const float cosine : {0.05f, 0.3f, 0.8f, 1.0f}) {
            const Vec3 m = normalize(Vec3{0.3f, -0.2f, 0.9f});
            const Vec3 wo = Frame::fromZ(m).worldFromLocal(atCosine(cosine));
            const float cosIncident = dot(wo, m);
            const auto fresnel = fresnelDielectric(cosIncident, eta);
            if (fresnel.cosTransmitted == 0.0f) continue;
            const Vec3 wi = refract(wo, m, eta, cosIncident, fresnel.cosTransmitted);
            const Vec3 sineO = cross(wo, m), sineI = cross(wi, m) * eta;
            CHECK(double{length(sineO + sineI)} <= 8.0 * epsilon * eta);
            CHECK(length(wi) == doctest::Approx(1.0).epsilon(8.0 * epsilon));
            CHECK(dot(wi, m) < 0.0f);
        }
}

TEST_CASE("Ggx: the microfacet between two directions is the one that scattered") {
    const Vec3 wo = atCosine(0.9f);
    for (const float tilt : {0.0f, 0.05f, 0.3f}) {
        const Vec3 m = normalize(Vec3{tilt, -0.5f * tilt, 1.0f});
        const auto mirror = reflectingMicrofacet(wo, reflect(wo, m));
        REQUIRE(mirror);
        CHECK(double{length(mirror->normal - m)} <= 8.0 * epsilon);
        for (const float eta : {1.5f, 1.0f / 1.5f, 2.4f}) {
            const auto fresnel = fresnelDielectric(dot(wo, m), eta);
            const auto facet = refractingMicrofacet(
                wo, refract(wo, m, eta, dot(wo, m), fresnel.cosTransmitted), eta);
            REQUIRE(facet);
            // wo + η wi has length of about |η − 1|.
            CHECK(double{length(facet->normal - m)} <= 16.0 * epsilon / std::abs(eta - 1.0f));
        }
    }
}

TEST_CASE("Ggx: no microfacet refracts light back to its own side or against Snell's law") {
    const Vec3 wo = atCosine(0.8f);
    CHECK_FALSE(refractingMicrofacet(wo, {-wo.x, -wo.y, wo.z}, 1.5f));
    // Into the denser medium light bends towards the normal: a horizontal exit is out of reach.
    CHECK_FALSE(refractingMicrofacet(atCosine(1.0f), atCosine(-0.01f), 1.5f));
    CHECK_FALSE(refractingMicrofacet(wo, -wo, 1.0f));
}

TEST_CASE("Ggx: solid angles of normals and of scattered directions are in the stated ratio") {
    // Finite differences of wi by m in double against wo·m dωm/dωi.
    const Vec3d wo = toDouble(atCosine(0.9f));
    const auto scattered = [&](Vec3d m, double eta) {
        const double cosine = dot(wo, m);
        if (eta == 1.0) return m * (2.0 * cosine) - wo;
        const double cosTransmitted = fresnelDielectric(cosine, eta).cosTransmitted;
        return m * (cosine / eta - cosTransmitted) - wo / eta;
    };
    for (const double eta : {1.0, 1.5, 2.4, 1.0 / 1.2})
        for (const Vec3d axis : {Vec3d{0, 0, 1}, Vec3d{0.2, 0.1, 1}, Vec3d{-0.1, 0.3, 1}}) {
            const Vec3d m = normalize(axis), u = normalize(cross(m, Vec3d{1, 0, 0}));
            const Vec3d v = cross(m, u);
            const double h = 1e-5;
            const auto difference = [&](Vec3d along) {
                return (scattered(normalize(m + along * h), eta) -
                        scattered(normalize(m - along * h), eta)) /
                       (2.0 * h);
            };
            const double solidAngleRatio = length(cross(difference(u), difference(v)));
            const Vec3 wi = toFloat(scattered(m, eta));
            const auto facet = eta == 1.0
                                   ? reflectingMicrofacet(toFloat(wo), wi)
                                   : refractingMicrofacet(toFloat(wo), wi, static_cast<float>(eta));
            REQUIRE(facet);
            // h² of the differences and the rounding of directions, amplified by 1 / |η − 1|.
            CHECK(double{facet->transfer} ==
                  doctest::Approx(dot(wo, m) / solidAngleRatio).epsilon(64.0 * epsilon));
        }
}

TEST_CASE("Ggx: at the smallest α a density survives the way through world space, below it not") {
    const auto meanDeviation = [](float alpha) {
        const Ggx ggx(alpha);
        double sum = 0.0;
        constexpr int count = 20000;
        for (std::uint32_t i = 0; i < count; ++i) {
            RandomStream random(3, i, 0, RandomDomain::test);
            const float height = 2.0f * random.next() - 1.0f, turn = 2.0f * pi * random.next();
            const float radius = std::sqrt(1.0f - height * height);
            const Frame frame =
                Frame::fromZ({radius * std::cos(turn), radius * std::sin(turn), height});
            const Vec3 wo = atCosine(0.1f + 0.9f * random.next());
            const Vec3 m = ggx.sampleVisibleNormal(wo, random.next2());
            const auto throughWorld = [&](Vec3 w) {
                return frame.localFromWorld(frame.worldFromLocal(w));
            };
            const auto seen = reflectingMicrofacet(throughWorld(wo), throughWorld(reflect(wo, m)));
            sum += std::abs(double{ggx.density(seen->normal)} / double{ggx.density(m)} - 1.0);
        }
        return sum / count;
    };
    MESSAGE("mean relative deviation: ", meanDeviation(smallestAlpha), " at the smallest α, ",
            meanDeviation(0.1f * smallestAlpha), " at a tenth of it");
    CHECK(meanDeviation(smallestAlpha) < 0.015);
    CHECK(meanDeviation(0.1f * smallestAlpha) > 0.05);
}

}  // namespace etendue
