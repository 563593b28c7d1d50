// etendue farm as a user meets it; a real Slurm is met by tests/farm/slurm_test.sh.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/scenes.h"
#include "tests/tools/command_outcome.h"

using namespace etendue;

namespace {

/// A scene, a folder for its parts, and programs that stand for Slurm's: sbatch tells what it was
/// called with and numbers the jobs from 1; squeue knows of the jobs named in the file `queue`.
struct Farm {
    Farm() {
        std::filesystem::create_directories(folder / "bin");
        scene = folder.write("a scene ü.toml", ballScene);
        program("sbatch",
                "echo \"$*\" >> \"$0.calls\"; [ ! -e \"$0.broken\" ] || exit 1\n"
                "wc -l < \"$0.calls\"");
        program("squeue", "cat \"$(dirname \"$0\")/../queue\"");
        program("scontrol", "echo \"MaxArraySize            = 3\"");
    }
    void program(const std::string& name, const std::string& text) const {
        const auto file = folder.write("bin/" + name, "#!/bin/sh\n" + text + "\n");
        std::filesystem::permissions(file, std::filesystem::perms::all);
    }
    /// `how`: slurm or list; five tasks of eight samples in all.
    Outcome run(const std::string& how, const std::string& more = "") const {
        return etendue::run("farm " + how + " '" + scene.string() + "' -o '" + out().string() +
                                "' --samples 8 --task-samples 2 --size 8,6 " + more,
                            "PATH=" + (folder / "bin").string() + ":$PATH");
    }
    /// All command lines of farm list; what they say goes nowhere.
    int renderAll() const {
        const std::string line = "PATH=\"" + (folder / "bin").string() + ":$PATH\" " +
                                 ETENDUE_COMMAND + " farm list '" + scene.string() + "' -o '" +
                                 out().string() +
                                 "' --samples 8 --task-samples 2 --size 8,6 2>/dev/null | sh "
                                 "2>/dev/null";
        return std::system(line.c_str());
    }
    std::filesystem::path out() const { return folder / "öut dir"; }
    std::filesystem::path part(const std::string& range) const {
        return out() / "parts" / (range + ".part.exr");
    }
    std::string calls() const { return readFile(folder / "bin/sbatch.calls"); }

