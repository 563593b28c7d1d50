// Samples of every BSDF against its density.
#include <doctest/doctest.h>

#include <algorithm>

#include "renderer/ggx.h"
#include "tests/renderer/bsdf_cases.h"
#include "tests/support/chi_square_sphere.h"

namespace etendue {

namespace {

constexpr double falseAlarm = 1e-3;

/// Cosines of wo; the negative ones are tried on dielectrics alone. −0.72 reflects totally.
const std::vector<float> manyCosines{0.95f, 0.5f, 0.1f, -0.95f, -0.72f, -0.5f, -0.1f};
const std::vector<float> fewCosines{0.5f, -0.72f};

/// Wide lobes: rows and columns about the surface's normal. Narrow ones: about where a flat surface
/// reflects or refracts to, finer towards it.
std::vector<SphereGrid> gridsFor(const BsdfCase& c, Vec3 wo, int rows, int columns) {
    std::vector<SphereGrid> grids{{rows, columns, {}, 1.0}};
    if (c.roughness > 0.2f) return grids;
    grids.push_back({rows, columns, Frame::fromZ({-wo.x, -wo.y, wo.z}), 4.0});
    if (c.isDielectric()) {
        const float eta = c.indexAt(-wo) / c.indexAt(wo);
        const Vec3 horizontal = Vec3{wo.x, wo.y, 0.0f} * (-1.0f / eta);
        const float sineSquared = lengthSquared(horizontal);
        if (sineSquared < 1.0f)
            grids.push_back({rows, columns,
                             Frame::fromZ({horizontal.x, horizontal.y,
                                           -std::copysign(std::sqrt(1.0f - sineSquared), wo.z)}),
                             4.0});
    }
    return grids;
}

struct Job {
    const BsdfCase* bsdf;
    Vec3 wo;
    SphereGrid grid;
};

std::vector<Job> jobsFor(const std::vector<BsdfCase>& cases, const std::vector<float>& cosines,
                         int rows, int columns) {
    std::vector<Job> jobs;
    for (const BsdfCase& c : cases)
        for (const float cosine : cosines) {
            if (cosine < 0.0f && !c.isDielectric()) continue;
            const Vec3 wo = atCosine(cosine);
            for (const SphereGrid& grid : gridsFor(c, wo, rows, columns))
                jobs.push_back({&c, wo, grid});
        }
    return jobs;
}

void testAll(const std::vector<Job>& jobs, std::uint32_t count, Transport transport) {
    const double level = sidakLevel(falseAlarm, jobs.size());
    double smallest = 1.0;
    for (const Job& job : jobs) {
        const BsdfCase& c = *job.bsdf;
        double diracProbability = 0.0;
        if (c.roughness == 0.0f) {
            // The mirror lobe of smooth plastic answers to the lowest uLobe.
            const auto s = c.bsdf->sample(withTransport(transport), job.wo, 0.0f, {0.5f, 0.5f});
            diracProbability = s && s->isDirac ? double{s->pdfSolidAngle} : 0.0;
        }
        const DirectionTest test = testDirections(
            job.grid, count, 21,
            [&](RandomStream& random) -> std::optional<Vec3> {
                const auto sample = drawSample(c, transport, job.wo, random);
                if (!sample || sample->isDirac) return std::nullopt;
                return sample->wi;
            },
            [&](Vec3 wi) {
                return double{c.bsdf->evaluate(withTransport(transport), job.wo, wi).pdfSolidAngle};
            });
        CAPTURE(c.name);
        CAPTURE(job.wo.z);
        CAPTURE(job.grid.power);
        CHECK(test.integral + diracProbability < 1.0 + 1e-4);
        if (c.roughness == 0.0f)
            CHECK(test.integral + diracProbability == doctest::Approx(1.0).epsilon(1e-4));
        CHECK(test.drawsWhereZero == 0);
        CHECK(test.chiSquare.pValue > level);
        smallest = std::min(smallest, test.chiSquare.pValue);
    }
    MESSAGE(jobs.size(), " tests, smallest p ", smallest, ", level ", level);
}

/// Conductors, dielectrics and plastics at these roughnesses; of the smooth ones only plastic has a
/// continuous part.
std::vector<BsdfCase> casesAt(const std::vector<float>& roughnesses) {
    std::vector<BsdfCase> cases = whiteCases(roughnesses);
    std::erase_if(cases, [](const BsdfCase& c) { return c.bsdf->isDirac(); });
    return cases;
}

}  // namespace

TEST_CASE("Bsdf: sampled directions have the density that evaluate states") {
    const std::vector<BsdfCase> cases = casesAt({0.0f, 0.1f, 0.3f, 0.6f, 1.0f});
    testAll(jobsFor(cases, manyCosines, 12, 16), 15000, Transport::radiance);
}

TEST_CASE("Bsdf: coloured surfaces' samples have their density too") {
    const std::vector<BsdfCase> cases = coloredCases({0.4f});
    testAll(jobsFor(cases, fewCosines, 12, 16), 15000, Transport::importance);
}

TEST_CASE("Bsdf: a Dirac lobe is drawn as often as it says") {
    constexpr std::uint32_t count = 20000;
    std::vector<BsdfCase> cases = whiteCases({0.0f}, {1.5f, 1.0f / 1.5f});
    std::erase_if(cases, [](const BsdfCase& c) { return c.roughness != 0.0f; });
    const double level = sidakLevel(falseAlarm, 2 * cases.size() * manyCosines.size());
    for (const BsdfCase& c : cases)
        for (const float cosine : manyCosines) {
            const Vec3 wo = atCosine(cosine);
            double drawn[2] = {}, stated[2] = {};  // reflected, refracted
            for (std::uint32_t i = 0; i < count; ++i) {
                RandomStream random(22, i, 0, RandomDomain::test);
                const auto sample = drawSample(c, Transport::radiance, wo, random);
                if (!sample || !sample->isDirac) continue;
                const int lobe = sample->wi.z * wo.z > 0.0f ? 0 : 1;
                ++drawn[lobe];
                stated[lobe] = double{sample->pdfSolidAngle};
            }
            CAPTURE(c.name);
            CAPTURE(cosine);
            for (const int lobe : {0, 1}) {
                const double expected = stated[lobe] * count;
                const double variance = expected * (1.0 - stated[lobe]);
                const double distance = std::abs(drawn[lobe] - expected);
                CHECK((distance < 1e-3 || normalTwoSidedP(distance / std::sqrt(variance)) > level));
            }
        }
}

TEST_CASE("Bsdf: a million samples in small cells have their density" *
          doctest::test_suite("statistical")) {
    const std::vector<BsdfCase> cases = casesAt({0.0f, 0.1f, 0.3f, 0.6f, 1.0f});
    testAll(jobsFor(cases, manyCosines, 50, 101), 1000000, Transport::radiance);
    testAll(jobsFor(cases, fewCosines, 50, 101), 1000000, Transport::importance);
}

TEST_CASE("Bsdf: ten million samples in large cells have their density" *
          doctest::test_suite("statistical")) {
    const std::vector<BsdfCase> cases = casesAt({0.0f, 0.1f, 0.3f, 0.6f, 1.0f});
    testAll(jobsFor(cases, fewCosines, 16, 16), 10000000, Transport::radiance);
}

}  // namespace etendue
