// etendue bench …: its subcommands.
#pragma once

#include <functional>
#include <string>

#include "config/config.h"

namespace CLI {
class App;
}

namespace etendue {

/// Adds the command; parsing sets `chosen` to what is to be run, if it is one of its own.
/// `commandLine`: as it was typed, for reports.
void addBenchCommands(CLI::App& app, const std::string& commandLine,
                      std::function<ExitCode()>& chosen);

}  // namespace etendue
