#include "renderer/sobol.h"

#include <doctest/doctest.h>

#include <array>
#include <set>
#include <vector>

#include "renderer/estimator.h"
#include "renderer/random.h"
#include "statistics/statistics.h"
#include "tests/support/scenes.h"

using namespace etendue;

namespace {

RandomStream sobolStream(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample,
                         RandomDomain domain = RandomDomain::test) {
    return RandomStream(RandomStream(seed, pixel, sample, domain), pixel, sample);
}

}  // namespace

TEST_CASE("Sobol: the first points are the published ones") {
    // Joe and Kuo's new-joe-kuo-6: 0, 1/2, 1/4 and 3/4 of dimension 1, and so on, in the order of
    // their indices.
    const std::uint32_t expected[6][3] = {{0, 0, 0},
                                          {0x80000000u, 0x80000000u, 0x80000000u},
                                          {0x40000000u, 0xc0000000u, 0xc0000000u},
                                          {0xc0000000u, 0x40000000u, 0x40000000u},
                                          {0x20000000u, 0xa0000000u, 0x60000000u},
                                          {0xa0000000u, 0x20000000u, 0xe0000000u}};
    for (std::uint32_t i = 0; i < 6; ++i)
        for (std::uint32_t d = 0; d < 3; ++d) CHECK(sobolBits(i, d) == expected[i][d]);
    // An index of any size is the exclusive or of its powers of two.
    for (std::uint32_t d = 0; d < sobolDimensions; ++d)
        CHECK(sobolBits(0x81234567u, d) ==
              (sobolBits(0x80000000u, d) ^ sobolBits(0x01230000u, d) ^ sobolBits(0x4567u, d)));
}

TEST_CASE("Sobol: scrambled or not, one point lies in each interval of a plane") {
    constexpr std::uint32_t log2Count = 8, count = 1u << log2Count;
    for (const std::uint32_t seed : {1u, 0x9e3779b9u, ~0u}) {
        for (std::uint32_t xBits = 0; xBits <= log2Count; ++xBits) {
            std::set<std::uint32_t> cells;
            for (std::uint32_t i = 0; i < count; ++i) {
                const std::uint64_t x = owenScrambled(sobolBits(i, 0), seed),
                                    y = owenScrambled(sobolBits(i, 1), seed + 77);
                cells.insert(static_cast<std::uint32_t>((x << xBits >> 32 << (log2Count - xBits)) |
                                                        y << (log2Count - xBits) >> 32));
            }
            CHECK(cells.size() == count);
        }
    }
}

TEST_CASE("Random: each number of a Sobol' stream is uniform over the seeds") {
    // Of dimensions in the sequence and beyond it, of one sample, of pairs of them.
    constexpr int seeds = 40000;
    const std::uint32_t dimensions[] = {0, 1, 5, sobolDimensions - 1, sobolDimensions + 2};
    std::vector<std::vector<double>> observed(5, std::vector<double>(64));
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        RandomStream stream = sobolStream(seed, 3, 5);
        std::vector<float> numbers;
        for (std::uint32_t d = 0; d < sobolDimensions + 4; ++d) numbers.push_back(stream.next());
        for (std::size_t i = 0; i < 5; ++i) {
            const float x = numbers[dimensions[i]], y = numbers[dimensions[(i + 1) % 5]];
            ++observed[i][static_cast<std::size_t>(x * 8) * 8 + static_cast<std::size_t>(y * 8)];
        }
    }
    const std::vector<double> expected(64, seeds / 64.0);
    for (const auto& counts : observed)
        CHECK(chiSquareTest(counts, expected).pValue > sidakLevel(0.01, 5));
}

TEST_CASE("Random: a pixel's Sobol' numbers are stratified, those of two domains independent") {
    constexpr std::uint32_t count = 256;
    std::set<std::uint32_t> strata;
    std::vector<double> observed(64), expected(64, count * 64 / 64.0);
    for (std::uint32_t pixel = 0; pixel < 64; ++pixel)
        for (std::uint32_t sample = 0; sample < count; ++sample) {
            RandomStream a = sobolStream(1, pixel, sample),
                         b = sobolStream(1, pixel, sample, RandomDomain::wavelength);
            const float x = a.next(), y = b.next();
            if (pixel == 0) strata.insert(static_cast<std::uint32_t>(x * count));
            ++observed[static_cast<std::size_t>(x * 8) * 8 + static_cast<std::size_t>(y * 8)];
        }
    CHECK(strata.size() == count);
    // Both are stratified, so that cells are filled more evenly than at random; were the two bound
    // to each other, most would be empty or overfull.
    CHECK(chiSquareTest(observed, expected).pValue > 0.01);
}

TEST_CASE("Random: beyond the sequence's dimensions a stream goes on with independent numbers") {
    RandomStream a = sobolStream(1, 2, 3), b = sobolStream(1, 2, 4), c = sobolStream(1, 3, 3);
    for (std::uint32_t d = 0; d < sobolDimensions; ++d) {
        a.next();
        b.next();
        c.next();
    }
    const std::uint32_t bits = a.nextBits();
    CHECK(bits != b.nextBits());
    CHECK(bits != c.nextBits());
    CHECK(bits != a.nextBits());
}

TEST_CASE(
    "Random: more than 2³² light paths, of a pixel or of a frame, have numbers of their own") {
    const LoadedScene loaded = sceneFromText(ballScene, {"film.width=64", "film.height=64"});
    const Filter filter(FilterKind::box);
    const View view{*loaded.scene, *loaded.camera, filter};
    const auto firstNumbers = [&](Sampler sampler, std::uint32_t sample, int count) {
        RandomStream random = lightPathRandom(view, {1, 3, 5, sample, sampler}, 7, count);
        const Vec2 a = random.next2(), b = random.next2();
        return std::array{a.x, a.y, b.x, b.y};
    };
    constexpr int most = 1024;  // light paths of a sample
    for (const Sampler sampler : {Sampler::independent, Sampler::sobol})
        for (const std::uint32_t pathsOfPixel : {1u << 22, 1u << 31})  // 2³² and 2⁴¹
            CHECK(firstNumbers(sampler, 0, most) != firstNumbers(sampler, pathsOfPixel, most));
    // 64² paths a sample: the sequence's points come to an end, and another begins.
    constexpr std::uint32_t sequence = 1u << 20;
    CHECK(firstNumbers(Sampler::sobol, 0, 1) != firstNumbers(Sampler::sobol, sequence, 1));
    std::set<std::uint32_t> strata;
    for (std::uint32_t sample = 0; sample < 256; ++sample)
        for (int x = 0; x < 64; ++x)
            for (int y = 0; y < 64; ++y) {
                const SampleId id{1, x, y, sequence + sample, Sampler::sobol};
                strata.insert(lightPathRandom(view, id, 0, 1).nextBits() >> 12);
            }
    CHECK(strata.size() == 1u << 20);
}
