#include "tools/lens_command.h"

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <stdexcept>

#include "tools/lens_codegen_command.h"
#include "tools/lens_draw.h"
#include "tools/lens_fit_command.h"
#include "tools/lens_info.h"
#include "tools/lens_report.h"
#include "tools/lens_trade_command.h"
#include "tools/option_checks.h"

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

void addLensSettings(CLI::App* subcommand, LensChoice& choice) {
    subcommand
        ->add_option("--zoom", choice.zoomPosition, "Of a zoom lens; default: the first it lists")
        ->type_name("POSITION");
    subcommand->add_option("--sensor", choice.sensorMm, "Its size in mm; default: 36,24")
        ->delimiter(',')
        ->expected(2)
        ->check(numberBetween(1e-3, 1e5))
        ->type_name("W,H");
    subcommand
        ->add_option("--focus", choice.focusMetres,
                     "From the sensor to what is sharp; default: infinity")
        ->check(positiveNumber())
        ->type_name("METRES");
    subcommand->add_option("--f-number", choice.fNumber, "Default: wide open")
        ->check(numberBetween(0.1, 1e4))
        ->type_name("N");
}

void addLens(CLI::App* subcommand, LensChoice& choice) {
    subcommand->add_option("lens", choice.lens, "Lens file, or the name of one in scenes/lenses")
        ->required()
        ->type_name("LENS");
    addLensSettings(subcommand, choice);
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
        ->check(numberBetween(shortestWavelengthNm, longestWavelengthNm))
        ->type_name("LIST");
    draw->add_flag("--by-wavelength", command->colourByWavelength,
                   "Colour rays by their wavelength, not by their field");
    addJson(draw, command->asJson);
    runWhenChosen(draw, chosen, command, runLensDraw);
}

/// One of a few names, as what it stands for.
template <class Value, class Target>
void addChoice(CLI::App* subcommand, const char* flag, const char* description,
               const std::map<std::string, Value>& values, Target& target) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.push_back(name);
    subcommand
        ->add_option_function<std::string>(
            flag, [values, &target](const std::string& name) { target = values.at(name); },
            description)
        ->check(CLI::IsMember(names).description(""))
        ->type_name("NAME");
}

std::map<std::string, PolynomialBasis> polynomialBases() {
    return {{"axial", PolynomialBasis::axial},
            {"two-plane", PolynomialBasis::twoPlane},
            {"cartesian", PolynomialBasis::cartesian},
            {"none", PolynomialBasis::none}};
}
std::map<std::string, FitForm> fitForms() {
    return {{"two-point", FitForm::twoPoint}, {"sensor-state", FitForm::sensorState}};
}

void addFitOptions(CLI::App* subcommand, FitOptions& options) {
    subcommand->add_option("--terms", options.terms, "Of each polynomial; default: 40")
        ->check(CLI::Range(1, 5000).description(""))
        ->type_name("N");
    subcommand->add_option("--degree", options.degree, "The highest; default: 11")
        ->check(CLI::Range(1, mostPower).description(""))
        ->type_name("N");
    addChoice(
        subcommand, "--basis",
        "axial, two-plane, cartesian (the published one), none; default: by the lens' symmetry",
        polynomialBases(), options.basis);
    addChoice(subcommand, "--form", "two-point (default), or sensor-state, the published one",
              fitForms(), options.form);
    subcommand
        ->add_option("--wavelengths", options.wavelengthsNm,
                     "The shortest and the longest, in nm; default: 400,700")
        ->delimiter(',')
        ->expected(2)
        ->check(numberBetween(shortestWavelengthNm, longestWavelengthNm))
        ->type_name("A,B");
}

void addFit(CLI::App& lens, Chosen& chosen) {
    const auto command = std::make_shared<LensFitCommand>();
    CLI::App* fit =
        lens.add_subcommand("fit", "Fit sparse polynomials to a lens, and report their errors");
    addLens(fit, command->choice);
    addFitOptions(fit, command->options);
    fit->add_option("-o,--output", command->output, "Also write the fit here")->type_name("FILE");
    addJson(fit, command->asJson);
    runWhenChosen(fit, chosen, command, runLensFit);
}

