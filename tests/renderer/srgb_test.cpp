#include "renderer/srgb.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace etendue {
namespace {

TEST_CASE("sRGB: known values of the standard's curve") {
    CHECK(srgbFromLinear(0.0) == 0.0);
    CHECK(srgbFromLinear(1.0) == doctest::Approx(1.0).epsilon(1e-15));
    CHECK(srgbFromLinear(0.001) == doctest::Approx(0.01292).epsilon(1e-15));
    CHECK(srgbFromLinear(0.18) == doctest::Approx(0.46135612950044164).epsilon(1e-14));
    CHECK(linearFromSrgb(0.5) == doctest::Approx(0.21404114048223255).epsilon(1e-14));
    // The standard's two pieces meet to 3e-8 of the encoded range only.
    CHECK(std::abs(srgbFromLinear(0.0031308) - srgbFromLinear(std::nextafter(0.0031308, 1.0))) <
          4e-8);
}

TEST_CASE("sRGB: the two maps undo each other, below zero and above one too") {
    for (const double x : {-2.0, -0.3, -0.001, 0.0, 0.001, 0.002, 0.01, 0.3, 0.99, 1.0, 7.0, 1e6})
        CHECK(linearFromSrgb(srgbFromLinear(x)) == doctest::Approx(x).epsilon(1e-12));
    CHECK(std::isnan(srgbFromLinear(std::numeric_limits<double>::quiet_NaN())));
}

TEST_CASE("sRGB: every byte survives decoding and encoding") {
    for (int level = 0; level < 256; ++level) {
        const auto linear = static_cast<float>(linearFromSrgb(level / 255.0));
        CHECK(srgbBytes({&linear, 1})[0] == level);
    }
}

TEST_CASE("sRGB: exposure is in stops, and what a byte cannot hold goes to its ends") {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> linear = {
        0.25f, 1.0f, 3e38f,     infinity,
        -1.0f, 0.0f, -infinity, std::numeric_limits<float>::quiet_NaN()};
    const auto gray = static_cast<std::uint8_t>(std::lround(255.0 * srgbFromLinear(0.25)));
    CHECK(srgbBytes(linear) == std::vector<std::uint8_t>{gray, 255, 255, 255, 0, 0, 0, 0});
    CHECK(srgbBytes(linear, 2.0) == std::vector<std::uint8_t>{255, 255, 255, 255, 0, 0, 0, 0});
    CHECK(srgbBytes(linear, -2.0)[1] == gray);
    CHECK(srgbBytes({}).empty());
}

}  // namespace
}  // namespace etendue
