#include "renderer/light_table.h"

#include <doctest/doctest.h>

#include "tests/renderer/light_fixtures.h"
#include "tests/support/estimate.h"

using namespace etendue;

namespace {

LightTable table(std::vector<NamedLight> named) {
    std::vector<std::unique_ptr<Light>> lights;
    for (auto& n : named) lights.push_back(std::move(n.light));
    return LightTable(std::move(lights));
}

LightTable pointLights(const std::vector<float>& intensities) {
    std::vector<NamedLight> lights;
    for (const float i : intensities) lights.push_back({"", makePointLight({}, Spectrum(i))});
    return table(std::move(lights));
}

/// What a receiver gets through one light chosen from the table.
double chosenIrradiance(const LightTable& lights, Vec3 receiver, Vec3 normal,
                        RandomStream& random) {
    const auto choice = lights.sample(random.next());
    const Vec2 u = random.next2();
    if (!choice) return 0.0;
    return irradianceOf(lights[choice->index].sample(receiver, u), normal) /
           double{choice->probability};
}

}  // namespace

TEST_CASE("LightTable: lights come up by their power, the remainder is uniform") {
    const LightTable lights = pointLights({1.0f, 0.0f, 5.0f, 0.25f, 0.0f});
    constexpr std::uint32_t count = 100'000;
    constexpr int bins = 8;
    std::vector<double> observed(5 * bins), expected;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto choice = lights.sample(RandomStream(1, i, 0, RandomDomain::test).next());
        REQUIRE(choice);
        REQUIRE(choice->probability == lights.probability(choice->index));
        REQUIRE(choice->remainder < 1.0f);
        const int bin = static_cast<int>(choice->remainder * bins);
        ++observed[static_cast<std::size_t>(choice->index * bins + bin)];
    }
    for (const double intensity : {1.0, 0.0, 5.0, 0.25, 0.0})
        expected.insert(expected.end(), bins, count * intensity / 6.25 / bins);
    const ChiSquareResult result = chiSquareTest(observed, expected);
    CHECK(result.countInEmptyCells == 0.0);
    CHECK(result.pValue > falseAlarmLevel);
    CHECK(lights.probability(1) == 0.0f);
    CHECK(lights.probability(2) == doctest::Approx(0.8));
}

TEST_CASE("LightTable: without power there is nothing to choose") {
    CHECK_FALSE(LightTable({}).sample(0.5f));
    CHECK(LightTable({}).size() == 0);
    const LightTable dark = pointLights({0.0f, 0.0f});
    CHECK_FALSE(dark.sample(0.0f));
    CHECK(dark.size() == 2);
    CHECK(dark.probability(0) == 0.0f);
}

TEST_CASE("LightTable: edge random numbers choose lights that have power") {
    const LightTable lights = pointLights({0.0f, 2.0f, 0.0f, 1.0f, 0.0f});
    for (const float u : {0.0f, 0x1p-32f, 0.6666666f, 1.0f - 0x1p-24f}) {
        const auto choice = lights.sample(u);
        REQUIRE(choice);
        CHECK(choice->probability > 0.0f);
        CHECK(choice->remainder >= 0.0f);
        CHECK(choice->remainder < 1.0f);
    }
}

TEST_CASE("LightTable: the lights at infinity are listed, and probabilities sum to one") {
    auto named = everyLight();
    std::vector<int> expected;
    for (std::size_t i = 0; i < named.size(); ++i)
        if (named[i].light->isInfinite()) expected.push_back(static_cast<int>(i));
    const LightTable lights = table(std::move(named));
    const auto infinite = lights.infiniteLights();
    CHECK(std::vector<int>(infinite.begin(), infinite.end()) == expected);
    CHECK(expected.size() == 5);
    double sum = 0.0;
    for (int i = 0; i < lights.size(); ++i) sum += lights.probability(i);
    CHECK(sum == doctest::Approx(1.0).epsilon(1e-6));
}

TEST_CASE("LightTable: power past the range of a float still leaves probabilities") {
    std::vector<NamedLight> lights;
    lights.push_back({"", makePointLight({}, Spectrum(1.0f))});
    lights.push_back({"", makeConstantLight(Spectrum(1e7f), {{}, 1e18f})});
    lights.push_back({"", makeDirectionalLight({0, 0, 1}, Spectrum(1e7f), {{}, 1e18f})});
    const LightTable both = table(std::move(lights));
    CHECK(both.probability(0) == doctest::Approx(0.5));
    CHECK(both.probability(1) == doctest::Approx(0.25));
    CHECK(both.probability(2) == doctest::Approx(0.25));
}

TEST_CASE("LightTable: the light of several lights is the sum of their light") {
    const Vec3 corner{-0.5f, 2.0f, -0.5f}, x{1, 0, 0}, z{0, 0, 1};
    const Vec3 cornerB{1.0f, 1.0f, 0.0f}, xB{0, 0.5f, 0.5f}, zB{0.2f, -0.1f, 0.8f};
    const Vec3 normal = normalize(Vec3{0.2f, 1.0f, 0.1f});
    const auto area = [](Vec3 origin, Vec3 a, Vec3 b, float radiance) {
        return NamedLight{"", makeAreaLight(rectangle(origin, a, b), Spectrum(radiance), true)};
    };
    const auto lambert = [&](Vec3 origin, Vec3 a, Vec3 b, double radiance) {
        return polygonIrradiance({origin, origin + a, origin + a + b, origin + b}, radiance, {},
                                 normal);
    };
    const double first = lambert(corner, x, z, 3.0), second = lambert(cornerB, xB, zB, 0.5);
    const double constant = std::numbers::pi * 0.25;

    std::vector<std::vector<NamedLight>> scenes(4);
    scenes[0].push_back(area(corner, x, z, 3.0f));
    scenes[1].push_back(area(cornerB, xB, zB, 0.5f));
    for (int i = 2; i < 4; ++i) {
        scenes[static_cast<std::size_t>(i)].push_back(area(corner, x, z, 3.0f));
        scenes[static_cast<std::size_t>(i)].push_back(area(cornerB, xB, zB, 0.5f));
    }
    scenes[3].push_back({"", makeConstantLight(Spectrum(0.25f), testBounds)});
    const double expected[] = {first, second, first + second, first + second + constant};
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        CAPTURE(i);
        const LightTable lights = table(std::move(scenes[i]));
        const Summary result = estimate(50'000, 2, [&](RandomStream& random) {
            return chosenIrradiance(lights, {}, normal, random);
        });
        // A dozen roundings of 2^-24 each.
        CHECK(meanPValue(result, expected[i], 1e-6) > sidakLevel(falseAlarmLevel, 4));
        CHECK(result.standardError < 0.01 * expected[i]);
    }
}
