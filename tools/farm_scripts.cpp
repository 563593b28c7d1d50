#include "tools/farm_scripts.h"

#include <fmt/format.h>

#include "renderer/part_file.h"

namespace etendue {

namespace {

bool isPlain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_@%+=:,./-").find(c) != std::string_view::npos;
}

/// "etendue render SCENE …" but for the task's range and part.
std::string renderLine(const FarmJob& job) {
    std::vector<std::string> words{job.program.string(), "render", job.scene.string()};
    const auto add = [&](const char* option, const std::string& value) {
        words.insert(words.end(), {option, value});
    };
    // A range has its own; these tell a lens how many terms it is worth.
    add("--samples", std::to_string(job.plan.samples));
    add("--seed", std::to_string(job.seed));
    if (!job.size.empty()) add("--size", fmt::format("{},{}", job.size[0], job.size[1]));
    if (!job.camera.empty()) add("--camera", job.camera.string());
    for (const std::string& override : job.overrides) add("-s", override);
    add("--threads", std::to_string(job.threads));
    if (job.checkpointSeconds) add("--checkpoint", fmt::format("{}", *job.checkpointSeconds));
    words.emplace_back("--resume");
    std::string line;
    for (const std::string& word : words) line += (line.empty() ? "" : " ") + shellQuoted(word);
    return line;
}

/// "etendue merge -o PICTURE --require 0:N" but for the parts. A picture by the name of a part is
/// made anew, too, each time.
std::string mergeStart(const FarmJob& job) {
    return fmt::format("{} merge -o {} --require 0:{}{}", shellQuoted(job.program.string()),
                       shellQuoted(job.picture.string()), job.plan.samples,
                       isPartFile(job.picture) ? " --restart" : "");
}

/// Slurm replaces %A and the like in the whole path of a log.
std::string logPattern(const FarmJob& job, const char* name) {
    std::string pattern;
    for (const char c : (job.logs() / "").string()) pattern += c == '%' ? "%%" : std::string(1, c);
    return sbatchQuoted(pattern + name);
}

std::string scriptHead(const FarmJob& job, const SlurmOptions& slurm, const char* comment,
                       const char* name, const char* log, int processors) {
    std::string text = fmt::format("#!/bin/bash\n# {} Written by etendue farm slurm.\n", comment);
    const auto add = [&](const std::string& option) { text += "#SBATCH " + option + "\n"; };
    add("--job-name=" + sbatchQuoted(fmt::format("{} {}", job.folder.filename().string(), name)));
    add("--chdir=" + sbatchQuoted(job.workFolder.string()));
    add("--output=" + logPattern(job, log));
    add("--open-mode=append");
    add(fmt::format("--ntasks=1 --cpus-per-task={}", processors));
    if (!slurm.time.empty()) add("--time=" + sbatchQuoted(slurm.time));
    if (!slurm.partition.empty()) add("--partition=" + sbatchQuoted(slurm.partition));
    for (const std::string& option : slurm.more) add(option);
    return text;
}

// What follows the task's numbers. A requeued task that has not got further would be requeued for
// ever.
constexpr const char* renderTail = R"sh(
echo "task $task, samples $begin:$end, on ${SLURMD_NODENAME:-$(hostname)}, restarts: ${SLURM_RESTART_COUNT:-0}"
stateOfPart() { stat -c '%i %y' "$part" 2>/dev/null; }
partBefore=$(stateOfPart)

# Slurm warns this shell by USR1 before the time limit: render is told by TERM to write its part. TERM
# itself (requeue, cancellation) Slurm sends to render, too; passed on it would be the second one, which
# ends render at once. It must not wake this shell either: Bash 5.2 then loses render's exit code.
isTimeUp=no
render=
trap 'isTimeUp=yes; [ -z "$render" ] || kill -TERM "$render"' USR1
trap '' TERM
renderTask &
render=$!
[ $isTimeUp = no ] || kill -TERM "$render"
while kill -0 "$render" 2>/dev/null; do wait "$render"; done
wait "$render"
code=$?

# 143: it was told before it had begun to heed signals.
if [ $isTimeUp = yes ] && { [ $code = 75 ] || [ $code = 143 ]; }; then
    if [ "$(stateOfPart)" = "$partBefore" ]; then
        echo "task $task: the time limit is too short to render anything" >&2
    else
        echo "task $task: the time is up; it goes on when it is its turn again" >&2
        # One element alone has the array's SLURM_JOB_ID, by which all of them would be requeued.
        scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
    fi
fi
exit $code
)sh";

}  // namespace

