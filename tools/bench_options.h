// etendue bench …: its subcommands.
#pragma once

#include <functional>

#include "config/config.h"

namespace CLI {
class App;
}

namespace etendue {

/// Adds the command; parsing sets `chosen` to what is to be run, if it is one of its own.
void addBenchCommands(CLI::App& app, std::function<ExitCode()>& chosen);

}  // namespace etendue
