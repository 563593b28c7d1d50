// With main.cpp the only file that knows CLI11.
#include "tools/lens_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>

#include "tools/lens_draw.h"
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

void addDraw(CLI::App& lens, Chosen& chosen) {
    const auto command = std::make_shared<LensDrawCommand>();
    CLI::App* draw =
        lens.add_subcommand("draw", "Draw the cross-section with exactly traced rays, as SVG");
    addLens(draw, command->choice);
    draw->add_option("-o,--output", command->output, "The picture")->required()->type_name("FILE");
    draw->add_option("--fields", command->fields, "Beams, from the axis to the edge; default: 3")
        ->check(CLI::Range(1, 6).description(""))
        ->type_name("N");
    draw->add_option("--rays", command->raysPerField, "Of each beam; default: 7")
        ->check(CLI::Range(1, 100).description(""))
        ->type_name("N");
    draw->add_option("--wavelengths", command->wavelengthsNm, "In nm; default: the d line")
        ->delimiter(',')
        ->check(CLI::Range(shortestWavelengthNm, longestWavelengthNm).description(""))
        ->type_name("LIST");
    draw->add_flag("--by-wavelength", command->colourByWavelength,
                   "Colour rays by their wavelength, not by their field");
    addJson(draw, command->asJson);
    runWhenChosen(draw, chosen, command, runLensDraw);
}

}  // namespace

void addLensCommands(CLI::App& app, Chosen& chosen) {
    CLI::App* lens = app.add_subcommand("lens", "Look at a lens, draw it, fit polynomials to it");
    lens->require_subcommand(1);
    for (const auto add : {addInfo, addDraw}) add(*lens, chosen);
}

}  // namespace etendue
