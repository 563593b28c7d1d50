// Text written to a file that is whole or not there.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// As writeFileAtomically (renderer/atomic_file.h). Throws InputError when its folder does not
/// exist, std::system_error when writing fails; both name the file.
void writeWholeFile(const std::filesystem::path& file, std::string_view text);

/// Throws InputError for what writing a picture to `file` would fail at, since a command had better
/// say so before it works for hours: a folder that is not there, one in the place of the file, and
/// a name that promises another format than `extension`, which it does not follow. An empty path is
/// a picture that nobody wants.
void checkWritable(const std::filesystem::path& file, const std::string& extension);
/// The same of a file whose name may be any.
void checkWritable(const std::filesystem::path& file);

/// Throws InputError if something else is in the place of `folder` or of a folder that it lies in.
void checkFolder(const std::filesystem::path& folder);

/// Makes the folder and those that it lies in, unless they are there. Throws as checkFolder, and
/// std::system_error where the system refuses; both name the place.
void makeFolder(const std::filesystem::path& folder);

/// A file as its user has named it: by "--preview", say, or as "the scene".
struct GivenFile {
    std::string name;
    std::filesystem::path file;  // empty: none is named
};

/// Throws InputError, exit code usage, if one of the files that a command is to write is another of
/// them or one that it reads, by whatever path: what is there would be lost. What is no regular
/// file (a pipe, /dev/null) loses nothing.
void checkDistinct(const std::vector<GivenFile>& written, const std::vector<GivenFile>& read);

}  // namespace etendue
