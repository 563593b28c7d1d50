// The white furnace, one surface at a time: what is lossless scatters all light, what absorbs
// scatters less, and quadrature of evaluate() agrees with the mean weight of sample().
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "renderer/fresnel.h"
#include "statistics/statistics.h"
#include "tests/renderer/bsdf_cases.h"
#include "tests/support/chi_square_sphere.h"

namespace etendue {

namespace {

constexpr double falseAlarm = 1e-3;

/// What the mean may be off by apart from its standard error: 1e-5 of the energy integrals, 4e-5 of
/// the tables between their nodes (energy_compensation_test.cpp holds both), rounding.
constexpr double tableError = 5e-5;

/// Weights of `count` samples; in a furnace the radiance in a medium goes with n², and an empty
/// sample weighs nothing.
struct FurnaceResult {
    Summary summary;
    double largestWeight = 1.0;

    /// How likely a mean so far from `expected` is. What happens with a probability above
    /// log(1 / level) / count goes unseen with less than `level`; rarer things, such as the one
    /// sample in ten thousand that a nearly smooth surface loses, may be missing from both the mean
    /// and its standard error.
    double pValue(double expected, double systematicError, double level) const {
        const double count = static_cast<double>(summary.count);
        const double unseen = largestWeight * std::log(1.0 / level) / count;
        const double excess = std::abs(summary.mean - expected) - systematicError - unseen;
        if (excess <= 0.0) return 1.0;
        return summary.standardError > 0.0
                   ? studentTwoSidedP(excess / summary.standardError, count - 1.0)
                   : 0.0;
    }
};

FurnaceResult furnace(const BsdfCase& c, Transport transport, Vec3 wo, std::uint32_t count,
                      int lane = 0) {
    FurnaceResult result;
    std::vector<double> weights;
    for (std::uint32_t i = 0; i < count; ++i) {
        RandomStream random(31, i, 0, RandomDomain::test);
        const auto sample = drawSample(c, transport, wo, random);
        double weight = sample ? double{sample->weight[lane]} : 0.0;
        if (sample && transport == Transport::radiance)
            weight *= std::pow(double{c.indexAt(sample->wi)} / double{c.indexAt(wo)}, 2);
        weights.push_back(weight);
        result.largestWeight = std::max(result.largestWeight, weight);
    }
    result.summary = summarize(weights);
    return result;
}

std::vector<Vec3> directionsFor(const BsdfCase& c) {
    std::vector<Vec3> directions;
    for (const float cosine : {1.0f, 0.8f, 0.5f, 0.2f, 0.05f, 0.003f}) {
        directions.push_back(atCosine(cosine));
        if (c.isDielectric()) directions.push_back(atCosine(-cosine));
    }
    if (c.isDielectric()) directions.push_back(atCosine(-0.745356f));  // critical for 1.5
    return directions;
}

/// E[weight] = 1 for every case: t-tests, corrected for their number, and an interval for each mean
/// that must lie within `bound`, so that noise cannot pass for agreement.
void testFurnace(const std::vector<BsdfCase>& cases, std::uint32_t count, double bound) {
    struct Job {
        const BsdfCase* bsdf;
        Vec3 wo;
    };
    std::vector<Job> jobs;
    for (const BsdfCase& c : cases)
        for (const Vec3 wo : directionsFor(c)) jobs.push_back({&c, wo});
    const double level = sidakLevel(falseAlarm, jobs.size());
    double smallest = 1.0;
    for (const Job& job : jobs) {
        const Transport transport = job.wo.z > 0.3f ? Transport::radiance : Transport::importance;
        const FurnaceResult result = furnace(*job.bsdf, transport, job.wo, count);
        const Summary& summary = result.summary;
        const double p = result.pValue(1.0, tableError, level);
        smallest = std::min(smallest, p);
        CAPTURE(job.bsdf->name);
        CAPTURE(job.wo.z);
        CAPTURE(summary.mean);
        CAPTURE(summary.standardError);
        CHECK(p > level);
        CHECK(std::abs(summary.mean - 1.0) + 3.0 * summary.standardError < bound);
    }
    MESSAGE(jobs.size(), " furnaces, smallest p ", smallest, ", level ", level);
}

const std::vector<float> furnaceRoughnesses{0.0f, 0.01f, 0.03f, 0.1f, 0.3f, 0.6f, 1.0f};

}  // namespace

TEST_CASE("Bsdf: a lossless surface in a furnace cannot be seen") {
    // A weight's standard deviation is below 0.7: 6 % is more than six standard errors.
    testFurnace(whiteCases(furnaceRoughnesses, {1.5f, 2.4f}), 6000, 0.06);
}

TEST_CASE("Bsdf: a lossless surface in a furnace cannot be seen by many samples either" *
          doctest::test_suite("statistical")) {
    testFurnace(whiteCases(furnaceRoughnesses, {1.5f, 1.0f / 1.5f, 2.4f, 1.05f}), 200000, 0.01);
}

TEST_CASE("Bsdf: quadrature of evaluate says that lossless surfaces keep all light") {
    for (const BsdfCase& c : whiteCases({0.3f, 0.6f, 1.0f}, {1.5f, 1.0f / 2.4f}))
        for (const float cosine : {0.9f, 0.4f, -0.9f, -0.4f}) {
            if (cosine < 0.0f && !c.isDielectric()) continue;
            const Vec3 wo = atCosine(cosine);
            const double albedo = integrateSphere({16, 16, {}, 1.0}, [&](Vec3 wi) {
                const BsdfValue v = c.bsdf->evaluate(withTransport(Transport::importance), wo, wi);
                return double{v.f[0]} * std::abs(double{wi.z});
            });
            CAPTURE(c.name);
            CAPTURE(cosine);
            // The integrator's bound, 1e-7 per cell and 1e-5 of the value; it is only as good where
            // refracted light ends at the critical angle with a root's corner.
            CHECK(std::abs(albedo - 1.0) < tableError + 1.5e-4);
        }
}

TEST_CASE("Bsdf: quadrature of evaluate agrees with the mean weight of sample") {
    std::vector<BsdfCase> cases = coloredCases({0.3f, 0.8f});
    const double level = sidakLevel(falseAlarm, 3 * 4 * cases.size());
    for (const BsdfCase& c : cases)
        for (const float cosine : {0.9f, 0.3f, -0.9f, -0.3f})
            for (int lane = 0; lane < 3; ++lane) {
                const Vec3 wo = atCosine(cosine);
                const double albedo = integrateSphere({12, 12, {}, 1.0}, [&](Vec3 wi) {
                    const BsdfValue v =
                        c.bsdf->evaluate(withTransport(Transport::importance), wo, wi);
                    return double{v.f[lane]} * std::abs(double{wi.z});
                });
                CAPTURE(c.name);
                CAPTURE(cosine);
                CHECK(
                    furnace(c, Transport::importance, wo, 3000, lane).pValue(albedo, 2e-4, level) >
                    level);
            }
}

TEST_CASE("Bsdf: what absorbs never returns more than it got, in any lane") {
    const std::vector<BsdfCase> cases = coloredCases({0.0f, 0.03f, 0.3f, 1.0f});
    const double level = sidakLevel(falseAlarm, 3 * 6 * cases.size());
    for (const BsdfCase& c : cases)
        for (const float cosine : {1.0f, 0.6f, 0.1f, 0.01f, -0.6f, -0.1f})
            for (int lane = 0; lane < 3; ++lane) {
                const FurnaceResult result =
                    furnace(c, Transport::importance, atCosine(cosine), 1000, lane);
                CAPTURE(c.name);
                CAPTURE(cosine);
                CHECK((result.summary.mean < 1.0 || result.pValue(1.0, tableError, level) > level));
            }
}

TEST_CASE("Bsdf: metals keep their colour when rough: compensation saturates and never whitens") {
    // More bounces, more absorption: the albedo falls short of the smooth mirror's, lane by lane,
    // but by no more than the light that meets a second facet.
    const BsdfCase mirror{"gold", makeConductor(metalOptics("gold"), 0.0f), 0.0f};
    const BsdfCase rough{"gold", makeConductor(metalOptics("gold"), 0.7f), 0.7f};
    const Spectrum smoothAlbedo = mirror.bsdf->albedo({}), roughAlbedo = rough.bsdf->albedo({});
    CHECK(smoothAlbedo == roughAlbedo);
    const Vec3 wo = atCosine(0.8f);
    double reflected[3];
    for (int lane = 0; lane < 3; ++lane) {
        const double smooth = furnace(mirror, Transport::radiance, wo, 10, lane).summary.mean;
        const Summary summary = furnace(rough, Transport::radiance, wo, 20000, lane).summary;
        CHECK(summary.mean < smooth + 5.0 * summary.standardError);
        CHECK(summary.mean > smooth * smooth - 5.0 * summary.standardError);
        reflected[lane] = summary.mean;
    }
    CHECK(reflected[0] > reflected[1]);
    CHECK(reflected[1] > reflected[2]);
}

TEST_CASE("Bsdf: plastic on a black base reflects what its coat does") {
    const BsdfCase c{"black plastic", makePlastic(Texture(Spectrum(0.0f)), 1.5f, 0.0f), 0.0f};
    for (const float cosine : {1.0f, 0.5f, 0.1f}) {
        const double mean = furnace(c, Transport::radiance, atCosine(cosine), 100).summary.mean;
        CHECK(mean ==
              doctest::Approx(fresnelDielectric(double{cosine}, 1.5).reflectance).epsilon(1e-5));
    }
}

TEST_CASE("Bsdf: light under plastic's coat bounces until it leaves, coloured each time") {
    const float rho = 0.6f;
    const BsdfCase c{"plastic", makePlastic(Texture(Spectrum(rho)), 1.5f, 0.0f), 0.0f};
    // A diffuse base and a smooth coat: each bounce sends the share 1 − Fi out, Fi being the mean
    // reflectance seen from inside.
    const double inside = fresnelDielectricAverage(1.0 / 1.5);
    double base = 0.0, under = 1.0;
    for (int bounce = 0; bounce < 200; ++bounce) {
        under *= double{rho};
        base += under * (1.0 - inside);
        under *= inside;
    }
    for (const float cosine : {1.0f, 0.5f, 0.1f}) {
        const double coat = fresnelDielectric(double{cosine}, 1.5).reflectance;
        const FurnaceResult result = furnace(c, Transport::radiance, atCosine(cosine), 20000);
        CHECK(result.pValue(coat + (1.0 - coat) * base, 1e-5, falseAlarm / 3.0) > falseAlarm / 3.0);
    }
}

TEST_CASE("Bsdf: the albedo image's value is the mean reflectance") {
    // Light from everywhere, cosine-weighted: the mean of the weights. "Roughly" is a few per cent.
    std::vector<BsdfCase> cases = coloredCases({0.0f, 0.2f});
    for (const BsdfCase& c : cases)
        for (int lane = 0; lane < 3; ++lane) {
            double sum = 0.0;
            constexpr std::uint32_t count = 4000;
            for (std::uint32_t i = 0; i < count; ++i) {
                RandomStream random(41, i, 0, RandomDomain::test);
                const Vec3 wo = sampleCosineHemisphere(random.next2());
                const auto sample = drawSample(c, Transport::importance, wo, random);
                if (sample) sum += double{sample->weight[lane]} / count;
            }
            CAPTURE(c.name);
            CHECK(std::abs(sum - double{c.bsdf->albedo(
                                     withTransport(Transport::importance))[lane]}) < 0.03);
        }
}

}  // namespace etendue
