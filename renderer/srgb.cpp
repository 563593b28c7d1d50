#include "renderer/srgb.h"

#include <cmath>

namespace etendue {

double srgbFromLinear(double linear) {
    const double x = std::abs(linear);
    if (x <= 0.0031308) return 12.92 * linear;
    return std::copysign(1.055 * std::pow(x, 1.0 / 2.4) - 0.055, linear);
}

double linearFromSrgb(double encoded) {
    const double x = std::abs(encoded);
    if (x <= 0.04045) return encoded / 12.92;
    return std::copysign(std::pow((x + 0.055) / 1.055, 2.4), encoded);
}

std::vector<std::uint8_t> srgbBytes(std::span<const float> linear, double exposureStops) {
    const double scale = std::exp2(exposureStops);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(linear.size());
    for (const float value : linear) {
        const double level = 255.0 * srgbFromLinear(scale * value);
        // Written so that NaN fails the first comparison.
        const double inRange = level > 0.0 ? (level < 255.0 ? level : 255.0) : 0.0;
        bytes.push_back(static_cast<std::uint8_t>(std::lround(inRange)));
    }
    return bytes;
}

}  // namespace etendue
