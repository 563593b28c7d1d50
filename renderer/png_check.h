// A look at a PNG's chunks before libpng gets to see it: libpng reports damage on stderr, past its
// caller, and accepts a file that lacks its end.
#pragma once

#include <span>
#include <string>

namespace etendue {

/// Empty if the bytes are chunks with right checksums up to an end chunk (PNG specification, §5),
/// else what is wrong. What the chunks contain is not looked at.
std::string pngFault(std::span<const unsigned char> png);

}  // namespace etendue
