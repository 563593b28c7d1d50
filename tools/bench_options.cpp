#include "tools/bench_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/bench_command.h"
#include "tools/contender.h"
#include "tools/option_checks.h"
#include "tools/regress_command.h"
#include "tools/scene_options.h"
#include "tools/suite_command.h"

namespace etendue {

namespace {

using Chosen = std::function<ExitCode()>;

/// Names separated by commas; words that follow belong to another option, such as scenes.
CLI::Option* addList(CLI::App& app, const char* name, std::vector<std::string>& list,
                     const char* description) {
    return app.add_option(name, list, description)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("LIST");
}

void addAgreement(CLI::App& bench, Chosen& chosen) {
    const auto command = std::make_shared<AgreementCommand>();
    AgreementCommand& c = *command;
    const CLI::Validator contenders(
        [](const std::string& text) {
            return parseContender(text) ? "" : fmt::format("no estimator is called \"{}\"", text);
        },
        "");
    CLI::App* agreement = bench.add_subcommand(
        "agreement",
        "Test whether the estimators make one picture, scene by scene, camera by "
        "camera (docs/agreement.md)");
    agreement
        ->add_option("scene", c.scenes, "Scene files, or names in --scenes; default: all there")
        ->type_name("SCENE");
    agreement->add_option("--scenes", c.folder, "Folder of scenes and of cameras/; default: scenes")
        ->type_name("DIR");
    addList(*agreement, "--cameras", c.cameras,
            "Names in cameras/, files, own: the scene's; default: pinhole,thin-lens,"
            "double-gauss,double-gauss+dispersion,double-gauss-traced,fisheye,"
            "anamorphic");
    addList(*agreement, "--estimators", c.estimators,
            "To test, or techniques such as bdpt:s2t1; default: lt,bdpt, and lt against "
            "bdpt")
        ->check(contenders);
    agreement->add_option("--against", c.reference, "By which estimator; default: pt")
        ->check(contenders)
        ->type_name("NAME");
    agreement
        ->add_option("--techniques", c.techniqueEdges,
                     "Test each technique of bdpt alone, of paths of up to so many edges")
        ->check(CLI::Range(1, 16).description(""))
        ->type_name("N");
    agreement
        ->add_option("--sampler", c.sampler,
                     "sobol, independent, or scene: its own; default: sobol")
        ->check(CLI::IsMember({"sobol", "independent", "scene"}).description(""))
        ->type_name("NAME");
    agreement->add_flag("--by-chance", c.keepsByChance,
                        "Compare what an estimator meets only by chance, too");
    agreement->add_option("--seeds", c.seeds, "Pictures of either estimator; default: 16")
        ->check(CLI::Range(2, 10000).description(""))
        ->type_name("N");
    agreement
        ->add_option("--samples", c.samples,
                     "Per pixel of each picture; default: as many as the bound asks for")
        ->check(CLI::Range(1, 1 << 24).description(""))
        ->type_name("N");
    agreement->add_option("--time", c.seconds, "At most about so long a comparison; default: 20")
        ->check(positiveNumber())
        ->type_name("SECONDS");
    agreement->add_flag("--reckon", c.reckonsTime,
                        "Reckon the time by a table: the same samples in every run");
    agreement
        ->add_option("--must-agree", c.mustAgree,
                     "Fail if fewer comparisons are within the bound; default: 0")
        ->check(CLI::Range(0, 1 << 24).description(""))
        ->type_name("N");
    agreement
        ->add_option("--bound", c.boundPercent, "Of the bias that counts as none; default: 0.2")
        ->check(positiveNumber())
        ->type_name("PERCENT");
    addSize(agreement, c.size, "Pixels of the pictures; default: 48,32");
    addSeed(agreement, c.firstSeed);
    addThreads(agreement, c.threads);
    addSet(agreement, c.overrides);
    agreement->add_flag("--json", c.asJson, "Print JSON");
    agreement->callback(
        [&chosen, command] { chosen = [command] { return runAgreement(*command); }; });
}

void addRegress(CLI::App& bench, Chosen& chosen) {
    const auto command = std::make_shared<RegressCommand>();
    RegressCommand& c = *command;
    CLI::App* regress = bench.add_subcommand(
        "regress",
        "Test bias, rate of convergence and noise of the estimators against what is stored "
        "(docs/regression.md)");
    regress->add_option("scene", c.scenes, "Names in --scenes; default: all there")
        ->type_name("SCENE");
    regress->add_option("--scenes", c.folder, "Folder of scenes and of cameras/; default: scenes")
        ->type_name("DIR");
    addList(*regress, "--cameras", c.cameras,
            "Names in cameras/; default: pinhole,thin-lens,double-gauss,"
            "double-gauss-traced,fisheye,anamorphic");
    addList(*regress, "--estimators", c.estimators, "Default: pt,lt,bdpt")
        ->check(CLI::IsMember(estimatorKinds()).description(""));
    regress
        ->add_option("--data", c.data,
                     "Folder of baseline.toml and references/; default: tests/regression")
        ->type_name("DIR");
    CLI::Option* rebaseline = regress->add_flag("--rebaseline", c.rebaselines,
                                                "Take the noise that is measured for the baseline");
    regress
        ->add_flag("--make-references", c.makesReferences,
                   "Render the references anew, and test nothing")
        ->excludes(rebaseline);
    regress
        ->add_option("--samples", c.samples,
                     "Per pixel of each picture; default: as the baseline says, or 16; of a "
                     "reference 64")
        ->check(numberThat<int>([](int n) { return n >= 16 && n <= 1 << 20 && n % 16 == 0; },
                                "a multiple of 16"))
        ->type_name("N");
    addSeed(regress, c.firstSeed);
    addThreads(regress, c.threads);
    regress->add_flag("--json", c.asJson, "Print JSON");
    regress->callback([&chosen, command] { chosen = [command] { return runRegress(*command); }; });
}

void addSuite(CLI::App& bench, const std::string& commandLine, Chosen& chosen) {
    const auto command = std::make_shared<SuiteCommand>();
    SuiteCommand& c = *command;
    c.commandLine = commandLine;
    bench
        .add_option("suite", c.inputs,
                    "A suite such as scenes/suites/quick.toml, or scenes: files, or names in "
                    "--scenes (docs/benchmarks.md)")
        ->type_name("SUITE | SCENE");
    bench
        .add_option("-o,--output", c.output,
                    "Folder for results and report; what it has of the same suite is not run again")
        ->type_name("DIR");
    bench.add_option("--scenes", c.folder, "Folder of scenes and of cameras/; default: scenes")
        ->type_name("DIR");
    addList(bench, "--cameras", c.cameras,
            "Of scenes: names in cameras/, files, own: the scene's; default: own");
    addList(bench, "--estimators", c.estimators, "Of scenes; default: pt,lt,bdpt")
        ->check(CLI::IsMember(estimatorKinds()).description(""));
    bench.add_option("--time", c.seconds, "Of each run, in place of the suite's; default: 2")
        ->check(numberBetween(1e-3, 1e6))
        ->type_name("SECONDS");
    bench
        .add_option("--reference-time", c.referenceSeconds,
                    "Of each reference, in place of the suite's; default: 60")
        ->check(numberBetween(1e-3, 1e7))
        ->type_name("SECONDS");
    bench
        .add_option("--target", c.targetRelMse,
                    "relMSE to tell the time to, in place of the suite's; default: 0.01")
        ->check(positiveNumber())
        ->type_name("X");
    bench
        .add_option("--seeds", c.seeds,
                    "Runs of each estimator, in place of the suite's; default: 8")
        ->check(CLI::Range(2, 1000).description(""))
        ->type_name("N");
    addSize(&bench, c.size, "Pixels of the pictures, in place of the suite's; default: 96,64");
    addThreads(&bench, c.threads);
    bench.callback([&chosen, &bench, command] {
        if (!bench.get_subcommands().empty()) return;
        if (command->output.empty()) throw CLI::RequiredError("-o");
        chosen = [command] { return runSuite(*command); };
    });
}

}  // namespace

void addBenchCommands(CLI::App& app, const std::string& commandLine,
                      std::function<ExitCode()>& chosen) {
    CLI::App* bench = app.add_subcommand(
        "bench", "Measure estimators, cameras and settings against each other, or test them");
    bench->require_subcommand(0, 1);
    addSuite(*bench, commandLine, chosen);
    addAgreement(*bench, chosen);
    addRegress(*bench, chosen);
}

}  // namespace etendue
