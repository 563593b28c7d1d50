// Command lines and scripts for other machines, run by the shell.
#include "tools/farm_scripts.h"

#include <doctest/doctest.h>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command_outcome.h"

using namespace etendue;

namespace {

/// A job whose names are as awkward as names may be, and whose program is a script.
struct AwkwardFarm {
    explicit AwkwardFarm(const std::string& program = "printf '<%s>' \"$XDG_CACHE_HOME\" \"$@\"") {
        job.folder = temporary / "o ü 'b\" $x # %j";
        std::filesystem::create_directories(job.parts());
        std::filesystem::create_directories(temporary / "bin");
        job.program = temporary.write("a program.sh", "#!/bin/bash\n" + program + "\n");
        std::filesystem::permissions(job.program, std::filesystem::perms::all);
        job.plan = {100, 30};
        job.scene = "/scenes/it's `a` scéne.toml";
        job.camera = "/cameras/a\\b.toml";
        job.picture = job.folder / "picture.exr";
        job.workFolder = temporary.path();
        job.overrides = {"estimator.kind=\"bdpt\"", "camera.from=[0, 1, 2]"};
        job.size = {64, 48};
        job.seed = 18446744073709551615u;
        job.threads = 3;
        job.checkpointSeconds = 0.5;
        temporary.write("render.sbatch", renderScript(job, {}));
        temporary.write("merge.sbatch", mergeScript(job, {}));
    }
    std::string in(const std::string& script) const {
        return "bash " + shellQuoted((temporary / script).string());
    }
    /// What the program hears when it renders.
    std::string renderWords() const {
        return "<" + job.cache().string() + "><render><" + job.scene.string() +
               "><--samples><100><--seed><18446744073709551615><--size><64,48><--camera><" +
               job.camera.string() +
               "><-s><estimator.kind=\"bdpt\"><-s><camera.from=[0, 1, 2]><--threads><3>"
               "<--checkpoint><0.5><--resume>";
    }
    std::string part(const std::string& name) const { return (job.parts() / name).string(); }

    TemporaryFolder temporary;
    FarmJob job;
};

}  // namespace

TEST_CASE("Farm scripts: a quoted word reaches the command as it was, whatever is in it") {
    for (const std::string word :
         {"plain", "",     "a b",   "ü",   "it's", "''",       "a\"b", "$HOME",
          "`id`",  "a\\b", "\\",    "*",   "~",    "a;b",      "a\nb", "-x",
          "#x",    "!x",   "{a,b}", "a=b", "(x)",  "\xff\xfe", "100%"}) {
        CAPTURE(word);
        CHECK(shell("printf '%s|' " + shellQuoted(word)).output == word + "|");
        CHECK(shell("bash -c " + shellQuoted("printf '%s|' " + shellQuoted(word))).output ==
              word + "|");
    }
    CHECK(shellQuoted("/plain/path-1.exr") == "/plain/path-1.exr");
    CHECK(sbatchQuoted("a \"b\" \\ 'c' # ü") == R"("a \"b\" \\ 'c' # ü")");
}

TEST_CASE("Farm scripts: a task's line is a command by itself, wherever it is run") {
    const AwkwardFarm farm;
    const Outcome last = shell("cd / && " + taskLine(farm.job, 3));
    CHECK(last.code == 0);
    CHECK(last.output ==
          farm.renderWords() + "<--range><90:100><-o><" + farm.part("90-100.part.exr") + ">");
    CHECK(contains(taskLine(farm.job, 3), "-C " + farm.job.workFolder.string()));
    FarmJob job = farm.job;
    job.overrides.clear();
    CHECK(!contains(taskLine(job, 3), "-C "));
}

TEST_CASE("Farm scripts: an array's element renders its task's range") {
    const AwkwardFarm farm;
    const auto element = [&](const std::string& number, const std::string& first) {
        return shell("SLURM_ARRAY_TASK_ID=" + number + " " + farm.in("render.sbatch") + " " +
                     first);
    };
    const std::string lastRange = "<--range><90:100><-o><" + farm.part("90-100.part.exr") + ">";
    const Outcome first = element("0", "");
    CHECK(first.code == 0);
    CHECK(contains(first.output, "task 0, samples 0:30, on "));
    CHECK(contains(first.output,
                   farm.renderWords() + "<--range><0:30><-o><" + farm.part("0-30.part.exr") + ">"));
    CHECK(contains(element("3", "").output, farm.renderWords() + lastRange));
    CHECK(contains(element("1", "2").output, farm.renderWords() + lastRange));
    // The shell names parts as the plan does.
    for (std::uint32_t task = 0; task < farm.job.plan.taskCount(); ++task)
        CHECK(contains(element(std::to_string(task), "0").output, farm.job.plan.partOf(task)));
    const Outcome alone = shell("unset SLURM_ARRAY_TASK_ID; " + farm.in("render.sbatch"));
    CHECK(alone.code != 0);
    CHECK(contains(alone.output, "render.sbatch is for sbatch --array"));
}

