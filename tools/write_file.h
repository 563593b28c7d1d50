// Text written to a file that is whole or not there.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace etendue {

/// As writeFileAtomically (renderer/atomic_file.h). Throws InputError when its folder does not
/// exist, std::system_error when writing fails; both name the file.
void writeWholeFile(const std::filesystem::path& file, std::string_view text);

/// Throws InputError for what writing a picture to `file` would fail at, since a command had better
/// say so before it works for hours: a folder that is not there, one in the place of the file, and
/// a name that promises another format than `extension`, which it does not follow. An empty path is
/// a picture that nobody wants.
void checkWritable(const std::filesystem::path& file, const std::string& extension);

}  // namespace etendue
