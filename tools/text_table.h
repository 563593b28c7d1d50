// Tables for the terminal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Rows of as many cells, UTF-8, each column as wide as it must be. `alignment`: an l for each
/// column of words, any other letter for one of numbers.
std::string alignedTable(const std::vector<std::vector<std::string>>& rows,
                         std::string_view alignment);

}  // namespace etendue
