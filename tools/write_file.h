// Text written to a file that is whole or not there.
#pragma once

#include <filesystem>
#include <string_view>

namespace etendue {

/// By way of a temporary file beside it. Throws InputError when its folder does not exist,
/// std::runtime_error when writing fails; both name the file.
void writeWholeFile(const std::filesystem::path& file, std::string_view text);

}  // namespace etendue
