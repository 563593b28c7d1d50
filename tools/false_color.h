// Numbers as colours, for people to look at.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// sRGB bytes, three a value: black for `low` and less, through purple and orange to a pale yellow
/// for `high` and more, even in the logarithm and ever lighter. 0 < low < high.
std::vector<std::uint8_t> falseColors(std::span<const float> values, double low, double high);

}  // namespace etendue
