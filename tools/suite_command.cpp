#include "tools/suite_command.h"

#include <fmt/format.h>

#include "renderer/estimator.h"
#include "renderer/output_lock.h"
#include "renderer/parallel.h"
#include "tools/bench_report.h"
#include "tools/bench_run.h"
#include "tools/bench_summary.h"
#include "tools/progress.h"
#include "tools/stop_request.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

bool isSuiteFile(const std::string& input) {
    const std::filesystem::path path = input;
    if (path.extension() != ".toml") return false;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw missingFileError(path);
    return Config::load(path).root().has("suite");
}

BenchSuite suiteOfScenes(const SuiteCommand& command) {
    BenchSuite suite;
    suite.title = command.inputs.size() == 1 ? command.inputs.front() : "scenes";
    const std::vector<std::string> cameras =
        command.cameras.empty() ? std::vector<std::string>{"own"} : command.cameras;
    for (const NamedFile& scene : scenesCalled(command.inputs, command.folder))
        for (const std::string& camera : cameras) {
            const BenchView view{
                scene,
                cameraCalled(camera, command.folder),
                {},
                {BenchVariant{}},
                command.estimators.empty() ? estimatorKinds() : command.estimators};
            if (const auto clash = nameClash(suite, view))
                throw InputError(*clash, ExitCode::usage);
            suite.views.push_back(view);
        }
    return suite;
}

BenchSuite suiteFor(const SuiteCommand& command) {
    const bool isSuite = !command.inputs.empty() && isSuiteFile(command.inputs.front());
    if (isSuite && command.inputs.size() > 1)
        throw InputError(fmt::format("{}: a suite is run by itself", command.inputs.front()),
                         ExitCode::usage);
    if (isSuite && !(command.cameras.empty() && command.estimators.empty()))
        throw InputError("--cameras and --estimators: the suite's file has them", ExitCode::usage);
    BenchSuite suite = isSuite ? loadBenchSuite(command.inputs.front()) : suiteOfScenes(command);
    if (command.seconds) suite.seconds = *command.seconds;
    if (command.referenceSeconds) suite.referenceSeconds = *command.referenceSeconds;
    if (command.targetRelMse) suite.targetRelMse = *command.targetRelMse;
    if (command.seeds) suite.seeds = *command.seeds;
    if (!command.size.empty()) {
        suite.width = command.size[0];
        suite.height = command.size[1];
    }
    return suite;
}

}  // namespace

ExitCode runSuite(const SuiteCommand& command) {
    const BenchSuite suite = suiteFor(command);
    const BenchFolder folder{command.output};
    makeFolder(folder.path);
    const OutputLock lock(folder.records());
    heedStopRequests();
    const bool isComplete =
        runBench(suite, {command.commandLine, command.threads.value_or(hardwareThreads())}, folder);
    const BenchRecords records = readBenchRecords(folder.records());
    if (!records.header) {
        say("stopped early: nothing has been measured\n");
        return ExitCode::stoppedEarly;
    }
    const std::vector<BenchResult> results = summarizeBench(records, suite.targetRelMse);
    fmt::print("{}", benchText(results, records, suite.targetRelMse));
    writeWholeFile(folder.path / "results.csv", csvOf(records.runs));
    writeWholeFile(folder.path / "report.html",
                   benchReport(suite, records, results, folder, isComplete));
    say(fmt::format("{} has the report\n", (folder.path / "report.html").string()));
    if (!isComplete) say("stopped early: the same command goes on where it stopped\n");
    std::uint64_t bad = 0;
    for (const BenchResult& result : results) bad += result.badSamples;
    if (!isComplete) return ExitCode::stoppedEarly;
    return bad > 0 ? ExitCode::failure : ExitCode::success;
}

}  // namespace etendue
