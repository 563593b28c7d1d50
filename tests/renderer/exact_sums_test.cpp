#include "renderer/exact_sums.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace etendue;

namespace {

/// Floats of either sign and of sizes from 2⁻²⁴ to 2¹⁶.
std::vector<float> terms(std::size_t count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> mantissa(1.0f, 2.0f);
    std::uniform_int_distribution<int> exponent(-24, 16);
    std::vector<float> result;
    for (std::size_t i = 0; i < count; ++i)
        result.push_back((random() % 2 ? 1.0f : -1.0f) *
                         std::ldexp(mantissa(random), exponent(random)));
    return result;
}

ExactSums sumOf(const std::vector<float>& values) {
    ExactSums sum;
    sum.resize(1);
    for (const float v : values) REQUIRE(sum.add(0, double{v}));
    return sum;
}

}  // namespace

TEST_CASE("ExactSums: the same bits in any order, where a double alone has others") {
    std::vector<float> values = terms(10'000);
    const ExactSums sum = sumOf(values);
    double plain = 0.0;
    for (const float v : values) plain += double{v};
    bool isPlainTheSame = true;
    std::mt19937 random(7);
    for (int i = 0; i < 20; ++i) {
        std::ranges::shuffle(values, random);
        CHECK(sumOf(values) == sum);
        double again = 0.0;
        for (const float v : values) again += double{v};
        isPlainTheSame = isPlainTheSame && again == plain;
    }
    CHECK_FALSE(isPlainTheSame);
}

TEST_CASE("ExactSums: the sum is the one of integers") {
    const std::vector<float> values = terms(10'000);
    __extension__ using Wide = __int128;  // of units of 2⁻⁴⁸, which all terms are whole numbers of
    Wide exact = 0;
    for (const float v : values) exact += static_cast<Wide>(std::ldexp(double{v}, 48));
    const ExactSums sum = sumOf(values);
    const auto high = static_cast<Wide>(std::ldexp(sum[0], 48));
    const auto rest = static_cast<Wide>(std::ldexp(double{sum.rests[0]}, 48));
    CHECK(high + rest == exact);
}

TEST_CASE("ExactSums: sums of parts are the sum of all") {
    const std::vector<float> values = terms(9'000);
    ExactSums merged;
    merged.resize(1);
    for (std::size_t i = 0; i < values.size(); i += 3'000) {
        const ExactSums part = sumOf({values.begin() + static_cast<std::ptrdiff_t>(i),
                                      values.begin() + static_cast<std::ptrdiff_t>(i + 3'000)});
        CHECK(merged.add(0, part.sums[0], part.rests[0]));
    }
    CHECK(merged == sumOf(values));
}

TEST_CASE("ExactSums: a term too small to be held is told") {
    ExactSums sum;
    sum.resize(1);
    CHECK(sum.add(0, 1.0));
    CHECK(sum.add(0, 0x1p-70));
    CHECK(sum.rests[0] == 0x1p-70f);
    CHECK(sum.add(0, -0x1p-70));
    CHECK(sum.rests[0] == 0.0f);
    CHECK(sum.add(0, double{0x1.000002p-54f}));
    CHECK_FALSE(sum.add(0, double{0x1.000002p-79f}));
    CHECK_FALSE(sum.add(0, double{0x1p-300}));
    CHECK(sum[0] == 1.0);
}
