// The texts by which other machines render: command lines, and scripts for Slurm.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/farm_plan.h"

namespace etendue {

/// One word of a shell's command line, whatever its bytes; quoted only if it must be.
std::string shellQuoted(std::string_view word);
/// One value on a line of #SBATCH, which has quotes of its own.
std::string sbatchQuoted(std::string_view value);

/// A picture that many machines render. All paths but the overrides' are absolute.
struct FarmJob {
    FarmPlan plan;
    std::filesystem::path program;  // etendue
    std::filesystem::path scene;
    std::filesystem::path camera;      // a file whose [camera] is looked through, or empty
    std::filesystem::path folder;      // of parts, logs, scripts and fits
    std::filesystem::path picture;     // what the parts are merged into
    std::filesystem::path workFolder;  // from where overrides' relative file names start
    std::vector<std::string> overrides;
    std::vector<int> size;  // width and height, or empty: the scene's
    std::uint64_t seed = 0;
    int threads = 1;  // of a task
    std::optional<double> checkpointSeconds;

    std::filesystem::path parts() const { return folder / "parts"; }
    std::filesystem::path logs() const { return folder / "logs"; }
    /// XDG_CACHE_HOME of the tasks: lens fits, made once.
    std::filesystem::path cache() const { return folder / "cache"; }
    std::filesystem::path renderScript() const { return folder / "render.sbatch"; }
    std::filesystem::path mergeScript() const { return folder / "merge.sbatch"; }
};

/// What Slurm is told beside; empty: its own defaults.
struct SlurmOptions {
    std::string time, partition;
    std::vector<std::string> more;  // "--mem=4G": one line of #SBATCH each
};

/// The command line of a task, for whatever runs it; of the merge, which takes the parts there are.
std::string taskLine(const FarmJob& job, std::uint32_t task);
std::string mergeLine(const FarmJob& job);

/// An element n of its array renders task n, or n more than the script's argument.
std::string renderScript(const FarmJob& job, const SlurmOptions& slurm);
/// Merges what parts there are; holes are named in its log, and by exit code 75.
std::string mergeScript(const FarmJob& job, const SlurmOptions& slurm);

/// "sbatch --parsable --array=… …", which prints the array's id.
std::string submitLine(const FarmJob& job, const TaskArray& array);
/// The same for the merge, once the jobs of these ids are over, well or not. A shell may have the
/// ids in variables.
std::string submitMergeLine(const FarmJob& job, const std::vector<std::string>& ids);

}  // namespace etendue
