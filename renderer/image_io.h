// Reading and writing images. OpenImageIO is known to image_io.cpp alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "renderer/atomic_file.h"

namespace etendue {

/// Pixels row by row from the top left, channels interleaved. 8-bit files stay 8-bit, in the file's
/// own encoding; all other formats become float.
struct Image {
    int width = 0, height = 0;
    int channels = 0;  // 1: grey, 2: grey and alpha, 3: RGB, 4: RGB and alpha
    std::variant<std::vector<std::uint8_t>, std::vector<float>> pixels;
    /// True of float pixels made from 16-bit integers: they lie in [0, 1] and are, as 8-bit ones,
    /// in the file's own encoding (by custom sRGB for colours). False of light itself (EXR, HDR).
    bool isEncoded = false;
};

/// Reads .exr, .hdr, .png, .jpg, .tif, .tga and .bmp; the name says which, the content must agree.
///
/// Of an EXR the data window is read, and of a file with more than one layer R, G, B and A of the
/// unnamed one. Colours stay as the file has them (not multiplied by alpha in PNG, TIFF and TGA);
/// orientation tags and colour profiles are not applied.
///
/// Throws InputError (missingFile or badInput) that names the file and the reader's reason:
/// unreadable, truncated, of another format, larger than largestImageSide, neither grey nor RGB,
/// integers of more than 16 bits, NaN or infinite pixels.
Image readImage(const std::filesystem::path& file);

/// A named group of float channels of an EXR: "R","G","B" or "albedo.R", …, interleaved in
/// `pixels`.
struct ExrChannels {
    std::vector<std::string> names;
    std::vector<float> pixels;  // width · height · names.size()
};

/// The channels of these names (at least one) of the data window, as float; none if one is missing,
/// as of a file that is no EXR. Throws InputError as readImage does.
std::optional<ExrChannels> readExrChannels(const std::filesystem::path& file,
                                           const std::vector<std::string>& names);

/// 9 or 16 floats are a matrix, row by row for row vectors (p · M) as OpenEXR's own worldToCamera
/// and worldToNDC; 2 or 3 are a vector, other numbers of floats an array.
using MetadataValue = std::variant<int, float, std::string, std::vector<float>>;
using Metadata = std::map<std::string, MetadataValue>;

/// The part of the full frame that the pixels cover: EXR data window within the display window.
struct FrameWindow {
    int fullWidth = 0, fullHeight = 0;
    int x = 0, y = 0, width = 0, height = 0;

    friend bool operator==(const FrameWindow&, const FrameWindow&) = default;
};

/// Where the pixels of an EXR lie; none of a file of another format, which does not say. Throws
/// InputError as readImage does.
std::optional<FrameWindow> readExrWindow(const std::filesystem::path& file);

enum class ExrCompression { none, zip };

/// The bytes of the file that writeExr() writes, or those of one without compression: noise does
/// not compress, and trying takes far longer than the rest.
std::vector<unsigned char> encodeExr(const std::filesystem::path& file, const FrameWindow& window,
                                     const std::vector<ExrChannels>& layers,
                                     const Metadata& metadata,
                                     ExrCompression compression = ExrCompression::zip);

/// 32-bit float, ZIP, bit for bit (NaN and infinity too), through writeFileAtomically, whose errors
/// it throws. Equal arguments give equal bytes: there is no date but a capDate in `metadata`.
/// Throws std::invalid_argument for a window outside the frame, pixels of the wrong number, a
/// channel named twice, and metadata that an EXR cannot hold under that name.
void writeExr(const std::filesystem::path& file, const FrameWindow& window,
              const std::vector<ExrChannels>& layers, const Metadata& metadata);

/// `pixels`: sRGB bytes, three a pixel. Otherwise as writeExr.
void writePng(const std::filesystem::path& file, int width, int height,
              const std::vector<std::uint8_t>& pixels);

}  // namespace etendue
