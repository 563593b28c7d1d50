// Hashes of what a render was made from. xxHash is known to content_hash.cpp alone.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace etendue {

/// Of bytes that come piece by piece: 128 bits by XXH3, as 32 hexadecimal digits.
class ByteHasher {
public:
    ByteHasher();
    ~ByteHasher();
    void add(const void* bytes, std::size_t size);
    std::string digest() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// 128 bits, as 32 hexadecimal digits, of the contents of the files and of the strings, in order;
/// not of the files' names. Throws InputError for a file that cannot be read.
std::string contentHash(const std::vector<std::filesystem::path>& files,
                        const std::vector<std::string>& strings);

}  // namespace etendue
