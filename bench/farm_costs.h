// What the work of a farm costs on this machine, by running it small.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

struct FarmScene {
    std::filesystem::path program;  // etendue
    std::filesystem::path scene;
    std::string estimator = "pt";
    int width = 1920, height = 1080;
    int threads = 1;
    std::uint32_t samples = 4096;  // of the whole picture
};

/// `etendue merge` of so many parts.
struct MergeCost {
    int parts = 0;
    double seconds = 0.0, peakBytes = 0.0;
};

/// Medians.
struct FarmCosts {
    double startSeconds = 0.0;   // all that a task does beside rendering and writing
    double sampleSeconds = 0.0;  // of the whole frame
    double spread = 0.0;         // standard deviation of ln(sampleSeconds)
    double partBytes = 0.0;
    double folderBytes = 0.0;             // all that was measured with, in the end
    double encodeSeconds = 0.0;           // to write a part into memory
    double writeSeconds = 0.0;            // to write it into the folder, synced
    double checkpointWriteSeconds = 0.0;  // the same on the way of a render, which waits
    double checkpointSeconds = 0.0;       // by which that takes longer for each one
    std::vector<MergeCost> merges;
    double mergeSeconds = 0.0, mergeSecondsPerPart = 0.0;  // the line through them
};

/// Needs room for `mostParts` parts and a few more in the folder, which is made and removed.
FarmCosts measureFarmCosts(const FarmScene& scene, const std::filesystem::path& folder,
                           int mostParts);

}  // namespace etendue
