// etendue render, etendue check.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"
#include "renderer/sample_ranges.h"
#include "tools/preview.h"
#include "tools/progress.h"

namespace etendue {

struct RenderCommand {
    std::filesystem::path scene, camera, output, techniqueImages;
    Preview preview;
    std::optional<int> samples, threads;
    std::uint64_t seed = 0;
    std::optional<double> timeLimitSeconds;
    std::optional<double> errorLimit;  // PictureNoise, by its upper bound
    std::optional<SampleRange> range;  // in place of all from 0 on
    std::optional<double> checkpointSeconds;
    bool resumes = false, restarts = false, keepsPart = false;
    std::vector<int> size;  // width, height, or empty
    std::vector<int> crop;  // x, y, width, height, or empty
    std::vector<std::string> overrides;
    std::string techniques;           // of bdpt, or empty
    std::vector<std::string> layers;  // albedo, normal, depth, position, variance
    ProgressStyle progress = ProgressStyle::automatic;
    std::string commandLine;  // for the metadata
};

/// Renders and writes the pictures, and on its way the part file (docs/part-files.md). Throws
/// InputError or std::runtime_error.
ExitCode runRender(const RenderCommand& command);

struct CheckCommand {
    std::filesystem::path scene, camera;
    std::vector<std::string> overrides;
};

/// Loads everything and says what was found.
ExitCode runCheck(const CheckCommand& command);

}  // namespace etendue
