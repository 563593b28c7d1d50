#include "renderer/exact_color.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace etendue;

namespace {

struct Color {
    float x, y, z;
};

/// Of sizes from 2⁻²⁴ to 2¹⁶, some of them zero.
std::vector<Color> terms(std::size_t count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> mantissa(1.0f, 2.0f);
    std::uniform_int_distribution<int> exponent(-24, 16);
    const auto next = [&] {
        return random() % 8 == 0 ? 0.0f : std::ldexp(mantissa(random), exponent(random));
    };
    std::vector<Color> result;
    for (std::size_t i = 0; i < count; ++i) result.push_back({next(), next(), next()});
    return result;
}

ExactColor sumOf(const std::vector<Color>& values) {
    ExactColor sum;
    for (const Color& c : values) REQUIRE(sum.add(c.x, c.y, c.z));
    return sum;
}

ExactColor colorOf(float x, float y, float z) { return sumOf({{x, y, z}}); }

}  // namespace

TEST_CASE("ExactColor: the same bits in any order, where doubles have others") {
    std::vector<Color> values = terms(10'000);
    const ExactColor sum = sumOf(values);
    const auto plainSum = [&] {
        double plain = 0.0;
        for (const Color& c : values) plain += double{c.y};
        return plain;
    };
    const double plain = plainSum();
    bool isPlainTheSame = true;
    std::mt19937 random(7);
    for (int i = 0; i < 20; ++i) {
        std::ranges::shuffle(values, random);
        CHECK(sumOf(values) == sum);
        isPlainTheSame = isPlainTheSame && plainSum() == plain;
    }
    CHECK_FALSE(isPlainTheSame);
}

TEST_CASE("ExactColor: the sums are those of integers") {
    const std::vector<Color> values = terms(10'000);
    __extension__ using Wide = __int128;  // of units of 2⁻⁴⁸, which all terms are whole numbers of
    Wide x = 0, y = 0, z = 0;
    for (const Color& c : values) {
        x += static_cast<Wide>(std::ldexp(double{c.x}, 48));
        y += static_cast<Wide>(std::ldexp(double{c.y}, 48));
        z += static_cast<Wide>(std::ldexp(double{c.z}, 48));
    }
    const Vec3d sum = sumOf(values).value();
    CHECK(sum.x == std::ldexp(static_cast<double>(x), -48));
    CHECK(sum.y == std::ldexp(static_cast<double>(y), -48));
    CHECK(sum.z == std::ldexp(static_cast<double>(z), -48));
}

TEST_CASE("ExactColor: sums of parts are the sum of all") {
    const std::vector<Color> values = terms(9'000);
    ExactColor merged;
    for (const std::ptrdiff_t i : {3'000, 0, 6'000})
        CHECK(merged.add(sumOf({values.begin() + i, values.begin() + i + 3'000})));
    CHECK(merged == sumOf(values));
}

TEST_CASE("ExactColor: a term too small to be held is told") {
    ExactColor sum = colorOf(1.0f, 0.0f, 0.5f);
    CHECK(sum.add(0.0f, 0x1p-76f, 0.0f));  // the last of 77 bits
    CHECK(sum.value().y == 0x1p-76);
    CHECK(sum.add(0.0f, 0x1.000002p-53f, 0.0f));
    CHECK_FALSE(sum.add(0.0f, 0x1.000002p-54f, 0.0f));
    CHECK_FALSE(sum.add(0x1p-100f, 0.0f, 0.0f));
    CHECK_FALSE(sum.add(colorOf(0x1p-77f, 0.0f, 0.0f)));
    CHECK(sum.value().x == 1.0);
    SUBCASE("as is the last bit of a sum, when the unit doubles") {
        CHECK(sum.add(0.0f, 0x1p-76f, 0.0f));
        SUBCASE("for a term") { CHECK_FALSE(sum.add(0.0f, 0.0f, 2.0f)); }
        SUBCASE("for a sum") { CHECK_FALSE(sum.add(1.0f, 0.0f, 0.0f)); }
        SUBCASE("for the sum of two") { CHECK_FALSE(sum.add(colorOf(1.0f, 0.0f, 0.0f))); }
        CHECK(sum.add(1.0f, 0.0f, 0.0f));
    }
    SUBCASE("all of it, too") {
        CHECK_FALSE(sum.add(0.0f, 0.0f, 0x1p127f));
        CHECK(sum.value().x == 0.0);
        CHECK(sum.value().z == 0x1p127);
    }
}

TEST_CASE("ExactColor: zeros of either sign and the least and the largest floats add up") {
    constexpr float least = std::numeric_limits<float>::denorm_min(),
                    most = std::numeric_limits<float>::max();
    ExactColor sum;
    CHECK(sum.add(0.0f, -0.0f, least));
    CHECK(sum.value().x == 0.0);
    CHECK(sum.value().y == 0.0);
    CHECK(sum.value().z == double{least});
    ExactColor large;
    for (int i = 0; i < 1000; ++i) CHECK(large.add(most, most, 0.0f));
    CHECK(large.value().x == 1000.0 * most);
    CHECK(large.isPossible());
    for (int i = 0; i < 54; ++i) CHECK(large.add(ExactColor(large)));
    CHECK(large.value().y == std::ldexp(1000.0 * most, 54));
    CHECK(large.isPossible());  // fewer than 2⁶⁴ floats
    for (int i = 0; i < 2; ++i) CHECK(large.add(ExactColor(large)));
    CHECK_FALSE(large.isPossible());
}
