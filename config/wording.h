// How messages speak of keys, values and ranges. Private to config/.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/config.h"
#include "config/config_node.h"

namespace etendue {

/// Control characters escaped, and cut after `mostBytes`.
std::string printable(std::string_view text, std::size_t mostBytes);
/// "text" in quotes, printable and short.
std::string inQuotes(std::string_view text);
/// "camera" and "f_number" give "camera.f_number"; a key that is no bare word is quoted.
std::string joinPath(std::string_view path, std::string_view key);
std::string indexPath(std::string_view path, std::size_t index);
/// 'a', 'b', 'c'; cut after twenty.
std::string listNames(const std::vector<std::string>& names);
/// "; did you mean 'f_number'?", or nothing.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

/// What was found: 0.5, "abc", true, an array of 3 values, a table.
std::string describe(const ConfigNode& node);
/// What was expected: a positive number, an integer from 1 to 8. The ends of Range's named ranges
/// stay unsaid unless they are why `found` was refused.
enum class NumberKind { number, integer };
std::string describe(NumberKind kind, Range range, const ConfigNode* found = nullptr);

}  // namespace etendue
