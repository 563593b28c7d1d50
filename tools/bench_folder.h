// BenchFolder: where a benchmark keeps what.
#pragma once

#include <filesystem>
#include <string>

#include "tools/bench_records.h"

namespace etendue {

/// The files of a suite's folder.
struct BenchFolder {
    std::filesystem::path path;

    std::filesystem::path records() const { return path / "results.jsonl"; }
    /// At the end of a run.
    std::filesystem::path picture(const BenchConfiguration& configuration, int seed) const;
    std::filesystem::path referencePicture(const std::string& scene,
                                           const std::string& camera) const;
    std::filesystem::path techniques(const std::string& scene, const std::string& camera) const;
};

}  // namespace etendue
