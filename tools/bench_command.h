// etendue bench agreement: whether the estimators make one picture, of which scenes through which
// cameras.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"

namespace etendue {

struct AgreementCommand {
    std::vector<std::string> scenes;          // files, or names of folders in `folder`; empty: all
    std::filesystem::path folder = "scenes";  // of scenes, and of cameras/
    /// Files, names of files in cameras/, or "own": the scene's.
    std::vector<std::string> cameras = {
        "pinhole", "thin-lens", "double-gauss", "double-gauss-traced", "fisheye", "anamorphic"};
    std::vector<std::string> overrides;
    std::vector<std::string> estimators = {"lt", "bdpt"};
    std::string reference = "pt";
    int seeds = 16;
    std::optional<int> samples, threads;
    double seconds = 20.0;
    double boundPercent = 0.2;
    std::vector<int> size = {48, 32};
    std::uint64_t firstSeed = 0;
    bool asJson = false;
};

/// Prints the matrix. A scene that cannot be loaded through a camera is told in its rows.
ExitCode runAgreement(const AgreementCommand& command);

}  // namespace etendue
