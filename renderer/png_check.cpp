#include "renderer/png_check.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace etendue {
namespace {

std::uint32_t bigEndian(std::span<const unsigned char, 4> bytes) {
    std::uint32_t value = 0;
    for (const unsigned char byte : bytes) value = value << 8 | byte;
    return value;
}

/// CRC-32 of ISO 3309, the remainder of every byte by itself (PNG specification, annex D).
constexpr std::array<std::uint32_t, 256> remainders = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
        std::uint32_t remainder = byte;
        for (int bit = 0; bit < 8; ++bit)
            remainder = remainder >> 1 ^ (remainder & 1 ? 0xedb88320U : 0U);
        table[byte] = remainder;
    }
    return table;
}();

std::uint32_t checksum(std::span<const unsigned char> bytes) {
    std::uint32_t sum = 0xffffffffU;
    for (const unsigned char byte : bytes) sum = sum >> 8 ^ remainders[(sum ^ byte) & 0xff];
    return ~sum;
}

}  // namespace

std::string pngFault(const std::span<const unsigned char> png) {
    std::span<const unsigned char> bytes = png;
    static constexpr std::array<unsigned char, 8> signature{0x89, 'P',  'N',  'G',
                                                            '\r', '\n', 0x1a, '\n'};
    if (bytes.size() < signature.size() ||
        !std::ranges::equal(bytes.first<signature.size()>(), signature))
        return "not a PNG file";
    bytes = bytes.subspan(signature.size());

    constexpr std::size_t frame = 12;  // length, name and checksum, four bytes each
    while (bytes.size() >= frame) {
        const std::size_t length = bigEndian(bytes.first<4>());
        if (length > bytes.size() - frame) break;
        const auto named = bytes.subspan(4, 4 + length);
        const std::string_view name(reinterpret_cast<const char*>(named.data()), 4);
        if (checksum(named) != bigEndian(bytes.subspan(8 + length).first<4>()))
            return "damaged PNG file: wrong checksum of the chunk at byte " +
                   std::to_string(png.size() - bytes.size());
        if (name == "IEND") return {};
        bytes = bytes.subspan(frame + length);
    }
    return "truncated PNG file";
}

}  // namespace etendue
