#include "tools/false_color.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace etendue;

TEST_CASE("False colours: even in the logarithm, ever lighter") {
    std::vector<float> values;
    for (int i = 0; i <= 40; ++i)
        values.push_back(static_cast<float>(std::pow(10.0, -4.0 + 0.1 * i)));
    const std::vector<std::uint8_t> bytes = falseColors(values, 1e-4, 1.0);
    REQUIRE(bytes.size() == 3 * values.size());
    for (std::size_t i = 3; i < bytes.size(); i += 3)
        CHECK(bytes[i] + bytes[i + 1] + bytes[i + 2] > bytes[i - 3] + bytes[i - 2] + bytes[i - 1]);
    CHECK(bytes[60] == 180);  // 1 %, in the middle
}

TEST_CASE("False colours: what lies beyond the scale has the colour of its end") {
    const std::vector<float> values{0.0F, 1e-4F, 1.0F, 1e6F};
    const std::vector<std::uint8_t> bytes = falseColors(values, 1e-4, 1.0);
    CHECK(std::vector(bytes.begin(), bytes.begin() + 3) == std::vector<std::uint8_t>{0, 0, 0});
    CHECK(std::vector(bytes.begin() + 3, bytes.begin() + 6) == std::vector<std::uint8_t>{0, 0, 0});
    for (const std::ptrdiff_t i : {6, 9})
        CHECK(std::vector(bytes.begin() + i, bytes.begin() + i + 3) ==
              std::vector<std::uint8_t>{255, 255, 190});
}
