// With main.cpp the only file that knows CLI11.
#include "tools/lens_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>

#include "tools/lens_info.h"

namespace etendue {

namespace {

using Chosen = std::function<ExitCode()>;

/// What a lens cannot be set to is a wrong option, not a wrong file.
template <class Command>
void runWhenChosen(CLI::App* subcommand, Chosen& chosen, std::shared_ptr<Command> command,
                   ExitCode (*run)(const Command&)) {
    subcommand->callback([&chosen, command, run] {
        chosen = [command, run] {
            try {
                return run(*command);
            } catch (const std::invalid_argument& error) {
                throw InputError(error.what(), ExitCode::usage);
            }
        };
    });
}

void addLens(CLI::App* subcommand, LensChoice& choice) {
    subcommand->add_option("lens", choice.lens, "Lens file, or the name of one in scenes/lenses")
        ->required()
        ->type_name("LENS");
    subcommand
        ->add_option("--zoom", choice.zoomPosition, "Of a zoom lens; default: the first it lists")
        ->type_name("POSITION");
    subcommand->add_option("--sensor", choice.sensorMm, "Its size in mm; default: 36,24")
        ->delimiter(',')
        ->expected(2)
        ->check(CLI::PositiveNumber.description(""))
        ->type_name("W,H");
    subcommand
        ->add_option("--focus", choice.focusMetres,
                     "From the sensor to what is sharp; default: infinity")
        ->check(CLI::PositiveNumber.description(""))
        ->type_name("METRES");
    subcommand->add_option("--f-number", choice.fNumber, "Default: wide open")
        ->check(CLI::PositiveNumber.description(""))
        ->type_name("N");
}

void addJson(CLI::App* subcommand, bool& asJson) {
    subcommand->add_flag("--json", asJson, "Print JSON");
}

void addInfo(CLI::App& lens, Chosen& chosen) {
    const auto command = std::make_shared<LensInfoCommand>();
    CLI::App* info = lens.add_subcommand(
        "info", "Paraxial data, pupils, field of view, symmetry, surfaces and glass");
    addLens(info, command->choice);
    addJson(info, command->asJson);
    runWhenChosen(info, chosen, command, runLensInfo);
}

}  // namespace

void addLensCommands(CLI::App& app, Chosen& chosen) {
    CLI::App* lens = app.add_subcommand("lens", "Look at a lens, draw it, fit polynomials to it");
    lens->require_subcommand(1);
    for (const auto add : {addInfo}) add(*lens, chosen);
}

}  // namespace etendue
