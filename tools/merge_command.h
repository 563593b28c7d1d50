// etendue merge: parts of a picture add up to it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"
#include "renderer/sample_ranges.h"
#include "tools/preview.h"

namespace CLI {
class App;
}

namespace etendue {

struct MergeCommand {
    std::vector<std::filesystem::path> parts;
    std::filesystem::path output;
    Preview preview;
    std::optional<SampleRange> required;
    bool restarts = false;    // replaces the part that is there, though it is none of `parts`
    std::string commandLine;  // for the metadata
};

/// One part after another is in memory, however many there are. Throws InputError, naming the file
/// and what differs, for parts that do not belong together; then nothing is written. With holes in
/// what is required the picture is written, and the exit code is stoppedEarly.
ExitCode runMerge(const MergeCommand& command);

/// Adds "merge" to the command line. If it is chosen, `chosen` runs it.
void addMergeCommand(CLI::App& app, const std::string& commandLine,
                     std::function<ExitCode()>& chosen);

}  // namespace etendue