TEST_CASE("Farm scripts: the merge takes the parts that are there, and none is a hole by itself") {
    const AwkwardFarm farm;
    const Outcome nothing = shell(farm.in("merge.sbatch"));
    CHECK(nothing.code == 75);
    CHECK(contains(nothing.output, "hole 0:100"));
    for (const char* name :
         {"0-30.part.exr", "90-100.part.exr", "30-60.part.exr.damaged", ".x.part.exr.tmp-1"})
        writeFile(farm.part(name), "");
    const std::string words = "<merge><-o><" + farm.job.picture.string() + "><--require><0:100><" +
                              farm.part("0-30.part.exr") + "><" + farm.part("90-100.part.exr") +
                              ">";
    const Outcome two = shell(farm.in("merge.sbatch"));
    CHECK(two.code == 0);
    CHECK(contains(two.output, words));
    CHECK(contains(shell(mergeLine(farm.job)).output, words));
}

TEST_CASE("Farm scripts: a picture that is a part is made anew by each merge") {
    AwkwardFarm farm;
    CHECK_FALSE(contains(mergeLine(farm.job), "--restart"));
    farm.job.picture = farm.job.folder / "picture.part.exr";
    CHECK(contains(shell(mergeLine(farm.job)).output, "<--restart>"));
}

TEST_CASE("Farm scripts: what Slurm is told is in the scripts' heads") {
    const AwkwardFarm farm;
    const std::string script =
        renderScript(farm.job, {"02:30:00", "long", {"--mem=4G", "--account=x"}});
    for (const char* line :
         {"#!/bin/bash\n", "#SBATCH --requeue\n", "#SBATCH --open-mode=append\n",
          "#SBATCH --signal=B:USR1@60\n", "#SBATCH --ntasks=1 --cpus-per-task=3\n",
          "#SBATCH --time=\"02:30:00\"\n", "#SBATCH --partition=\"long\"\n",
          "#SBATCH --mem=4G\n#SBATCH --account=x\n",
          "#SBATCH --job-name=\"o ü 'b\\\" $x # %j render\"\n",
          "/o ü 'b\\\" $x # %%j/logs/%A_%a.log\"\n"})
        CHECK(contains(script, line));
    CHECK(contains(mergeScript(farm.job, {"", "", {"--mem=4G"}}), "#SBATCH --mem=4G\n"));
    CHECK(!contains(renderScript(farm.job, {}), "--time"));
    // sbatch heeds these lines only as long as there is no command.
    CHECK(script.rfind("#SBATCH") < script.find("\n\n"));
}

TEST_CASE("Farm scripts: the lines that submit number an array's elements from its first task") {
    const AwkwardFarm farm;
    FarmJob job = farm.job;
    job.folder = "/out dir";
    CHECK(submitLine(job, {1000, {3, 7, 8, 9}}) ==
          "sbatch --parsable --array=3,7-9 '/out dir/render.sbatch' 1000");
    CHECK(submitMergeLine(job, {"12", "13"}) ==
          "sbatch --parsable --dependency=afterany:12:13 '/out dir/merge.sbatch'");
    CHECK(submitMergeLine(job, {}) == "sbatch --parsable '/out dir/merge.sbatch'");
}

namespace {

/// Runs the render script with a program that writes its part when it gets TERM, `signals` it once
/// it runs, and appends what scontrol is asked.
Outcome signalledRun(const std::string& signals, const std::string& onTerm) {
    const AwkwardFarm farm("trap 'echo got TERM; " + onTerm +
                           "; exit 75' TERM\n"
                           "while [ \"$1\" != -o ]; do shift; done\n"
                           "part=$2\n"
                           "echo $$ > \"$(dirname \"$0\")/is running\"\n"
                           "for i in $(seq 200); do sleep 0.05; done\n");
    const std::filesystem::path scontrol =
        farm.temporary.write("bin/scontrol", "#!/bin/sh\necho \"scontrol $*\"\n");
    std::filesystem::permissions(scontrol, std::filesystem::perms::all);
    const std::string folder = shellQuoted(farm.temporary.path().string());
    return shell("cd " + folder +
                 "; export SLURM_ARRAY_TASK_ID=3 SLURM_ARRAY_JOB_ID=17 SLURM_JOB_ID=17 PATH=" +
                 folder + "/bin:$PATH; " + farm.in("render.sbatch") +
                 " & script=$!; while [ ! -s 'is running' ]; do sleep 0.02; done; " + signals +
                 "; wait $script");
}

}  // namespace

TEST_CASE("Farm scripts: at the time limit the part is written and the task requeues itself") {
    const Outcome run = signalledRun("kill -USR1 $script", "echo x > \"$part\"");
    CAPTURE(run.output);
    CHECK(run.code == 75);
    CHECK(contains(run.output, "got TERM\n"));
    CHECK(contains(run.output, "scontrol requeue 17_3\n"));
}

TEST_CASE("Farm scripts: a task that the time limit leaves without a sample is not requeued") {
    const Outcome run = signalledRun("kill -USR1 $script", ":");
    CHECK(run.code == 75);
    CHECK(contains(run.output, "the time limit is too short to render anything"));
    CHECK(!contains(run.output, "scontrol"));
}

TEST_CASE("Farm scripts: of TERM to all, as by scancel, none is passed on, and nothing requeued") {
    const Outcome run = signalledRun(
        "kill -TERM $script; sleep 0.3; echo to the render, too; kill -TERM $(cat 'is running')",
        "echo x > \"$part\"");
    CAPTURE(run.output);
    CHECK(run.code == 75);
    CHECK(contains(run.output, "to the render, too\ngot TERM\n"));
    CHECK(!contains(run.output, "scontrol"));
}
