#pragma once

#include <string>

namespace etendue {

/// The report of `etendue bench` as one HTML file that loads nothing from anywhere: data, style,
/// scripts and plotting library are in it. The argument is one JSON object (docs/bench-report.md);
/// whatever its strings hold, it cannot end the script element that it stands in.
std::string benchPage(const std::string& reportDataJson);

}  // namespace etendue
