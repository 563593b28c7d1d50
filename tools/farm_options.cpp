// The options of etendue farm.
#include <CLI/CLI.hpp>
#include <memory>

#include "tools/farm_command.h"
#include "tools/option_checks.h"
#include "tools/scene_options.h"

namespace etendue {

namespace {

/// What both ways of handing out tasks need.
void addTasks(CLI::App* app, FarmCommand& c) {
    app->add_option("scene", c.scene, "Scene file or bare model")->required()->type_name("FILE");
    const auto count = [&](const char* name, std::uint32_t& value, const char* description) {
        app->add_option(name, value, description)
            ->required()
            ->check(CLI::Range(1, 1 << 30).description(""))
            ->type_name("N");
    };
    count("--samples", c.plan.samples, "Per pixel, of the whole picture");
    count("--task-samples", c.plan.taskSamples, "Per pixel, of one task");
    app->add_option("-o,--output", c.folder,
                    "Folder of parts, logs and picture, which all machines see")
        ->required()
        ->type_name("DIR");
    app->add_option("--picture", c.picture, "Its name in the folder; default: picture.exr")
        ->type_name("FILE");
    app->add_option("--threads", c.threads, "Of a task; default: 1")
        ->check(CLI::Range(1, 1024).description(""))
        ->type_name("N");
    app->add_option("--checkpoint", c.checkpointSeconds,
                    "A task writes its part so often; default: as render does")
        ->check(positiveNumber())
        ->type_name("SECONDS");
    addSeed(app, c.seed);
    addSize(app, c.size, "Pixels of the picture");
    addCamera(app, c.camera);
    addOverrides(app, c.overrides);
}

void addSlurm(CLI::App& farm, std::function<ExitCode()>& chosen) {
    const auto command = std::make_shared<FarmCommand>();
    FarmCommand& c = *command;
    CLI::App* slurm = farm.add_subcommand(
        "slurm", "Write a job array for Slurm of the tasks that are missing, and the merge");
    addTasks(slurm, c);
    const auto isTime = [](const std::string& text) {
        return !text.empty() && text.find_first_not_of("0123456789:-") == std::string::npos
                   ? std::string()
                   : fmt::format("expected a time such as 02:30:00, got \"{}\"", text);
    };
    slurm
        ->add_option("--time", c.slurm.time,
                     "Limit of one run of a task, which then goes on in another; default: Slurm's")
        ->check(CLI::Validator(isTime, ""))
        ->type_name("HH:MM:SS");
    slurm->add_option("--partition", c.slurm.partition, "Default: Slurm's")->type_name("NAME");
    slurm
        ->add_option("--sbatch", c.slurm.more,
                     "One more option of sbatch, such as --sbatch=--mem=4G; may be repeated")
        ->allow_extra_args(false)
        ->type_name("OPTION");
    slurm->add_flag("--submit", c.submits, "Submit both, in place of printing how");
    slurm->callback([&chosen, command] { chosen = [command] { return runFarmSlurm(*command); }; });
}

void addList(CLI::App& farm, std::function<ExitCode()>& chosen) {
    const auto command = std::make_shared<FarmCommand>();
    CLI::App* list = farm.add_subcommand(
        "list", "Print one command line for each task that is missing, for any other queue");
    addTasks(list, *command);
    list->callback([&chosen, command] { chosen = [command] { return runFarmList(*command); }; });
}

}  // namespace

void addFarmCommands(CLI::App& app, std::function<ExitCode()>& chosen) {
    CLI::App* farm =
        app.add_subcommand("farm", "Render one picture by many machines (docs/farm.md)");
    farm->require_subcommand(1);
    addSlurm(*farm, chosen);
    addList(*farm, chosen);
}

}  // namespace etendue
