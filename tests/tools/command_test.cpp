// The command as a user meets it: exit codes, messages and files.
#include <doctest/doctest.h>

#include <fstream>

#include "tests/support/scenes.h"
#include "tests/tools/command_outcome.h"

using namespace etendue;

namespace {

constexpr const char* smallScene =
    "[film]\nwidth = 16\nheight = 12\n[estimator]\nsamples = 2\n"
    "[[mesh]]\nshape = \"sphere\"\n[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";

}  // namespace

TEST_CASE("Command: --help teaches, --version names, no command is wrong usage") {
    const Outcome help = run("--help");
    CHECK(help.code == 0);
    CHECK(contains(help.output, "render"));
    CHECK(contains(help.output, "Examples:"));
    CHECK(run("--version").code == 0);
    CHECK(run("").code == 64);
    CHECK(run("rendr x").code == 64);
    CHECK(run("render").code == 64);
    CHECK(run("render a.toml -o b.exr --samples 0").code == 64);
}

TEST_CASE("Command: render writes the EXR and the preview, and says nothing when quiet") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("a scene ü.toml", smallScene).string();
    const std::string exr = (folder.path() / "out.exr").string(),
                      png = (folder.path() / "out.png").string();
    const Outcome outcome =
        run("render '" + scene + "' -o " + exr + " --preview " + png + " --quiet");
    CHECK(outcome.code == 0);
    CHECK(outcome.output.empty());
    CHECK(std::filesystem::file_size(exr) > 500);
    CHECK(readFile(png).substr(1, 3) == "PNG");
}

TEST_CASE("Command: the same command gives the same picture for any number of threads") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", smallScene).string();
    const auto preview = [&](const std::string& threads) {
        const std::string png = (folder.path() / ("p" + threads + ".png")).string();
        REQUIRE(run("render " + scene + " -o " + (folder.path() / "o.exr").string() +
                    " --preview " + png + " --quiet --threads " + threads)
                    .code == 0);
        return readFile(png);
    };
    const std::string one = preview("1");
    CHECK(preview("2") == one);
    CHECK(preview("8") == one);
}

TEST_CASE("Command: progress for machines is one JSON object a line") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", smallScene).string();
    const Outcome outcome =
        run("render " + scene + " -o " + (folder.path() / "o.exr").string() + " --progress json");
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.output, "\"done\":true"));
    CHECK(contains(outcome.output, "\"samples\":2"));
}

TEST_CASE("Command: bad input is 65, a missing file 66, and neither leaves a picture") {
    const TemporaryFolder folder;
    const std::string out = (folder.path() / "o.exr").string();
    const std::string bad = folder.write("bad.toml", "[film]\nwidht = 3\n").string();
    const Outcome badOutcome = run("render " + bad + " -o " + out);
    CHECK(badOutcome.code == 65);
    CHECK(contains(badOutcome.output, "bad.toml:2"));
    CHECK(contains(badOutcome.output, "width"));
    CHECK(run("render " + (folder.path() / "none.toml").string() + " -o " + out).code == 66);
    CHECK_FALSE(std::filesystem::exists(out));
}

TEST_CASE("Command: a folder that does not exist is told before rendering") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", smallScene).string();
    const Outcome outcome =
        run("render " + scene + " -o " + (folder.path() / "no/where/o.exr").string());
    CHECK(outcome.code == 66);
    CHECK(contains(outcome.output, "no such folder"));
    CHECK(run("render " + scene + " -o " + folder.path().string()).code == 65);
}

TEST_CASE("Command: crop, size and overrides reach the picture") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", smallScene).string();
    const std::string out = (folder.path() / "o.exr").string();
    CHECK(run("render " + scene + " -o " + out +
              " --size 32,24 --crop 4,4,8,8 -s estimator.max_depth=3 --quiet")
              .code == 0);
    CHECK(run("render " + scene + " -o " + out + " --crop 4,4,80,8").code == 64);
    const Outcome outcome = run("render " + scene + " -o " + out + " -s estimator.max_dept=3");
    CHECK(outcome.code == 65);
    CHECK(contains(outcome.output, "max_depth"));
}

TEST_CASE("Command: check reports what is in a scene and renders nothing") {
    const TemporaryFolder folder;
    const Outcome outcome = run("check " + folder.write("s.toml", smallScene).string());
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.output, "valid"));
    CHECK(contains(outcome.output, "triangles"));
    CHECK(run("check " + folder.write("b.toml", "[film]\nwidth = -1\n").string()).code == 65);
}

TEST_CASE(
    "Command: a time limit ends the render with success, an interrupt with 75 and a valid "
    "picture") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", smallScene).string();
    const std::string out = (folder.path() / "o.exr").string();
    CHECK(run("render " + scene + " -o " + out + " --samples 100000000 --time 0.3 --quiet").code ==
          0);
    std::filesystem::remove(out);
    const std::string interrupted = "timeout --preserve-status -s INT 1 " +
                                    std::string(ETENDUE_COMMAND) + " render " + scene + " -o " +
                                    out + " --samples 100000000 --quiet";
    CHECK(WEXITSTATUS(std::system(interrupted.c_str())) == 75);
    CHECK(std::filesystem::file_size(out) > 500);
}
