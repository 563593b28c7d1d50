// etendue lens …: the subcommands about lenses and their options.
#pragma once

#include <functional>

#include "config/config.h"

namespace CLI {
class App;
}

namespace etendue {

/// Adds `lens`. When the user has chosen one of its subcommands, `chosen` becomes what to run.
void addLensCommands(CLI::App& app, std::function<ExitCode()>& chosen);

}  // namespace etendue
