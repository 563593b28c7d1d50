#include "renderer/mis.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "renderer/random.h"

using namespace etendue;

namespace {

/// Log-uniform over many orders of magnitude, now and then zero.
float anyDensity(RandomStream& random) {
    if (random.next() < 0.1f) return 0.0f;
    return std::pow(10.0f, 24.0f * random.next() - 12.0f);
}

std::vector<VertexDensity> anyPath(int edges, RandomStream& random) {
    std::vector<VertexDensity> path;
    for (int i = 0; i <= edges; ++i)
        path.push_back({anyDensity(random), anyDensity(random), random.next() < 0.8f});
    return path;
}

/// Every technique's density as the product over all vertices, in long double: the definition.
std::vector<long double> absoluteDensities(const std::vector<VertexDensity>& path,
                                           const SampleCounts& counts) {
    const int edges = static_cast<int>(path.size()) - 1;
    std::vector<long double> result;
    for (int t = 1; t <= edges + 1; ++t) {
        const auto ut = static_cast<std::size_t>(t);
        const Technique technique{edges + 1 - t, t};
        long double product = counts(technique);
        if (technique.s > 0 && !(path[ut - 1].isConnectable && path[ut].isConnectable))
            product = 0.0L;
        for (std::size_t i = 1; i < path.size(); ++i)
            product *= i < ut ? path[i].fromCamera : path[i].fromLight;
        result.push_back(product);
    }
    return result;
}

}  // namespace

TEST_CASE("MIS: weights match the product of all densities, and those of all techniques sum to 1") {
    for (const char* list : {"", "t1", "s0,s1", "s2t2,s1t3,s0t4,t1"}) {
        const TechniqueSet techniques = *list ? *TechniqueSet::parse(list) : TechniqueSet();
        const SampleCounts counts{techniques, 1000.0};
        int checked = 0;
        for (std::uint32_t i = 0; i < 20000; ++i) {
            RandomStream random(1, i, 0, RandomDomain::test);
            const int edges = 1 + static_cast<int>(8.0f * random.next());
            const std::vector<VertexDensity> path = anyPath(edges, random);
            const std::vector<long double> densities = absoluteDensities(path, counts);
            long double total = 0.0L, sum = 0.0L;
            for (const long double d : densities) total += d;
            if (total == 0.0L) continue;
            ++checked;
            for (int t = 1; t <= edges + 1; ++t) {
                const long double own = densities[static_cast<std::size_t>(t - 1)];
                if (own == 0.0L) continue;  // never drawn
                const float weight = balanceWeight(path, {edges + 1 - t, t}, counts).value();
                sum += static_cast<long double>(weight);
                CHECK(weight == doctest::Approx(static_cast<double>(own / total)).epsilon(1e-5));
            }
            CHECK(std::abs(static_cast<double>(sum) - 1.0) < 1e-5);
        }
        CHECK(checked > 500);
    }
}

TEST_CASE("MIS: a technique of infinite density takes the whole weight") {
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<VertexDensity> path = {{0, 0, true}, {infinity, 2, true}, {3, 5, true}};
    const TechniqueSet all;
    const SampleCounts counts{all};
    CHECK(balanceWeight(path, {2, 1}, counts).value() == 0.0f);
    const float sum =
        balanceWeight(path, {1, 2}, counts).value() + balanceWeight(path, {0, 3}, counts).value();
    CHECK(sum == doctest::Approx(1.0));
}

TEST_CASE("TechniqueSet: names are read, and what is none is refused") {
    const auto set = TechniqueSet::parse("s2t1,s0,t3");
    REQUIRE(set);
    CHECK(set->contains({2, 1}));
    CHECK_FALSE(set->contains({1, 1}));
    CHECK(set->contains({0, 7}));
    CHECK(set->contains({5, 3}));
    CHECK_FALSE(set->contains({1, 2}));
    CHECK(set->needsCameraWalk(4));
    CHECK(set->needsLightWalk(4));
    CHECK_FALSE(TechniqueSet::parse("s0,s1t2")->needsLightWalk(4));
    CHECK_FALSE(TechniqueSet::lightTracing().needsCameraWalk(4));
    for (const char* wrong :
         {"", ",", "s", "t0", "s0t1", "s-1t3", "s1t1,", "x1", "s1t1 ", "t1s1", "s99999999999t1"})
        CHECK_FALSE(TechniqueSet::parse(wrong));
}

TEST_CASE("TechniqueSet: its names know their shortest paths, however long") {
    const auto edgesOfOnly = [](const char* text) {
        const std::vector<TechniqueName> names = TechniqueSet::parse(text)->names();
        REQUIRE(names.size() == 1);
        CHECK(names[0].text == text);
        return names[0].fewestEdges;
    };
    CHECK(edgesOfOnly("s2t1") == 2);
    CHECK(edgesOfOnly("s0") == 1);
    CHECK(edgesOfOnly("s7") == 7);
    CHECK(edgesOfOnly("t1") == 1);
    CHECK(edgesOfOnly("t7") == 6);
    REQUIRE(TechniqueSet::parse("s2147483647t2147483647"));
    CHECK(edgesOfOnly("s2147483647t2147483647") == 4294967293);
    CHECK(TechniqueSet().names().empty());
}
