// Fowler, Noll and Vo's hash FNV-1a, 64 bits: the same number on every machine.
#pragma once

#include <cstdint>
#include <string_view>

namespace etendue {

class Fnv1a {
public:
    void addByte(std::uint8_t byte) { hash_ = (hash_ ^ byte) * 0x100000001b3u; }
    /// Its bytes from the lowest on.
    void add(std::uint64_t word) {
        for (int byte = 0; byte < 8; ++byte) addByte(static_cast<std::uint8_t>(word >> (8 * byte)));
    }
    std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325u;
};

inline std::uint64_t fnv1a(std::string_view text) {
    Fnv1a hash;
    for (const char c : text) hash.addByte(static_cast<std::uint8_t>(c));
    return hash.value();
}

}  // namespace etendue
