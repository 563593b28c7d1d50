// A look at image files before a library gets to see them. libpng reports damage on stderr, past
// its caller, and accepts a file that lacks its end; OpenEXR allocates whatever size the header
// names.
#pragma once

#include <span>
#include <string>

namespace etendue {

/// The most pixels that an image may have on a side.
inline constexpr int largestImageSide = 32768;

/// Empty if the bytes are chunks with right checksums up to an end chunk (PNG specification, §5),
/// else what is wrong. What the chunks contain is not looked at.
std::string pngFault(std::span<const unsigned char> png);

/// Empty if the bytes start with one or more OpenEXR headers (OpenEXR file layout) whose attributes
/// lie within the file and whose data windows are no larger than allowed, else what is wrong.
std::string exrFault(std::span<const unsigned char> exr);

/// "is WIDTH x HEIGHT pixels, expected …"
std::string sizeFault(long long width, long long height);

}  // namespace etendue