std::string shellQuoted(std::string_view word) {
    bool isPlainWord = !word.empty();
    for (const char c : word) isPlainWord = isPlainWord && isPlain(c);
    if (isPlainWord) return std::string(word);
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    return quoted + "'";
}

std::string sbatchQuoted(std::string_view value) {
    std::string quoted = "\"";
    for (const char c : value) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + '"';
}

std::string taskLine(const FarmJob& job, std::uint32_t task) {
    std::string start = "env ";
    // Only then does it matter where the command is run.
    if (!job.overrides.empty())
        start += fmt::format("-C {} ", shellQuoted(job.workFolder.string()));
    const SampleRange range = job.plan.rangeOf(task);
    return fmt::format("{}{} {} --range {}:{} -o {}", start,
                       shellQuoted("XDG_CACHE_HOME=" + job.cache().string()), renderLine(job),
                       range.begin, range.end,
                       shellQuoted((job.parts() / job.plan.partOf(task)).string()));
}

std::string mergeLine(const FarmJob& job) {
    return fmt::format("{} {}/*.part.exr", mergeStart(job), shellQuoted(job.parts().string()));
}

std::string renderScript(const FarmJob& job, const SlurmOptions& slurm) {
    std::string text = scriptHead(
        job, slurm, "One task of a picture: sbatch --array=NUMBERS render.sbatch [FIRST TASK].",
        "render", "%A_%a.log", job.threads);
    text += "#SBATCH --requeue\n#SBATCH --signal=B:USR1@60\n";
    text += fmt::format(
        "\ntask=$((${{SLURM_ARRAY_TASK_ID:?render.sbatch is for sbatch --array}} + ${{1:-0}}))\n"
        "begin=$((task * {1}))\n"
        "end=$((begin + {1} < {0} ? begin + {1} : {0}))\n"
        "part={2}/$begin-$end.part.exr\n"
        "export XDG_CACHE_HOME={3}\n"
        "renderTask() {{\n    trap - TERM\n    exec {4} --range \"$begin:$end\" -o \"$part\"\n}}\n",
        job.plan.samples, job.plan.taskSamples, shellQuoted(job.parts().string()),
        shellQuoted(job.cache().string()), renderLine(job));
    return text + renderTail;
}

std::string mergeScript(const FarmJob& job, const SlurmOptions& slurm) {
    return scriptHead(job, slurm, "Merges the parts that there are.", "merge", "merge-%j.log", 1) +
           fmt::format(
               "\nparts=({}/*.part.exr)\n"
               "if [ ! -e \"${{parts[0]}}\" ]; then\n"
               "    echo \"not one part is there: hole 0:{}\" >&2\n"
               "    exit 75\n"
               "fi\n"
               "exec {} \"${{parts[@]}}\"\n",
               shellQuoted(job.parts().string()), job.plan.samples, mergeStart(job));
}

std::string submitLine(const FarmJob& job, const TaskArray& array) {
    return fmt::format("sbatch --parsable --array={} {} {}", numbersText(array.elements),
                       shellQuoted(job.renderScript().string()), array.firstTask);
}

std::string submitMergeLine(const FarmJob& job, const std::vector<std::string>& ids) {
    std::string dependency;
    for (const std::string& id : ids)
        dependency += (dependency.empty() ? "--dependency=afterany:" : ":") + id;
    if (!dependency.empty()) dependency += ' ';
    return fmt::format("sbatch --parsable {}{}", dependency,
                       shellQuoted(job.mergeScript().string()));
}

}  // namespace etendue