void addReport(CLI::App& lens, Chosen& chosen) {
    const auto command = std::make_shared<LensReportCommand>();
    CLI::App* report = lens.add_subcommand(
        "report",
        "Write a page about a lens and its fit: spots, distortion, light, colour, errors");
    addLens(report, command->choice);
    addFitOptions(report, command->options);
    report->add_option("-o,--output", command->folder, "Gets index.html and report.json")
        ->required()
        ->type_name("FOLDER");
    addJson(report, command->asJson);
    runWhenChosen(report, chosen, command, runLensReport);
}

void addCodegen(CLI::App& lens, Chosen& chosen) {
    const auto command = std::make_shared<LensCodegenCommand>();
    CLI::App* codegen = lens.add_subcommand(
        "codegen", "Write a fit as source text that stands on its own, for other programs");
    addLens(codegen, command->choice);
    addFitOptions(codegen, command->options);
    addChoice(codegen, "--language", "c++ (a header; default), or glsl",
              std::map<std::string, CodeLanguage>{{"c++", CodeLanguage::cPlusPlus},
                                                  {"glsl", CodeLanguage::glsl}},
              command->language);
    codegen->add_option("-o,--output", command->output, "Default: standard output")
        ->type_name("FILE");
    codegen->add_option("--name", command->name, "Of the lens in the code; default: its file's")
        ->type_name("NAME");
    runWhenChosen(codegen, chosen, command, runLensCodegen);
}

/// Several of a few names, separated by commas.
template <class Value>
void addChoices(CLI::App* subcommand, const char* flag, const char* description,
                const std::map<std::string, Value>& values, std::vector<Value>& target) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.push_back(name);
    subcommand
        ->add_option_function<std::vector<std::string>>(
            flag,
            [values, &target](const std::vector<std::string>& chosen) {
                target.clear();
                for (const std::string& name : chosen) target.push_back(values.at(name));
            },
            description)
        ->delimiter(',')
        ->check(CLI::IsMember(names).description(""))
        ->type_name("LIST");
}

void addTrade(CLI::App& lens, Chosen& chosen) {
    const auto command = std::make_shared<LensTradeCommand>();
    CLI::App* trade = lens.add_subcommand(
        "trade", "Fit lenses in many ways; print what each fit costs and what it is worth");
    trade->add_option("lens", command->lenses, "Lens files, or names of some in scenes/lenses")
        ->type_name("LENS");
    addLensSettings(trade, command->choice);
    trade->add_option("--terms", command->terms, "Default: 4,8,16,28,40,64")
        ->delimiter(',')
        ->check(CLI::Range(1, 5000).description(""))
        ->type_name("LIST");
    trade->add_option("--degree", command->degrees, "Default: 7,11")
        ->delimiter(',')
        ->check(CLI::Range(1, mostPower).description(""))
        ->type_name("LIST");
    addChoices(trade, "--basis", "Default: by the lens' symmetry, and cartesian", polynomialBases(),
               command->bases);
    addChoices(trade, "--form", "Default: two-point,sensor-state", fitForms(), command->forms);
    trade->add_option("--csv", command->csv, "Also write the table here")->type_name("FILE");
    trade->add_option("--plot", command->plot, "Also draw error against cost, as SVG")
        ->type_name("FILE");
    // The published table has its own lenses, settings and fits.
    const std::vector<CLI::Option*> ownTableOnly = trade->get_options(
        [trade](const CLI::Option* option) { return option != trade->get_help_ptr(); });
    CLI::Option* slides =
        trade->add_flag("--slides", command->slides,
                        "The published accuracy table, measured again, ours beside it");
    for (CLI::Option* option : ownTableOnly) slides->excludes(option);
    addJson(trade, command->asJson);
    runWhenChosen(trade, chosen, command, runLensTrade);
}

}  // namespace

void addLensCommands(CLI::App& app, Chosen& chosen) {
    CLI::App* lens = app.add_subcommand("lens", "Look at a lens, draw it, fit polynomials to it");
    lens->require_subcommand(1);
    for (const auto add : {addInfo, addDraw, addFit, addReport, addCodegen, addTrade})
        add(*lens, chosen);
}

}  // namespace etendue
