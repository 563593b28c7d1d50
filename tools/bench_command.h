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
    /// Files, names of files in cameras/, or "own": the scene's. A lens of glass renders RGB unless
    /// "+dispersion" is appended.
    std::vector<std::string> cameras = {
        "pinhole", "thin-lens", "double-gauss", "double-gauss+dispersion", "double-gauss-traced",
        "fisheye", "anamorphic"};
    std::vector<std::string> overrides;
    std::vector<std::string> estimators;  // as parseContender reads them; empty: the three pairs
    std::string reference;                // empty: pt
    /// Each single technique of paths of up to so many edges, in place of `estimators`.
    int techniqueEdges = 0;
    std::string sampler = "sobol";  // or independent, or scene: its own
    bool keepsByChance = false;
    int seeds = 16;
    std::optional<int> samples, threads;
    double seconds = 20.0;
    bool reckonsTime = false;
    int mustAgree = 0;  // fewer comparisons within the bound are a failure
    double boundPercent = 0.2;
    std::vector<int> size = {48, 32};
    std::uint64_t firstSeed = 0;
    bool asJson = false;
};

/// Prints the matrix. A scene that cannot be loaded through a camera is told in its rows.
ExitCode runAgreement(const AgreementCommand& command);

}  // namespace etendue
