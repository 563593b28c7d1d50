// What every BSDF promises whatever it looks like: that its functions agree with one another, with
// the walk reversed, and with any input.
#include "renderer/bsdf.h"

#include <doctest/doctest.h>

#include <initializer_list>
#include <limits>

#include "tests/renderer/bsdf_cases.h"

namespace etendue {

namespace {

constexpr float epsilon = std::numeric_limits<float>::epsilon();

const std::vector<BsdfCase>& whiteSurfaces() {
    static const std::vector<BsdfCase> cases =
        whiteCases({0.0f, 0.01f, 0.1f, 0.3f, 0.6f, 1.0f}, {1.5f, 2.4f, 1.0f / 1.5f});
    return cases;
}

const std::vector<BsdfCase>& coloredSurfaces() {
    static const std::vector<BsdfCase> cases = coloredCases({0.0f, 0.3f, 1.0f});
    return cases;
}

/// A refracted direction is divided by the index: its rounding grows where that is small.
bool isUnit(const BsdfCase& c, Vec3 w) {
    const float index = std::min(c.ior, 1.0f / c.ior);
    return std::abs(lengthSquared(w) - 1.0f) < 16.0f * epsilon / square(index);
}

/// Relative difference that rounding explains between f(wo, wi) and f(wi, wo). The half vector h =
/// wo + η wi is rounded by an epsilon, so its direction by epsilon / |h|: D's slope by it is at
/// most 4 on the scale α, and the cosines to it, which f is proportional to, change by as much.
/// Some thirty other roundings.
float swapTolerance(const BsdfCase& c, Vec3 wo, Vec3 wi) {
    if (c.roughness == 0.0f || c.name == "diffuse") return 32.0f * epsilon;
    const Vec3 h = wo + wi * (wo.z * wi.z > 0.0f ? 1.0f : c.indexAt(wi) / c.indexAt(wo));
    const float smallestCosine = std::min(absDot(wo, h), absDot(wi, h)) / length(h);
    return epsilon *
           (32.0f + 8.0f / length(h) * (1.0f / square(c.roughness) + 1.0f / smallestCosine));
}

bool isClose(float a, float b, float tolerance) {
    return std::abs(a - b) <= tolerance * std::max(std::abs(a), std::abs(b));
}

}  // namespace

TEST_CASE("Bsdf: sample says of its direction what evaluate says") {
    for (const BsdfCase& c : whiteSurfaces())
        for (const Transport transport : {Transport::radiance, Transport::importance})
            for (std::uint32_t i = 0; i < 300; ++i) {
                RandomStream random(11, i, 0, RandomDomain::test);
                const Vec3 wo = sampleUnitSphere(random.next2());
                const auto sample = drawSample(c, transport, wo, random);
                if (!sample) continue;
                CAPTURE(c.name);
                CHECK(isUnit(c, sample->wi));
                CHECK(sample->pdfSolidAngle > 0.0f);
                const BsdfValue value = c.bsdf->evaluate(withTransport(transport), wo, sample->wi);
                if (sample->isDirac) {
                    CHECK(sample->pdfSolidAngle <= 1.0f);
                    continue;
                }
                CHECK(sample->pdfSolidAngle == value.pdfSolidAngle);
                CHECK(sample->pdfSolidAngleReverse == value.pdfSolidAngleReverse);
                for (int lane = 0; lane < Spectrum::lanes; ++lane)
                    CHECK(isClose(sample->weight[lane] * sample->pdfSolidAngle,
                                  value.f[lane] * std::abs(sample->wi.z), 4.0f * epsilon));
            }
}

TEST_CASE("Bsdf: the reverse density is the density of the walk reversed") {
    for (const BsdfCase& c : whiteSurfaces())
        for (std::uint32_t i = 0; i < 300; ++i) {
            RandomStream random(12, i, 0, RandomDomain::test);
            const auto [wo, wi] = drawPair(c, random);
            const BsdfValue there = c.bsdf->evaluate(withTransport(Transport::radiance), wo, wi);
            const BsdfValue back = c.bsdf->evaluate(withTransport(Transport::importance), wi, wo);
            CAPTURE(c.name);
            const float tolerance = swapTolerance(c, wo, wi);
            CHECK(isClose(there.pdfSolidAngleReverse, back.pdfSolidAngle, tolerance));
            CHECK(isClose(there.pdfSolidAngle, back.pdfSolidAngleReverse, tolerance));
        }
}

TEST_CASE("Bsdf: the reverse probability of a Dirac lobe is that of the walk reversed") {
    for (const BsdfCase& c : whiteSurfaces())
        for (std::uint32_t i = 0; i < 500 && c.roughness == 0.0f; ++i) {
            RandomStream random(13, i, 0, RandomDomain::test);
            const Vec3 wo = sampleUnitSphere(random.next2());
            const auto there = drawSample(c, Transport::radiance, wo, random);
            if (!there || !there->isDirac) continue;
            // Try lobes until the walk back finds where it came from.
            bool isFound = false;
            for (const float uLobe : {0.0f, 0x1.fffffep-1f}) {
                const auto back = c.bsdf->sample(withTransport(Transport::importance), there->wi,
                                                 uLobe, {0.5f, 0.5f});
                if (!back || !back->isDirac || length(back->wi - wo) > 1e-4f) continue;
                isFound = true;
                CAPTURE(c.name);
                // Fresnel's slope by the rounded cosine is steep at grazing and near the critical
                // angle: a root, so that an epsilon counts as its own root.
                CHECK(std::abs(there->pdfSolidAngleReverse - back->pdfSolidAngle) <
                      4.0f * std::sqrt(epsilon));
                CHECK(std::abs(there->pdfSolidAngle - back->pdfSolidAngleReverse) <
                      4.0f * std::sqrt(epsilon));
            }
            CHECK((isFound || there->pdfSolidAngle < 0.001f || std::abs(there->wi.z) < 0.01f));
        }
}

TEST_CASE("Bsdf: scattering is reciprocal, up to the squared index of where the light is") {
    const auto check = [](const BsdfCase& c) {
        for (std::uint32_t i = 0; i < 300; ++i) {
            RandomStream random(14, i, 0, RandomDomain::test);
            const auto [wo, wi] = drawPair(c, random);
            const auto f = [&](Transport transport, Vec3 from, Vec3 to) {
                return c.bsdf->evaluate(withTransport(transport), from, to).f;
            };
            const Spectrum there = f(Transport::radiance, wo, wi) * square(c.indexAt(wi));
            const Spectrum back = f(Transport::radiance, wi, wo) * square(c.indexAt(wo));
            const Spectrum adjoint = f(Transport::importance, wi, wo) * square(c.indexAt(wi));
            CAPTURE(c.name);
            const float tolerance = swapTolerance(c, wo, wi);
            for (int lane = 0; lane < Spectrum::lanes; ++lane) {
                CHECK(isClose(there[lane], back[lane], tolerance));
                CHECK(isClose(there[lane], adjoint[lane], tolerance));
            }
        }
    };
    for (const BsdfCase& c : whiteSurfaces()) check(c);
    for (const BsdfCase& c : coloredSurfaces()) check(c);
}

TEST_CASE("Bsdf: the kind of transport changes refracted values and nothing else") {
    for (const BsdfCase& c : whiteSurfaces())
        for (std::uint32_t i = 0; i < 200; ++i) {
            RandomStream random(15, i, 0, RandomDomain::test);
            const Vec3 wo = sampleUnitSphere(random.next2());
            RandomStream again = random;
            const auto radiance = drawSample(c, Transport::radiance, wo, random);
            const auto importance = drawSample(c, Transport::importance, wo, again);
            CHECK(radiance.has_value() == importance.has_value());
            if (!radiance || !importance) continue;
            CHECK(radiance->wi == importance->wi);
            CHECK(radiance->pdfSolidAngle == importance->pdfSolidAngle);
            CHECK(radiance->pdfSolidAngleReverse == importance->pdfSolidAngleReverse);
            const float etaSquared = square(c.indexAt(radiance->wi) / c.indexAt(wo));
            CHECK(isClose(radiance->weight[0] * etaSquared, importance->weight[0], 8.0f * epsilon));
        }
}

TEST_CASE("Bsdf: opaque surfaces scatter alike on both sides, and never through") {
    for (const BsdfCase& c : coloredSurfaces()) {
        if (c.isDielectric()) continue;
        for (std::uint32_t i = 0; i < 200; ++i) {
            RandomStream random(16, i, 0, RandomDomain::test);
            const auto [wo, wi] = drawPair(c, random);
            const BsdfContext context = withTransport(Transport::radiance);
            const BsdfValue front = c.bsdf->evaluate(context, wo, wi);
            const BsdfValue back = c.bsdf->evaluate(context, flipped(wo), flipped(wi));
            CHECK(front.f == back.f);
            CHECK(front.pdfSolidAngle == back.pdfSolidAngle);
            CHECK(front.pdfSolidAngleReverse == back.pdfSolidAngleReverse);
            if (wo.z * wi.z < 0.0f) CHECK(isBlack(front.f));
            RandomStream again = random;
            const auto sample = drawSample(c, Transport::radiance, wo, random);
            const auto mirrored = drawSample(c, Transport::radiance, flipped(wo), again);
            REQUIRE(sample.has_value() == mirrored.has_value());
            if (!sample) continue;
            CHECK(sample->wi == flipped(mirrored->wi));
            CHECK(sample->wi.z * wo.z > 0.0f);
        }
    }
}

TEST_CASE("Bsdf: any numbers and any direction give a finite sample or none") {
    std::vector<BsdfCase> cases = whiteCases({0.0f, 0.0032f, 0.0033f, 0.01f, 0.1f, 1.0f},
                                             {1.5f, 1.0f, 1.000001f, 1.00002f, 1.01f, 0.1f, 10.0f});
    for (BsdfCase& c : coloredCases({0.0f, 0.3f})) cases.push_back(std::move(c));
    cases.push_back({"plastic of index 1", makePlastic(Texture(Spectrum(0.0f)), 1.0f, 0.3f)});
    cases.push_back(
        {"smooth plastic of index 1", makePlastic(Texture(Spectrum(0.0f)), 1.0f, 0.0f)});
    cases.push_back({"thin plastic", makePlastic(Texture(Spectrum(1.0f)), 0.5f, 0.9f)});
    const std::initializer_list<float> numbers{0.0f, 0x1p-32f, 0.5f, 0x1.fffffep-1f};
    for (const BsdfCase& c : cases)
        for (const float cosine : {1.0f, 0.7453560f, 0.5f, 1e-3f, 1e-7f, 1e-17f, 1e-30f, 0.0f})
            for (const float sign : {1.0f, -1.0f})
                for (const float uLobe : numbers)
                    for (const float u : numbers)
                        for (const float v : numbers) {
                            const Vec3 wo = atCosine(sign * cosine);
                            const auto s = c.bsdf->sample(withTransport(Transport::radiance), wo,
                                                          uLobe, {u, v});
                            if (!s) continue;
                            CAPTURE(c.name);
                            CAPTURE(wo.z);
                            CHECK(isUnit(c, s->wi));
                            CHECK(isFinite(s->weight));
                            CHECK(s->weight[0] >= 0.0f);
                            CHECK(s->pdfSolidAngle > 0.0f);
                            CHECK(std::isfinite(s->pdfSolidAngle));
                            CHECK(s->pdfSolidAngleReverse >= 0.0f);
                            CHECK(std::isfinite(s->pdfSolidAngleReverse));
                        }
}

TEST_CASE("Bsdf: any pair of directions has a finite value, zero in the plane of the surface") {
    const std::vector<float> cosines{1.0f, 0.7f, 1e-4f, 1e-9f, 2e-18f, 1e-19f, 1e-40f, 0.0f};
    for (const BsdfCase& c : whiteCases({0.0f, 0.0033f, 0.1f, 1.0f}, {1.5f, 1.01f, 0.5f}))
        for (const float cosO : cosines)
            for (const float cosI : cosines)
                for (const int signs : {0, 1, 2, 3})
                    for (const bool isOpposite : {false, true}) {
                        const Vec3 wo = atCosine(signs & 1 ? -cosO : cosO);
                        Vec3 wi = atCosine(signs & 2 ? -cosI : cosI);
                        if (isOpposite) wi = {-wi.x, -wi.y, wi.z};
                        const BsdfValue value =
                            c.bsdf->evaluate(withTransport(Transport::importance), wo, wi);
                        CAPTURE(c.name);
                        CHECK(isFinite(value.f));
                        CHECK(std::isfinite(value.pdfSolidAngle));
                        CHECK(std::isfinite(value.pdfSolidAngleReverse));
                        CHECK(value.f[0] >= 0.0f);
                        if (std::min(cosO, cosI) < 1e-18f) CHECK(isBlack(value.f));
                    }
}

TEST_CASE("Bsdf: a dielectric of index 1 lets light go straight on, however rough") {
    for (const float roughness : {0.0f, 0.5f, 1.0f}) {
        const BsdfCase c{"nothing", makeDielectric(1.0f, Spectrum(1.0f), roughness)};
        CHECK(c.bsdf->isDirac());
        for (std::uint32_t i = 0; i < 100; ++i) {
            RandomStream random(17, i, 0, RandomDomain::test);
            const Vec3 wo = sampleUnitSphere(random.next2());
            const auto sample = drawSample(c, Transport::radiance, wo, random);
            REQUIRE(sample);
            CHECK(sample->wi == -wo);
            CHECK(sample->weight == Spectrum(1.0f));
            CHECK(sample->pdfSolidAngle == 1.0f);
        }
    }
}

TEST_CASE("Bsdf: only surfaces without a continuous part say that they are Dirac") {
    const Spectrum white(1.0f);
    CHECK(makeConductor(white, 0.0f)->isDirac());
    CHECK(makeDielectric(1.5f, white, 0.0f)->isDirac());
    CHECK_FALSE(makeDiffuse(Texture(white))->isDirac());
    CHECK_FALSE(makePlastic(Texture(white), 1.5f, 0.0f)->isDirac());
    CHECK_FALSE(makeConductor(white, 0.01f)->isDirac());
    CHECK_FALSE(makeDielectric(1.5f, white, 0.01f)->isDirac());
}

}  // namespace etendue
