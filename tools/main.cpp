// The command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>

#include "config/config.h"
#include "renderer/estimator.h"
#include "renderer/parallel.h"
#include "tools/bench_options.h"
#include "tools/compare_command.h"
#include "tools/farm_command.h"
#include "tools/lens_command.h"
#include "tools/merge_command.h"
#include "tools/option_checks.h"
#include "tools/render_command.h"
#include "tools/replay_command.h"
#include "tools/scene_options.h"
#include "tools/version.h"

namespace etendue {
namespace {

constexpr const char* learnMore = R"(
Examples:
  etendue render scenes/still-life/scene.toml -o out/picture.exr --preview out/picture.png
  etendue render model.obj -o out/model.exr --samples 256 --size 640,480
  etendue render scene.toml -o a.exr -s camera.f_number=5.6 -s material.glass.ior=1.7
  etendue render scene.toml -o a.exr --estimator bdpt --camera scenes/cameras/fisheye.toml
  etendue render scene.toml -o a.exr --time 60 --layers albedo,normal,depth
  etendue render scene.toml -o a.exr --resume --samples 4096
  etendue merge a.part.exr b.part.exr -o picture.exr
  etendue farm slurm scene.toml --samples 4096 --task-samples 64 -o out/farm --submit
  etendue check scene.toml
  etendue replay scene.toml --pixel 360,240 --sample 0 --estimator bdpt
  etendue compare out/picture.exr out/reference.exr --error-image out/error.png
  etendue bench agreement cornell-box --cameras pinhole,double-gauss
  etendue lens info double-gauss-100mm

Exit codes:
  0 success   1 failure (disk full, a limit exceeded)   64 wrong usage   65 bad input
  66 missing file   75 stopped early, with a valid partial picture written

docs/scene-format.md describes the scene files.)";

std::string joinArguments(int argc, char** argv) {
    std::string line = "etendue";
    for (int i = 1; i < argc; ++i) line += fmt::format(" {}", argv[i]);
    return line;
}

void addRender(CLI::App& app, RenderCommand& c) {
    CLI::App* render =
        app.add_subcommand("render", "Render a scene (.toml) or a model (.obj) to EXR");
    render->add_option("scene", c.scene, "Scene file or bare model")->required()->type_name("FILE");
    render->add_option("-o,--output", c.output, "The picture: linear float EXR")
        ->required()
        ->type_name("FILE");
    addPreview(render, c.preview);
    render->add_option("--samples", c.samples, "Per pixel; default: the scene's estimator.samples")
        ->check(CLI::Range(1, 1 << 30).description(""))
        ->type_name("N");
    render
        ->add_option("--time", c.timeLimitSeconds,
                     "Stop after about so long; without --samples, whatever the scene says")
        ->check(positiveNumber())
        ->type_name("SECONDS");
    render
        ->add_option("--error", c.errorLimit,
                     "Stop when the picture's noise is below this: 0.02 is 2 %")
        ->check(positiveNumber())
        ->type_name("E");
    addSampleRange(render, "--range", c.range, "These samples alone: A to B - 1");
    render->add_flag("--resume", c.resumes, "Go on from the part file, if there is one");
    render->add_flag("--restart", c.restarts, "Begin anew, whatever part file there is")
        ->excludes("--resume");
    render
        ->add_option("--checkpoint", c.checkpointSeconds,
                     "Write the part file so often; default: where it costs less than 1 %")
        ->check(positiveNumber())
        ->type_name("SECONDS");
    render->add_flag("--keep-part", c.keepsPart,
                     "Leave the part file of the finished picture, for more samples");
    addSeed(render, c.seed);
    addThreads(render, c.threads);
    addSize(render, c.size, "Pixels of the full frame: WIDTH,HEIGHT");
    render->add_option("--crop", c.crop, "Only this window of the full frame")
        ->delimiter(',')
        ->expected(4)
        ->check(CLI::Range(0, 32768).description(""))
        ->type_name("X,Y,W,H");
    render->add_option("--layers", c.layers, "More layers: albedo,normal,depth,position,variance")
        ->delimiter(',')
        ->check(
            CLI::IsMember({"albedo", "normal", "depth", "position", "variance"}).description(""))
        ->type_name("LIST");
    render
        ->add_option("--techniques", c.techniques,
                     "Of bdpt: only these, such as s0t2,s2t1; t1: all that connect to the lens")
        ->type_name("LIST");
    render
        ->add_option("--technique-images", c.techniqueImages,
                     "An EXR of all techniques: s2t1.R … weighted, s2t1.unweighted.R … not")
        ->type_name("FILE");
    addCamera(render, c.camera);
    addOverrides(render, c.overrides);
    const std::map<std::string, ProgressStyle> styles{{"auto", ProgressStyle::automatic},
                                                      {"bar", ProgressStyle::bar},
                                                      {"lines", ProgressStyle::lines},
                                                      {"json", ProgressStyle::json}};
    render
        ->add_option_function<std::string>(
            "--progress",
            [&c, styles](const std::string& name) {
                const auto found = styles.find(name);
                if (found == styles.end())
                    throw CLI::ValidationError(
                        "--progress",
                        fmt::format("expected auto, bar, lines or json, got \"{}\"", name));
                c.progress = found->second;
            },
            "auto, bar, lines or json (one object a line)")
        ->type_name("STYLE");
    render->add_flag_callback(
        "--quiet", [&c] { c.progress = ProgressStyle::quiet; }, "Print nothing but errors");
}

void addCheck(CLI::App& app, CheckCommand& c) {
    CLI::App* check =
        app.add_subcommand("check", "Load a scene, report what is in it, render nothing");
    check->add_option("scene", c.scene, "Scene file or bare model")->required()->type_name("FILE");
    addCamera(check, c.camera);
    addOverrides(check, c.overrides);
}

void addReplay(CLI::App& app, ReplayCommand& c) {
    CLI::App* replay = app.add_subcommand(
        "replay", "Trace one sample of a picture again and print it, vertex by vertex");
    replay->add_option("scene", c.scene, "Scene file or bare model")->required()->type_name("FILE");
    replay->add_option("--pixel", c.pixel, "Of the full frame, from its top left")
        ->delimiter(',')
        ->expected(2)
        ->required()
        ->check(CLI::Range(0, 32767).description(""))
        ->type_name("X,Y");
    replay->add_option("--sample", c.sample, "Of the pixel; the first is 0")
        ->required()
        ->check(CLI::Range(0, 1 << 30).description(""))
        ->type_name("N");
    addSeed(replay, c.seed);
    addSize(replay, c.size, "Pixels of the full frame, as they were when it was rendered");
    addCamera(replay, c.camera);
    addOverrides(replay, c.overrides);
    replay->add_flag("--json", c.asJson, "Print JSON");
}

/// The command that was given last, or the program.
const CLI::App& innermost(const CLI::App& app) {
    const std::vector<CLI::App*> given = app.get_subcommands();
    return given.empty() ? app : innermost(*given.back());
}

std::string unknownCommand(const std::string& word, const CLI::App& parent) {
    std::vector<std::string> names;
    for (const CLI::App* command : parent.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    const auto nearest = nearestName(word, names);
    return fmt::format("unknown command '{}'{}", word,
                       nearest ? fmt::format("; did you mean '{}'?", *nearest) : "");
}

/// CLI11 does not name a word that is no command, and names words too many from last to first.
std::string usageMessage(const CLI::App* app, const CLI::Error& error) {
    const std::vector<std::string> unread = app->remaining(true);
    const CLI::App& command = innermost(*app);
    const bool isTooMuch = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
    std::string message = error.what();
    if (!unread.empty() && command.get_require_subcommand_min() > 0 && !unread[0].starts_with('-'))
        message = unknownCommand(unread[0], command);
    else if (isTooMuch)
        message = fmt::format("not expected: {}", fmt::join(unread, " "));
    return CLI::FailureMessage::simple(app, CLI::Error("", message));
}

ExitCode run(int argc, char** argv) {
    CLI::App app(
        "Étendue renders scenes through real photographic lenses, by unbiased light transport.",
        "etendue");
    app.set_version_flag("--version", std::string("etendue ") + version);
    app.footer(learnMore);
    app.require_subcommand(1);
    app.failure_message(usageMessage);
    app.get_formatter()->column_width(28);
    RenderCommand render;
    render.commandLine = joinArguments(argc, argv);
    CheckCommand check;
    addRender(app, render);
    addCheck(app, check);
    ReplayCommand replay;
    addReplay(app, replay);
    std::function<ExitCode()> chosen;  // of the commands that have subcommands
    addCompareCommand(app, chosen);
    addMergeCommand(app, render.commandLine, chosen);
    addBenchCommands(app, render.commandLine, chosen);
    addLensCommands(app, chosen);
    addFarmCommands(app, chosen);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const int code = app.exit(error);
        return code == 0 ? ExitCode::success : ExitCode::usage;
    }
    if (chosen) return chosen();
    if (app.got_subcommand("replay")) return runReplay(replay);
    return app.got_subcommand("render") ? runRender(render) : runCheck(check);
}

}  // namespace
}  // namespace etendue

int main(int argc, char** argv) {
    using etendue::ExitCode, etendue::say;
    // A limit on file sizes and a reader that has gone are errors of a write, with a message, and
    // no reason to be killed in the middle of one.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    try {
        const ExitCode code = etendue::run(argc, argv);
        // A flush that failed before, CLI11's or a command's, has left no text, but the error.
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
            throw std::runtime_error("cannot write to standard output");
        return static_cast<int>(code);
    } catch (const etendue::InputError& error) {
        say(fmt::format("etendue: {}\n", error.what()));
        return static_cast<int>(error.code());
    } catch (const std::bad_alloc&) {
        say("etendue: out of memory\n");
    } catch (const std::exception& error) {
        say(fmt::format("etendue: {}\n", etendue::inPlainWords(error.what())));
    }
    return static_cast<int>(ExitCode::failure);
}
