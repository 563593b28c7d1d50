// Text written to a file that is whole or not there.
#pragma once

#include <filesystem>
#include <string_view>

namespace etendue {

/// As writeFileAtomically (renderer/atomic_file.h). Throws InputError when its folder does not
/// exist, std::system_error when writing fails; both name the file.
void writeWholeFile(const std::filesystem::path& file, std::string_view text);

}  // namespace etendue
