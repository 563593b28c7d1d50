// etendue replay: one sample of a picture, vertex by vertex.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "config/config.h"

namespace etendue {

struct ReplayCommand {
    std::filesystem::path scene, camera;
    std::vector<std::string> overrides;
    std::vector<int> size;   // width, height, or empty
    std::vector<int> pixel;  // x, y of the full frame
    std::uint32_t sample = 0;
    std::uint64_t seed = 0;
    bool asJson = false;
};

/// Traces the sample that `etendue render` takes with the same scene, overrides, size and seed, and
/// prints all of it.
ExitCode runReplay(const ReplayCommand& command);

}  // namespace etendue
