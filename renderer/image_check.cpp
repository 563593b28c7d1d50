#include "renderer/image_check.h"

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

/// Takes what an EXR header is made of off the front of the bytes; past their end there is nothing
/// but zeros, and isGood() is false.
class ExrCursor {
public:
    explicit ExrCursor(std::string_view rest) : rest_(rest) {}

    bool isGood() const { return isGood_; }

    std::string_view bytes(std::size_t count) {
        isGood_ = isGood_ && count <= rest_.size();
        if (!isGood_) return {};
        const std::string_view taken = rest_.substr(0, count);
        rest_.remove_prefix(count);
        return taken;
    }
    /// Up to a zero byte, which goes too.
    std::string_view text() {
        const std::string_view taken = bytes(rest_.find('\0'));
        bytes(1);
        return taken;
    }
    std::int32_t integer() {
        std::uint32_t value = 0, shift = 0;
        for (const char byte : bytes(4)) {
            value |= std::uint32_t{static_cast<unsigned char>(byte)} << shift;
            shift += 8;
        }
        return static_cast<std::int32_t>(value);
    }

private:
    std::string_view rest_;
    bool isGood_ = true;
};

/// Of the value of a dataWindow: first and last x and y.
std::string dataWindowFault(std::string_view value) {
    ExrCursor cursor(value);
    const std::int64_t left = cursor.integer(), top = cursor.integer();
    const std::int64_t right = cursor.integer(), bottom = cursor.integer();
    const std::int64_t width = right - left + 1, height = bottom - top + 1;
    return std::max(width, height) > largestImageSide ? sizeFault(width, height) : std::string();
}

}  // namespace

std::string sizeFault(long long width, long long height) {
    return "is " + std::to_string(width) + " x " + std::to_string(height) +
           " pixels, expected at most " + std::to_string(largestImageSide) + " on a side";
}

std::string pngFault(const std::span<const unsigned char> png) {
    static constexpr std::array<unsigned char, 8> signature{0x89, 'P',  'N',  'G',
                                                            '\r', '\n', 0x1a, '\n'};
    if (png.size() < signature.size() ||
        !std::ranges::equal(png.first<signature.size()>(), signature))
        return "not a PNG file";

    constexpr std::size_t frame = 12;  // length, name and checksum, four bytes each
    std::span<const unsigned char> rest = png.subspan(signature.size());
    while (rest.size() >= frame) {
        const std::size_t length = bigEndian(rest.first<4>());
        if (length > rest.size() - frame) break;
        const auto named = rest.subspan(4, 4 + length);
        if (checksum(named) != bigEndian(rest.subspan(8 + length).first<4>()))
            return "damaged PNG file: wrong checksum of the chunk at byte " +
                   std::to_string(png.size() - rest.size());
        if (std::ranges::equal(named.first<4>(), std::string_view("IEND"))) return {};
        rest = rest.subspan(frame + length);
    }
    return "truncated PNG file";
}

std::string exrFault(const std::span<const unsigned char> exr) {
    ExrCursor cursor({reinterpret_cast<const char*>(exr.data()), exr.size()});
    if (cursor.bytes(4) != "\x76\x2f\x31\x01") return "not an OpenEXR file";
    constexpr std::int32_t multiPart = 0x1000;
    const bool isMultiPart = (cursor.integer() & multiPart) != 0;
    bool isFirstAttribute = true;  // of its header; an empty header ends a list of them
    while (cursor.isGood()) {
        const std::string_view name = cursor.text();
        if (name.empty() && cursor.isGood()) {
            if (!isMultiPart || isFirstAttribute) return {};
            isFirstAttribute = true;
            continue;
        }
        isFirstAttribute = false;
        cursor.text();  // its type
        const auto size = static_cast<std::uint32_t>(cursor.integer());
        const std::string_view value = cursor.bytes(size);
        if (name == "dataWindow")
            if (std::string fault = dataWindowFault(value); !fault.empty()) return fault;
    }
    return "truncated or damaged OpenEXR header";
}

}  // namespace etendue
