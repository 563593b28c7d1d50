// Files that other people's files name.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// The file that `name`, perhaps written on Windows, means in a file of `folder`, if it exists.
std::optional<std::filesystem::path> findAsWritten(const std::filesystem::path& folder,
                                                   std::string name);

/// The same; else, with a note "WHERE: …", the file of that bare name in `folder`, if it exists.
std::optional<std::filesystem::path> findReferencedFile(const std::filesystem::path& folder,
                                                        const std::string& name,
                                                        const std::string& where,
                                                        std::vector<std::string>& notes);

}  // namespace etendue
