// The Sobol' sequence with the direction numbers of Joe and Kuo 2008, "Constructing Sobol sequences
// with better two-dimensional projections", and Owen's nested scrambling of it, by hashing: Burley
// 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4).
#pragma once

#include <array>
#include <cstdint>

namespace etendue {

/// Those that there are tables for: four bounces of a path, which is where most light is decided.
constexpr std::uint32_t sobolDimensions = 32;

/// For each byte of a point's index, what its values add up (by exclusive or).
using SobolTable = std::array<std::array<std::uint32_t, 256>, 4>;
/// [dimension]
const std::array<SobolTable, sobolDimensions>& sobolTables();

/// 32 binary digits of coordinate `dimension` < sobolDimensions of point `index`.
inline std::uint32_t sobolBits(std::uint32_t index, std::uint32_t dimension) {
    const SobolTable& table = sobolTables()[dimension];
    return table[0][index & 0xff] ^ table[1][index >> 8 & 0xff] ^ table[2][index >> 16 & 0xff] ^
           table[3][index >> 24];
}

constexpr std::uint32_t reversedBits(std::uint32_t x) {
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    return __builtin_bswap32(x);
}

/// Each digit flipped at random, alike for all numbers that share the digits above it: what is
/// stratified stays so, and with a uniform `seed` the number is uniform.
constexpr std::uint32_t owenScrambled(std::uint32_t bits, std::uint32_t seed) {
    std::uint32_t x = reversedBits(bits);
    x += seed;  // a hash in which every bit depends on the lower ones alone (Burley 2020, §3)
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reversedBits(x);
}

}  // namespace etendue
