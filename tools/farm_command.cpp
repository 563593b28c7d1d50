#include "tools/farm_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "lens/fit_cache.h"
#include "renderer/parallel.h"
#include "renderer/scene_loader.h"
#include "tools/farm_folder.h"
#include "tools/farm_queue.h"
#include "tools/json.h"
#include "tools/progress.h"
#include "tools/scene_names.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// A name ends its line in a script or in a list of commands.
void checkNames(const FarmCommand& command) {
    std::vector<std::string> names = command.overrides;
    names.push_back(command.slurm.partition);
    names.insert(names.end(), command.slurm.more.begin(), command.slurm.more.end());
    for (const fs::path& path :
         {command.scene, command.camera, command.folder, command.picture, fs::current_path()})
        names.push_back(path.string());
    for (const std::string& name : names)
        if (name.find_first_of("\n\r") != std::string::npos)
            throw InputError("a name with a line break in it cannot be sent to other machines: " +
                                 Json(name).text(),
                             ExitCode::usage);
}

/// "out/" and "out/." have no name of their own.
fs::path withoutTail(fs::path folder) {
    while (folder.has_relative_path() && (folder.filename() == "." || !folder.has_filename()))
        folder = folder.parent_path();
    return folder;
}

FarmJob jobFor(const FarmCommand& command) {
    checkFarmPlan(command.plan);
    checkNames(command);
    if (command.picture.extension() != ".exr")
        throw InputError(fmt::format("--picture {}: is written as exr", command.picture.string()),
                         ExitCode::usage);
    FarmJob job;
    job.plan = command.plan;
    job.program = fs::read_symlink("/proc/self/exe");
    job.scene = fs::absolute(command.scene);
    if (!command.camera.empty()) job.camera = fs::absolute(command.camera);
    job.folder = withoutTail(fs::absolute(command.folder));
    job.picture = job.folder / command.picture;
    job.workFolder = fs::current_path();
    job.overrides = command.overrides;
    job.size = command.size;
    job.seed = command.seed;
    job.threads = command.threads;
    job.checkpointSeconds = command.checkpointSeconds;
    return job;
}

/// The scene's hash. Loading finds what is wrong before anything is queued, and leaves in the
/// folder the lens's fit, which all tasks then have in common.
std::string loadedHash(const FarmJob& job) {
    LoadOptions options{job.overrides, hardwareThreads(), fitCacheIn(job.cache())};
    options.camera = job.camera;
    options.samples = static_cast<int>(job.plan.samples);
    if (!job.size.empty()) options.setSize(job.size[0], job.size[1]);
    const LoadedScene loaded = loadShowingFit(job.scene, std::move(options));
    for (const std::string& note : loaded.notes) say(fmt::format("note: {}\n", note));
    return loaded.hash;
}

struct Farm {
    FarmJob job;
    std::vector<std::uint32_t> missing;
};

/// Ready but for its scripts.
Farm prepareFarm(const FarmCommand& command) {
    Farm farm{jobFor(command), {}};
    checkFolder(farm.job.folder);  // before a lens is fitted
    claimFarmFolder(farm.job, loadedHash(farm.job));
    farm.missing = missingTasks(
        farm.job, [](const std::string& sentence) { say(fmt::format("etendue: {}\n", sentence)); });
    const std::uint32_t all = farm.job.plan.taskCount();
    if (farm.missing.empty())
        say(fmt::format("all {} tasks are rendered: only the merge is left\n", all));
    else if (farm.missing.size() == all)
        say(fmt::format("{} tasks, of {} samples each\n", all, farm.job.plan.taskSamples));
    else
        say(fmt::format("{} of {} tasks are missing or incomplete: {}\n", farm.missing.size(), all,
                        numbersText(farm.missing)));
    return farm;
}

std::vector<TaskArray> arraysFor(const Farm& farm) {
    const std::uint32_t limit = slurmArrayLimit();
    if (limit == 0)
        throw InputError("this Slurm has job arrays switched off (MaxArraySize): use farm list");
    return taskArrays(farm.missing, std::min(limit, mostArrayElements));
}

/// The ids of what was submitted last, so that it is not submitted twice.
std::vector<std::string> readJobIds(const fs::path& file) {
    std::ifstream stream(file);
    std::vector<std::string> ids;
    for (std::string id; stream >> id;) ids.push_back(id);
    return ids;
}

void checkNotQueued(const fs::path& folder) {
    const std::string queued = queuedJobs(readJobIds(folder / "jobs"));
    if (!queued.empty())
        throw std::runtime_error(
            fmt::format("{}: what was submitted before is still in the queue; wait for it or "
                        "cancel it (scancel)\n{}",
                        folder.string(), queued));
}

void submitAll(const FarmJob& job, const std::vector<TaskArray>& arrays) {
    std::vector<std::string> ids;
    std::string known;
    const auto keep = [&](const std::string& id) {
        known += id + "\n";
        writeWholeFile(job.folder / "jobs", known);
    };
    for (const TaskArray& array : arrays) {
        ids.push_back(submit(submitLine(job, array)));
        keep(ids.back());
        fmt::print("array {}\n", ids.back());
        std::fflush(stdout);
    }
    const std::string merge = submit(submitMergeLine(job, ids));
    keep(merge);
    fmt::print("merge {}\n", merge);
}

void printSubmission(const FarmJob& job, const std::vector<TaskArray>& arrays) {
    std::vector<std::string> variables;
    for (const TaskArray& array : arrays) {
        const std::string number = std::to_string(variables.size() + 1);
        fmt::print("array{}=$({})\n", number, submitLine(job, array));
        variables.push_back("$array" + number);
    }
    fmt::print("{}\n", submitMergeLine(job, variables));
}

}  // namespace

ExitCode runFarmSlurm(const FarmCommand& command) {
    if (fs::absolute(command.folder).string().find('\\') != std::string::npos)
        throw InputError("-o: Slurm writes no logs to a folder with \\ in its name",
                         ExitCode::usage);
    if (command.submits) checkNotQueued(command.folder);
    const Farm farm = prepareFarm(command);
    const FarmJob& job = farm.job;
    const std::vector<TaskArray> arrays = arraysFor(farm);
    writeWholeFile(job.renderScript(), renderScript(job, command.slurm));
    writeWholeFile(job.mergeScript(), mergeScript(job, command.slurm));
    if (command.submits)
        submitAll(job, arrays);
    else
        printSubmission(job, arrays);
    return ExitCode::success;
}

ExitCode runFarmList(const FarmCommand& command) {
    const Farm farm = prepareFarm(command);
    for (const std::uint32_t task : farm.missing) fmt::print("{}\n", taskLine(farm.job, task));
    std::fflush(stdout);
    say(fmt::format("# then {}\n", mergeLine(farm.job)));
    return ExitCode::success;
}

}  // namespace etendue
