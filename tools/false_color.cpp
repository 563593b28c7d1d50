#include "tools/false_color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {

std::vector<std::uint8_t> falseColors(std::span<const float> values, double low, double high) {
    constexpr std::array<std::array<double, 3>, 5> ramp{{{0.0, 0.0, 0.0},
                                                         {80.0, 20.0, 125.0},
                                                         {180.0, 55.0, 120.0},
                                                         {250.0, 135.0, 95.0},
                                                         {255.0, 255.0, 190.0}}};
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * values.size());
    for (const float value : values) {
        const double bounded = std::clamp(static_cast<double>(value), low, high);
        const double position =
            std::log(bounded / low) / std::log(high / low) * static_cast<double>(ramp.size() - 1);
        const std::size_t below = std::min(static_cast<std::size_t>(position), ramp.size() - 2);
        for (std::size_t c = 0; c < 3; ++c)
            bytes.push_back(static_cast<std::uint8_t>(std::lround(std::lerp(
                ramp[below][c], ramp[below + 1][c], position - static_cast<double>(below)))));
    }
    return bytes;
}

}  // namespace etendue
