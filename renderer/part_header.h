// The header of a part file: TOML, and back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "renderer/part_file.h"

namespace etendue {

/// What a part has of the film besides its sums.
struct PartPlanes {
    bool extraSamples = false, sampleLight = false;
};

struct PartHeader {
    Part part;  // its sums empty
    PartPlanes planes;
};

/// Of `state` the counts alone are written.
std::string partHeaderText(const PartInfo& info, const FilmState& state, PartPlanes planes);

/// What the header announces behind it.
std::uint64_t bytesOfSums(const PartHeader& header);

/// ["albedo", "depth"]: a list in TOML.
std::string layersText(const FilmLayers& layers);

/// Throws InputError, naming `file`, for what is no header of a part.
PartHeader parsePartHeader(std::string_view text, const std::filesystem::path& file);

}  // namespace etendue
