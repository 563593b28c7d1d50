// Reading and writing images. OpenImageIO is known to image_io.cpp alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace etendue {

/// Pixels row by row from the top left, channels interleaved. 8-bit files stay 8-bit, in the file's
/// own encoding; all other formats become float.
struct Image {
    int width = 0, height = 0, channels = 0;
    std::variant<std::vector<std::uint8_t>, std::vector<float>> pixels;
};

/// Throws InputError (missingFile or badInput) that names the file and the reader's reason:
/// unreadable, truncated, larger than 32768 on a side, no channels. NaN or infinite pixels are an
/// error too.
Image readImage(const std::filesystem::path& file);

/// A named group of float channels of an EXR: "R","G","B" or "albedo.R", …, interleaved in
/// `pixels`.
struct ExrChannels {
    std::vector<std::string> names;
    std::vector<float> pixels;  // width · height · names.size()
};

using MetadataValue =
    std::variant<int, float, std::string, std::vector<float>>;  // 16 floats: a matrix
using Metadata = std::map<std::string, MetadataValue>;

/// The part of the full frame that the pixels cover: EXR data window within the display window.
struct FrameWindow {
    int fullWidth = 0, fullHeight = 0;
    int x = 0, y = 0, width = 0, height = 0;
};

/// Both write to memory, then to a temporary file beside `file`, fsync it and rename it: `file` is
/// either the old one or the whole new one. Throw std::runtime_error with the system's reason.
void writeExr(const std::filesystem::path& file, const FrameWindow& window,
              const std::vector<ExrChannels>& layers, const Metadata& metadata);
/// `pixels`: sRGB bytes, three a pixel.
void writePng(const std::filesystem::path& file, int width, int height,
              const std::vector<std::uint8_t>& pixels);

/// The file-writing half alone: bytes → temporary → fsync → rename. Sweeps nothing.
void writeFileAtomically(const std::filesystem::path& file, const void* data, std::size_t size);

}  // namespace etendue