    TemporaryFolder folder;
    std::filesystem::path scene;
};

auto linesOf(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace

TEST_CASE("Farm: what is listed renders the picture of one render, and then nothing is missing" *
          doctest::test_suite("slow")) {
    const Farm farm;
    const Outcome all = farm.run("list");
    CHECK(all.code == 0);
    CHECK(linesOf(all.output) == 1 + 4 + 1);
    CHECK(contains(all.output, "4 tasks, of 2 samples each\n"));
    CHECK(contains(all.output, "--range 6:8 "));
    REQUIRE(farm.renderAll() == 0);
    const Outcome none = farm.run("list");
    CHECK(none.code == 0);
    CHECK(contains(none.output, "all 4 tasks are rendered: only the merge is left\n# then "));
    const std::string merge = none.output.substr(none.output.find("# then ") + 7);
    REQUIRE(std::system(("exec 2>&1 >/dev/null; " + merge).c_str()) == 0);
    const std::string whole = (farm.folder / "whole.exr").string();
    REQUIRE(etendue::run("render '" + farm.scene.string() + "' -o " + whole +
                         " --samples 8 --size 8,6 --quiet")
                .code == 0);
    const Outcome same = etendue::run("compare '" + (farm.out() / "picture.exr").string() + "' " +
                                      whole + " --max-relmse 0 --max-mean-error 0");
    CHECK_MESSAGE(same.code == 0, same.output);
}

TEST_CASE("Farm: tasks that are missing, damaged or incomplete are told, and the others left out" *
          doctest::test_suite("slow")) {
    const Farm farm;
    REQUIRE(farm.run("list").code == 0);
    REQUIRE(farm.renderAll() == 0);
    std::filesystem::remove(farm.part("2-4"));
    // A part that has too few of its samples: another task's, say.
    REQUIRE(etendue::run("render '" + farm.scene.string() + "' -o '" + farm.part("4-6").string() +
                         "x.part.exr' --range 4:5 --size 8,6 --quiet")
                .code == 0);
    std::filesystem::rename(farm.part("4-6").string() + "x.part.exr", farm.part("4-6"));
    std::string bytes = readFile(farm.part("6-8"));
    bytes[bytes.size() / 2] ^= 1;
    writeFile(farm.part("6-8"), bytes);
    const Outcome rest = farm.run("list");
    CHECK(rest.code == 0);
    CHECK(contains(rest.output, farm.part("6-8").string() + ": "));
    CHECK(contains(rest.output, "3 of 4 tasks are missing or incomplete: 1-3\n"));
    CHECK(!contains(rest.output, "--range 0:2 "));
    REQUIRE(farm.renderAll() == 0);
    CHECK(contains(farm.run("list").output, "all 4 tasks are rendered"));
}

TEST_CASE("Farm: a folder of another picture is refused, with the setting that differs" *
          doctest::test_suite("slow")) {
    const Farm farm;
    REQUIRE(farm.run("list").code == 0);
    const auto camera = farm.folder.write("camera.toml", "[camera]\nfov = 30\n").string();
    const std::string samples = " --samples 8", each = " --task-samples 2", size = " --size 8,6";
    const std::vector<std::pair<std::string, const char*>> cases{
        {" --samples 9" + each + size, "samples: the parts here are of \"8\", not of \"9\""},
        {samples + " --task-samples 4" + size, "task_samples: "},
        {samples + each + " --size 8,7", "size: the parts here are of [\"8\", \"6\"], not"},
        {samples + each + size + " --seed 1", "seed: "},
        {samples + each + size + " -s camera.fov=31", "set: the parts here are of [], not"},
        {samples + each + size + " --camera " + camera, "camera: "}};
    for (const auto& other : cases) {
        CAPTURE(other.second);
        const Outcome outcome = etendue::run("farm list '" + farm.scene.string() + "' -o '" +
                                             farm.out().string() + "'" + other.first);
        CHECK(outcome.code == 65);
        CHECK(contains(outcome.output, "farm.toml:"));
        CHECK_MESSAGE(contains(outcome.output, other.second), outcome.output);
    }
    CHECK(farm.run("list", "--threads 2 --checkpoint 1").code == 0);
    farm.folder.write("a scene ü.toml", std::string(ballScene) + "# edited\n");
    CHECK(contains(farm.run("list").output, "scene_hash: "));
}

TEST_CASE("Farm: bad input is an error before anything is written or queued" *
          doctest::test_suite("slow")) {
    const Farm farm;
    CHECK(farm.run("slurm", "--submit -s camera.fow=3").code == 65);
    CHECK(etendue::run("farm list no.toml -o x --samples 8 --task-samples 2").code == 66);
    for (const char* options : {"--threads 0", "--checkpoint 0", "--time soon", "--picture x.png",
                                "--partition 'a\nb'", "-s 'a=\"\n\"'"}) {
        CAPTURE(options);
        CHECK(farm.run("slurm", options).code == 64);
    }
    const std::string scene = "'" + farm.scene.string() + "'";
    CHECK(etendue::run("farm list " + scene + " -o x --samples 100000 --task-samples 1").code ==
          64);
    CHECK(etendue::run("farm slurm " + scene + " -o 'x\\y' --samples 8 --task-samples 2").code ==
          64);
    CHECK(etendue::run("farm").code == 64);
    CHECK_FALSE(std::filesystem::exists(farm.out()));
    CHECK_FALSE(std::filesystem::exists("x"));
    CHECK(farm.calls().empty());
}

TEST_CASE("Farm: without --submit the scripts are written and the lines that submit them printed") {
    const Farm farm;
    const Outcome outcome = farm.run("slurm", "--time 1:00:00");
    CHECK(outcome.code == 0);
    const std::string out = farm.out().string();
    CHECK(outcome.output ==
          "4 tasks, of 2 samples each\n"
          "array1=$(sbatch --parsable --array=0-2 '" +
              out + "/render.sbatch' 0)\n" + "array2=$(sbatch --parsable --array=0 '" + out +
              "/render.sbatch' 3)\n" + "sbatch --parsable --dependency=afterany:$array1:$array2 '" +
              out + "/merge.sbatch'\n");
    CHECK(contains(readFile(farm.out() / "render.sbatch"), "#SBATCH --time=\"1:00:00\"\n"));
    CHECK(std::filesystem::is_directory(farm.out() / "logs"));
    CHECK(farm.calls().empty());
}

TEST_CASE(
    "Farm: --submit queues the arrays and, after them, the merge, and never twice at a time") {
    const Farm farm;
    const Outcome outcome = farm.run("slurm", "--submit");
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.output, "array 1\narray 2\nmerge 3\n"));
    const std::string out = farm.out().string();
    const std::string calls = "--parsable --array=0-2 " + out + "/render.sbatch 0\n" +
                              "--parsable --array=0 " + out + "/render.sbatch 3\n" +
                              "--parsable --dependency=afterany:1:2 " + out + "/merge.sbatch\n";
    CHECK(farm.calls() == calls);
    farm.folder.write("queue", "1_0 all\n");
    const Outcome again = farm.run("slurm", "--submit");
    CHECK(again.code == 1);
    CHECK(contains(again.output, "is still in the queue"));
    CHECK(contains(again.output, "1_0 all"));
    CHECK(farm.calls() == calls);
    farm.folder.write("queue", "");
    CHECK(farm.run("slurm", "--submit").code == 0);
    CHECK(farm.calls() != calls);
}

TEST_CASE("Farm: when sbatch fails, so does the command, with the line that failed") {
    const Farm farm;
    farm.folder.write("bin/sbatch.broken", "");
    const Outcome outcome = farm.run("slurm", "--submit");
    CHECK(outcome.code == 1);
    CHECK(contains(outcome.output, "sbatch --parsable --array=0-2"));
    CHECK(linesOf(farm.calls()) == 1);
}

TEST_CASE(
    "Farm: what nobody can read is an error, and no reason to leave jobs without their merge") {
    const Farm farm;
    const Outcome list = farm.run("list", "2>&1 > /dev/full");
    CHECK(list.code == 1);
    CHECK(contains(list.output, "cannot write to standard output"));
    const Outcome submitted = farm.run("slurm", "--submit 2>&1 > /dev/full");
    CHECK(submitted.code == 1);
    CHECK(contains(submitted.output, "cannot write to standard output"));
    CHECK(linesOf(farm.calls()) == 3);
}

TEST_CASE("Farm: a file in the place of its folder is an error before a lens is fitted") {
    const Farm farm;
    writeFile(farm.out(), "a picture");
    const Outcome outcome = farm.run("list", "--camera no.toml");
    CHECK(outcome.code == 65);
    CHECK(contains(outcome.output, farm.out().string() + ": is a file, expected a folder\n"));
    CHECK(readFile(farm.out()) == "a picture");
}
