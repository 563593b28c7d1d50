// The options of etendue merge.
#include <CLI/CLI.hpp>
#include <memory>

#include "tools/merge_command.h"
#include "tools/scene_options.h"

namespace etendue {

void addMergeCommand(CLI::App& app, const std::string& commandLine,
                     std::function<ExitCode()>& chosen) {
    const auto command = std::make_shared<MergeCommand>();
    MergeCommand& c = *command;
    c.commandLine = commandLine;
    CLI::App* merge = app.add_subcommand(
        "merge", "Add up part files: the picture of all their samples, however they were rendered");
    merge->add_option("parts", c.parts, "Part files of one picture, by samples that differ")
        ->required()
        ->type_name("PART.part.exr");
    merge->add_option("-o,--output", c.output, "The picture, or by the name x.part.exr a part")
        ->required()
        ->type_name("FILE");
    addSampleRange(merge, "--require", c.required,
                   "Name the samples that are missing of these, and exit with 75");
    merge->add_flag("--restart", c.restarts, "Replace the part that is there, whatever it holds");
    addPreview(merge, c.preview);
    merge->callback([command, &chosen] { chosen = [command] { return runMerge(*command); }; });
}

}  // namespace etendue
