// The options of etendue compare.
#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "tools/compare_command.h"
#include "tools/option_checks.h"

namespace etendue {

void addCompareCommand(CLI::App& app, std::function<ExitCode()>& chosen) {
    const auto command = std::make_shared<CompareCommand>();
    CompareCommand& c = *command;
    CLI::App* compare = app.add_subcommand("compare", "How far a picture is from a reference");
    compare->add_option("picture", c.picture, "EXR or HDR, by any renderer")
        ->required()
        ->type_name("FILE");
    compare->add_option("reference", c.reference, "What it ought to be")
        ->required()
        ->type_name("FILE");
    compare
        ->add_option("--error-image", c.errorImage,
                     "Write each pixel's relative squared error: .exr, or .png in false colours")
        ->type_name("FILE");
    const auto limit = [&](const char* name, std::optional<double>& value, const char* description,
                           const char* type) {
        compare->add_option(name, value, description)
            ->check(numberThat<double>([](double v) { return v >= 0.0; }, "a number, 0 or more"))
            ->type_name(type);
    };
    limit("--max-relmse", c.maxRelMse, "Fail if relMSE is above", "X");
    limit("--max-mean-error", c.maxMeanErrorPercent,
          "Fail if the brightness is off by more, either way", "PERCENT");
    limit("--max-flip", c.maxFlip, "Fail if FLIP is above", "X");
    compare->add_flag("--z", c.testsMeans,
                      "Fail if the means differ by more than the variance layers allow");
    compare->add_option("--tile", c.tileSize, "Pixels of a tile of --z; default: 16")
        ->check(CLI::Range(1, 32768).description(""))
        ->type_name("N");
    const std::map<std::string, ExactPicture> exact{{"picture", ExactPicture::picture},
                                                    {"reference", ExactPicture::reference}};
    compare
        ->add_option_function<std::string>(
            "--exact", [&c, exact](const std::string& name) { c.exact = exact.at(name); },
            "picture or reference: what has no noise, and needs no variance layer")
        ->check(CLI::IsMember({"picture", "reference"}).description(""))
        ->type_name("WHICH");
    compare->add_flag("--json", c.asJson, "Print JSON");
    compare->callback([&chosen, command] { chosen = [command] { return runCompare(*command); }; });
}

}  // namespace etendue
