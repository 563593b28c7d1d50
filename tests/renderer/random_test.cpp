#include "renderer/random.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "statistics/statistics.h"

using namespace etendue;

TEST_CASE("Random: Philox gives the published test vectors") {
    // Salmon et al. 2011, the known answers of the authors' own kat_vectors for philox4x32.
    CHECK(philox<7>({0, 0, 0, 0}, 0, 0) ==
          PhiloxBlock{0x5f6fb709, 0x0d893f64, 0x4f121f81, 0x4f730a48});
    CHECK(philox<10>({0, 0, 0, 0}, 0, 0) ==
          PhiloxBlock{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
    CHECK(philox<10>({~0u, ~0u, ~0u, ~0u}, ~0u, ~0u) ==
          PhiloxBlock{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
    CHECK(philox<10>({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0xa4093822, 0x299f31d0) ==
          PhiloxBlock{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("Random: no number reaches 1") {
    CHECK(uniformFloat(0) == 0.0f);
    CHECK(uniformFloat(1) == 0x1p-32f);
    CHECK(uniformFloat(~0u) < 1.0f);
}

TEST_CASE(
    "Random: a number depends on seed, stream, sample, dimension and domain, each by itself") {
    const auto first = [](RandomStream s) { return s.nextBits(); };
    const std::uint32_t base = first({1, 2, 3});
    CHECK(first({1, 2, 3}) == base);
    CHECK(first({2, 2, 3}) != base);
    CHECK(first({1ull << 32 | 1, 2, 3}) != base);
    CHECK(first({1, 3, 3}) != base);
    CHECK(first({1, 2, 4}) != base);
    CHECK(first({1, 2, 3, RandomDomain::lightPath}) != base);
    RandomStream s(1, 2, 3);
    CHECK(s.nextBits() != s.nextBits());
}

TEST_CASE("Random: neighbouring pixels, samples and dimensions are uniform together") {
    // Pairs of numbers that lie next to each other in each of the three directions, on an 8 × 8
    // grid.
    constexpr int pairs = 64 * 1000;
    for (int direction = 0; direction < 3; ++direction) {
        std::vector<double> observed(64), expected(64, pairs / 64.0);
        for (std::uint32_t i = 0; i < pairs; ++i) {
            RandomStream a(5, 2 * i, 0),
                b(5, direction == 0 ? 2 * i + 1 : 2 * i, direction == 1 ? 1 : 0);
            const float x = a.next();
            const float y = direction == 2 ? a.next() : b.next();
            ++observed[static_cast<std::size_t>(x * 8) * 8 + static_cast<std::size_t>(y * 8)];
        }
        CAPTURE(direction);
        CHECK(chiSquareTest(observed, expected).pValue > sidakLevel(0.01, 3));
    }
}
