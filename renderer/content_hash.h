// Hashes of what a render was made from. xxHash is known to content_hash.cpp alone.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// 128 bits, as 32 hexadecimal digits, of the contents of the files and of the strings, in order;
/// not of the files' names. Throws InputError for a file that cannot be read.
std::string contentHash(const std::vector<std::filesystem::path>& files,
                        const std::vector<std::string>& strings);

}  // namespace etendue
