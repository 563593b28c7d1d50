// etendue bench SUITE.toml | SCENE…: estimators, cameras and settings measured against each other.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"

namespace etendue {

struct SuiteCommand {
    std::vector<std::string> inputs;  // one suite file, or scenes: files or names in `folder`
    std::filesystem::path output;     // a folder, made if it is not there
    std::filesystem::path folder = "scenes";
    // Of scenes without a suite; empty: their own camera, all estimators.
    std::vector<std::string> cameras, estimators;
    // In place of what the suite says.
    std::optional<double> seconds, referenceSeconds, targetRelMse;
    std::optional<int> seeds, threads;
    std::vector<int> size;
    std::string commandLine;
};

/// Runs what the output folder does not have yet, prints the table, and writes results.csv and
/// report.html.
ExitCode runSuite(const SuiteCommand& command);

}  // namespace etendue
