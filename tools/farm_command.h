// etendue farm: one picture by many machines (docs/farm.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"
#include "tools/farm_scripts.h"

namespace CLI {
class App;
}

namespace etendue {

struct FarmCommand {
    std::filesystem::path scene, camera, folder;
    std::filesystem::path picture = "picture.exr";  // in `folder`
    FarmPlan plan;
    std::vector<std::string> overrides;
    std::vector<int> size;  // width, height, or empty
    std::uint64_t seed = 0;
    int threads = 1;  // of a task: every queue has room for one
    std::optional<double> checkpointSeconds;
    // Of farm slurm.
    SlurmOptions slurm;
    bool submits = false;
};

/// Writes the scripts for the tasks that are missing, and submits them or says how. Throws
/// InputError or std::runtime_error.
ExitCode runFarmSlurm(const FarmCommand& command);

/// Prints a command line for each task that is missing.
ExitCode runFarmList(const FarmCommand& command);

/// Adds the command; parsing sets `chosen` to what is to be run, if it is one of its own.
void addFarmCommands(CLI::App& app, std::function<ExitCode()>& chosen);

}  // namespace etendue
