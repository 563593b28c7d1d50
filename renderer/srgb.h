// sRGB: linear light ↔ the encoding of 8-bit pictures (IEC 61966-2-1).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Both maps are exact on their whole range, continue oddly below zero, and map NaN to NaN.
double srgbFromLinear(double linear);
double linearFromSrgb(double encoded);

/// For a preview: values times 2^exposureStops, encoded, rounded to the nearest of 256 levels, and
/// nothing else. What a byte cannot hold becomes 0 (below zero, and NaN) or 255 (above one).
std::vector<std::uint8_t> srgbBytes(std::span<const float> linear, double exposureStops = 0.0);

}  // namespace etendue
