// etendue bench regress: whether the estimators still do what they did, without bias, at the rate
// of independent samples, and with the noise that was agreed to. docs/regression.md.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"

namespace etendue {

struct RegressCommand {
    std::vector<std::string> scenes;          // names of folders in `folder`; empty: all
    std::filesystem::path folder = "scenes";  // of scenes, and of cameras/
    std::vector<std::string> cameras = {
        "pinhole", "thin-lens", "double-gauss", "double-gauss-traced", "fisheye", "anamorphic"};
    std::vector<std::string> estimators = {"pt", "lt", "bdpt"};
    std::filesystem::path data = "tests/regression";  // baseline.toml and references/
    bool makesReferences = false;                     // in place of testing
    bool rebaselines = false;                         // takes what was measured for the baseline
    std::optional<int> samples;  // per pixel of each picture; else as the baseline's rows say
    std::optional<int> threads;
    std::uint64_t firstSeed = 0;  // of as many as there are estimators, times 32
    bool asJson = false;
};

/// Failure if any cell fails; bad input or missing file if a reference, a scene or the baseline
/// cannot be read; stopped early if a signal ended it.
ExitCode runRegress(const RegressCommand& command);

}  // namespace etendue
