// The command as a user meets it: exit codes, messages and files.
#include <doctest/doctest.h>

#include <fstream>
#include <string>
#include <utility>

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
}

TEST_CASE("Command: words that are no command, or too many, are named as they were given") {
    const auto says = [](const std::string& arguments, const std::string& message) {
        const Outcome outcome = run(arguments);
        CAPTURE(outcome.output);
        CHECK(outcome.code == 64);
        CHECK(contains(outcome.output, message + "\n"));
    };
    says("rendr a.toml -o x.exr", "unknown command 'rendr'; did you mean 'render'?");
    says("lens inof tessar-100mm", "unknown command 'inof'; did you mean 'info'?");
    says("quux", "unknown command 'quux'");
    says("check a.toml --threads 1", "not expected: --threads 1");
}

TEST_CASE("Command: an option that makes no sense is wrong usage, in one clear line" *
          doctest::test_suite("slow")) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", smallScene).string();
    const std::string out = (folder.path() / "o.exr").string();
    const std::vector<std::pair<const char*, const char*>> cases{
        {"--samples 0", "--samples"},
        {"--samples 1.5", "--samples"},
        {"--threads 0", "--threads"},
        {"--seed -1", "expected a whole number"},
        {"--seed 18446744073709551616", "expected a whole number"},
        {"--seed 3x", "expected a whole number"},
        {"--time 0", "expected a number above 0"},
        {"--time nan", "expected a number above 0"},
        {"--time -1", "expected a number above 0"},
        {"--exposure nan", "expected a number from -100 to 100"},
        {"--progress loud", "expected auto, bar, lines or json"},
        {"--layers depht", "depht"},
        {"--size 64", "--size"},
        {"--crop 0,0,0,0", "--crop"},
        {"--preview p.jpg", "written as png"},
        {"-o p.png", "-o"},
    };
    for (const auto& bad : cases) {
        CAPTURE(bad.first);
        const Outcome outcome = run("render " + scene + " -o " + out + " " + bad.first);
        CHECK(outcome.code == 64);
        CHECK(contains(outcome.output, bad.second));
        CHECK_FALSE(std::filesystem::exists(out));
    }
    CHECK(run("render " + scene + " -o " + (folder.path() / "o.png").string()).code == 64);
    CHECK(run("render " + scene + " -o " + out + " --quiet --seed 18446744073709551615").code == 0);
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
    // The end is told once.
    const std::size_t first = outcome.output.find("\"samples\":2,");
    CHECK(outcome.output.find("\"samples\":2,", first + 1) == std::string::npos);
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

TEST_CASE("Command: --estimator overrides the scene's, beside other overrides") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", smallScene).string();
    const std::string overrides = " --estimator lt -s film.width=20 -s film.height=10";
    const Outcome outcome = run("check " + scene + overrides);
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.output, "20 × 10"));
    CHECK(contains(outcome.output, " lt"));
    const Outcome unknown = run("check " + scene + " --estimator bpt");
    CHECK(unknown.code == 65);
    CHECK(contains(unknown.output, "estimator.kind"));
    CHECK(contains(unknown.output, "\"bdpt\""));
}

TEST_CASE("Command: check reports what is in a scene and renders nothing") {
    const TemporaryFolder folder;
    const Outcome outcome = run("check " + folder.write("s.toml", smallScene).string());
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.output, "valid"));
    CHECK(contains(outcome.output, "triangles"));
    CHECK(run("check " + folder.write("b.toml", "[film]\nwidth = -1\n").string()).code == 65);
}

TEST_CASE("Command: a time limit ends the render with success") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", smallScene).string();
    const std::string out = (folder.path() / "o.exr").string();
    CHECK(run("render " + scene + " -o " + out + " --samples 100000000 --time 0.3 --quiet").code ==
          0);
}

TEST_CASE("Command: a signal ends the render with 75 and a valid picture") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", smallScene).string();
    const std::pair<std::string, std::string> cases[] = {{"INT", "--samples 100000000"},
                                                         {"TERM", "--time 1000"}};
    for (const auto& [signal, limit] : cases) {
        const std::string out = (folder.path() / (signal + ".exr")).string();
        const std::string progress = (folder.path() / (signal + ".txt")).string();
        // Sent as soon as the render has begun to report.
        const std::string line = "render " + scene + " -o " + out + " " + limit +
                                 " --progress json 2> " + progress + " & pid=$!; until [ -s " +
                                 progress + " ]; do sleep 0.02; done; kill -" + signal +
                                 " $pid; wait $pid";
        CHECK(run(line).code == 75);
        CHECK(contains(readFile(progress), "stopped early"));
        CHECK(contains(readFile(progress), " of 100000000 samples") == (signal == "INT"));
        CHECK(std::filesystem::file_size(out) > 500);
    }
}

TEST_CASE("Command: a limit on file sizes is an error that leaves no part of a picture") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", smallScene).string();
    // 128 × 96 pixels of noise, 12 bytes each, do not fit into two blocks of 512.
    const Outcome outcome = run(
        "render " + scene + " --size 128,96 -o " + (folder.path() / "o.exr").string() + " --quiet",
        "ulimit -f 2; ");
    CHECK(outcome.code == 1);
    CHECK(contains(outcome.output, "o.exr: cannot write: File too large"));
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        CHECK(entry.path().filename() == "s.toml");
}

TEST_CASE("Command: a reader that goes away is an error, not a kill") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", smallScene).string();
    const std::string code = (folder.path() / "code").string();
    // The reader has gone before the command begins to write.
    const std::string line = "( sleep 0.3; " + std::string(ETENDUE_COMMAND) + " check " + scene +
                             " 2>/dev/null; echo $? > " + code + " ) | true";
    REQUIRE(std::system(line.c_str()) == 0);
    CHECK(readFile(code) == "1\n");
    for (const std::string& arguments : {"check " + scene, std::string("--version")}) {
        const Outcome full = run(arguments + " 2>&1 > /dev/full");
        CHECK(full.code == 1);
        CHECK(full.output == "etendue: cannot write to standard output\n");
    }
    // Progress that nobody can read costs no picture.
    const std::string render = std::string(ETENDUE_COMMAND) + " render " + scene + " -o " +
                               (folder.path() / "o.exr").string() + " --progress json";
    CHECK(WEXITSTATUS(std::system((render + " 2> /dev/full").c_str())) == 0);
    CHECK(std::filesystem::file_size(folder.path() / "o.exr") > 500);
}
