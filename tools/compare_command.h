// etendue compare: how far a picture is from its reference (docs/metrics.md).
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"

namespace CLI {
class App;
}

namespace etendue {

/// Which of the two pictures has no noise.
enum class ExactPicture { none, picture, reference };

struct CompareCommand {
    std::filesystem::path picture, reference;
    std::filesystem::path errorImage;  // .exr, .png, or empty
    std::optional<double> maxRelMse, maxMeanErrorPercent, maxFlip;
    bool testsMeans = false;  // by a z-test of each tile
    int tileSize = 16;        // pixels
    ExactPicture exact = ExactPicture::none;
    bool asJson = false;
};

struct CompareReport {
    std::string text;                   // a table, or JSON
    std::vector<std::string> exceeded;  // a message for each limit
    ExitCode code = ExitCode::success;  // failure if a limit is exceeded or the means told apart
};
/// Writes the error image, prints nothing. Throws InputError for pictures that cannot be compared.
CompareReport compareFiles(const CompareCommand& command);

/// Prints what compareFiles() says.
ExitCode runCompare(const CompareCommand& command);

/// Adds the command; parsing sets `chosen` to what is to be run, if it is this one.
void addCompareCommand(CLI::App& app, std::function<ExitCode()>& chosen);

}  // namespace etendue
