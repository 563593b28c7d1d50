// Renders that stop, go on, and add up: the program as a user runs it.
#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "config/config.h"
#include "renderer/part_file.h"
#include "tests/tools/command_outcome.h"
#include "tests/tools/renders.h"

using namespace etendue;

namespace fs = std::filesystem;

TEST_CASE("Part: ranges add up to the render of all, bit for bit, in any order" *
          doctest::test_suite("slow")) {
    const Renders renders;
    for (const std::string kind : {"pt", "lt", "bdpt"}) {
        CAPTURE(kind);
        const std::string set = " -s estimator.kind=" + kind;
        REQUIRE(renders.render("whole.exr", "--samples 11" + set).code == 0);
        REQUIRE(renders.render("a.part.exr", "--restart --range 0:4" + set).code == 0);
        REQUIRE(renders.render("b.part.exr", "--restart --range 4:5" + set).code == 0);
        REQUIRE(renders.render("c.part.exr", "--restart --range 5:11" + set).code == 0);
        const Outcome merged =
            renders.merge({"c.part.exr", "a.part.exr", "b.part.exr"}, "m.exr", "--require 0:11");
        CAPTURE(merged.output);
        CHECK(merged.code == 0);
        CHECK(contains(merged.output, "samples 0:11, bit for bit"));
        CHECK(renders.pixels("m.exr") == renders.pixels("whole.exr"));
        for (const char* name : {"worldToCamera", "aperture", "focus", "etendue:estimator"})
            CHECK(contains(readFile(renders.path("m.exr")), name));
        // A part of parts is a part.
        REQUIRE(renders.merge({"b.part.exr", "c.part.exr"}, "bc.part.exr", "--restart").code == 0);
        REQUIRE(renders.merge({"bc.part.exr", "a.part.exr"}, "m2.exr").code == 0);
        CHECK(renders.pixels("m2.exr") == renders.pixels("whole.exr"));
    }
}

TEST_CASE("Part: a render goes on from its part to the bits of one that did not stop" *
          doctest::test_suite("slow")) {
    const Renders renders;
    for (const std::string kind : {"pt", "bdpt"}) {
        CAPTURE(kind);
        const std::string set = " -s estimator.kind=" + kind;
        REQUIRE(renders.render("whole.exr", "--samples 9" + set).code == 0);
        REQUIRE(renders.render("x.exr", "--samples 5 --keep-part" + set).code == 0);
        CHECK(readPartInfo(renders.path("x.part.exr")).ranges.text() == "0:5");
        const Outcome refused = renders.render("x.exr", "--samples 9" + set);
        CHECK(refused.code == 64);
        CHECK(contains(refused.output, "--resume goes on from them"));
        REQUIRE(renders.render("x.exr", "--samples 9 --resume" + set).code == 0);
        CHECK(renders.pixels("x.exr") == renders.pixels("whole.exr"));
        CHECK_FALSE(fs::exists(renders.path("x.part.exr")));
    }
}

TEST_CASE("Part: what does not belong together is refused, and the difference named" *
          doctest::test_suite("slow")) {
    const Renders renders;
    REQUIRE(renders.render("a.part.exr", "--range 0:2").code == 0);
    const auto refusal = [&](const std::string& options) {
        REQUIRE(renders.render("b.part.exr", "--restart " + options).code == 0);
        const Outcome outcome = renders.merge({"a.part.exr", "b.part.exr"}, "m.exr");
        CHECK(outcome.code == 65);
        CHECK_FALSE(fs::exists(renders.path("m.exr")));
        return outcome.output;
    };
    CHECK(contains(refusal("--range 1:3"), "b.part.exr: its samples 1:2 are in another part"));
    CHECK(contains(refusal("--range 2:3 --seed 7"), "seed: has 7, expected 0"));
    CHECK(contains(refusal("--range 2:3 -s estimator.max_depth=3"), "estimator.max_depth=3"));
    CHECK(contains(refusal("--range 2:3 --crop 0,0,8,8"), "window"));
    CHECK(contains(refusal("--range 2:3 --layers albedo"), "layers"));
    const Outcome resumed = renders.render("a.part.exr", "--range 0:4 --resume --seed 3");
    CHECK(resumed.code == 65);
    CHECK(contains(resumed.output, "seed: has 0, expected 3"));
}

TEST_CASE("Part: what is not finite in it is told wherever it goes") {
    const Renders renders;
    const std::string bright = " -s camera.exposure=60 -s light.0.radiance=[1e30,1e30,1e30]";
    REQUIRE(renders.render("a.part.exr", "--range 0:1" + bright).code == 0);
    REQUIRE(readPart(renders.path("a.part.exr")).state.badSamples > 0);
    const char* const told = "samples of the part";
    CHECK(contains(renders.merge({"a.part.exr"}, "m.exr").output, told));
    CHECK(contains(renders.render("a.part.exr", "--range 0:1 --resume" + bright).output, told));
}

TEST_CASE("Part: holes are named, and the picture of the rest is written") {
    const Renders renders;
    REQUIRE(renders.render("a.part.exr", "--range 1:2").code == 0);
    REQUIRE(renders.render("b.part.exr", "--range 4:6").code == 0);
    const Outcome merged =
        renders.merge({"a.part.exr", "b.part.exr"}, "m.exr",
                      "--require 0:8 --preview " + renders.path("m.png").string());
    CHECK(merged.code == 75);
    for (const char* hole : {"hole 0:1\n", "hole 2:4\n", "hole 6:8\n"})
        CHECK(contains(merged.output, hole));
    CHECK(fs::exists(renders.path("m.exr")));
    CHECK(fs::exists(renders.path("m.png")));
}

TEST_CASE("Part: a damaged one is refused by name, and the one before it is used") {
    const Renders renders;
    REQUIRE(renders.render("whole.exr", "--samples 8").code == 0);
    REQUIRE(renders.render("x.part.exr", "--range 0:2").code == 0);
    REQUIRE(renders.render("x.part.exr", "--range 0:4 --resume").code == 0);
    const fs::path part = renders.path("x.part.exr");
    CHECK(readPartInfo(previousPart(part)).ranges.text() == "0:2");
    const std::string good = readFile(part);
    const auto write = [&](const std::string& bytes) {
        std::ofstream(part, std::ios::binary) << bytes;
    };
    const auto refused = [&] {
        try {
            readPart(part);
        } catch (const InputError& error) {
            return contains(error.what(), "x.part.exr");
        }
        return false;
    };
    std::mt19937 random(11);
    int refusals = 0;
    for (int i = 0; i < 64; ++i) {
        std::string bad = good;
        bad[random() % bad.size()] ^= static_cast<char>(1u << random() % 8);
        write(bad);
        refusals += refused();
    }
    CHECK(refusals == 64);
    for (std::size_t size = 0; size < good.size(); size += 4096) {
        CAPTURE(size);
        write(good.substr(0, size));
        CHECK(refused());
    }
    const Outcome resumed = renders.render("x.part.exr", "--range 0:8 --resume");
    CAPTURE(resumed.output);
    CHECK(resumed.code == 0);
    CHECK(contains(resumed.output, "x.part.exr: is"));
    CHECK(contains(resumed.output, "x.part.old.exr in its place"));
    REQUIRE(renders.merge({"x.part.exr"}, "m.exr").code == 0);
    CHECK(renders.pixels("m.exr") == renders.pixels("whole.exr"));
}

TEST_CASE("Part: a second process on the same output is refused" * doctest::test_suite("slow")) {
    const Renders renders;
    REQUIRE(renders.render("a.part.exr", "--range 0:1").code == 0);
    std::string line = renders.renderLine("x.exr", "--samples 1000000 & pid=$!; until [ -s ") +
                       renders.path(".x").string() +
                       "*.lock ]; do sleep 0.02; done; kill -STOP $pid; ";
    // By whatever name: these have one part.
    for (const std::string& second :
         {renders.renderLine("x.exr", "--samples 1"), renders.renderLine("x", "--samples 1"),
          renders.renderLine("x.part.exr", "--range 0:1"),
          renders.mergeLine({"a.part.exr"}, "x.exr"),
          renders.mergeLine({"a.part.exr"}, "x.part.exr")})
        line += std::string(ETENDUE_COMMAND) + ' ' + second + "; echo code $?; ";
    const Outcome outcome = run(line + "kill -9 $pid");
    CAPTURE(outcome.output);
    const std::string refusal = "etendue: " + renders.path("x.part.exr").string() + ": process ";
    std::istringstream lines(outcome.output);
    for (int i = 0; i < 5; ++i) {
        std::string reason, code;
        std::getline(lines, reason);
        std::getline(lines, code);
        CHECK(reason.starts_with(refusal));
        CHECK(contains(reason, "is writing it"));
        CHECK(code == "code 1");
    }
    // Killed, it holds nothing any more.
    CHECK(renders.render("x.exr", "--restart --samples 1").code == 0);
}

TEST_CASE("Part: a merge replaces no part but one of its own, unless --restart says so" *
          doctest::test_suite("slow")) {
    const Renders renders;
    REQUIRE(renders.render("a.part.exr", "--range 0:1").code == 0);
    REQUIRE(renders.render("b.part.exr", "--range 1:2").code == 0);
    const auto held = [&] { return readPartInfo(renders.path("a.part.exr")).ranges.text(); };
    const Outcome refused = renders.merge({"b.part.exr"}, "a.part.exr");
    CHECK(refused.code == 64);
    CHECK(contains(refused.output, "a.part.exr: holds samples of an unfinished render; named"));
    CHECK(held() == "0:1");
    CHECK(renders.merge({"b.part.exr", "./a.part.exr"}, "a.part.exr").code == 0);
    CHECK(held() == "0:2");
    CHECK(renders.merge({"b.part.exr"}, "a.part.exr", "--restart").code == 0);
    CHECK(held() == "1:2");
    // A picture is no part, whatever part it has.
    CHECK(renders.merge({"b.part.exr"}, "a.exr").code == 0);
    CHECK(held() == "1:2");
}

TEST_CASE("Part: one with more samples than are asked for stays, and no sample in it is cut" *
          doctest::test_suite("slow")) {
    const Renders renders;
    const fs::path part = renders.path("x.part.exr");
    REQUIRE(renders.render("x.exr", "--samples 1 --keep-part").code == 0);
    // A thread's first batch is not all of the frame. That is in the part after some 14 calls, the
    // next one after 14 more.
    killAtCall(22,
               renders.renderLine("x.exr", "--samples 2 --resume --threads 1 --checkpoint 1e-9"));
    REQUIRE(readPartInfo(part).ranges.text() == "0:1");
    REQUIRE(readPartInfo(part).unfinishedSamples == std::vector<std::uint32_t>{1});
    REQUIRE(renders.render("whole.exr", "--samples 2").code == 0);
    const std::string aloud = "render " + renders.path("s.toml").string() + " -o " +
                              renders.path("x.exr").string() + " --size 40,24 --resume --samples ";
    // The second time it has both samples from the beginning.
    for (int i = 0; i < 2; ++i) {
        const Outcome outcome = run(aloud + "1");
        CAPTURE(outcome.output);
        CHECK(outcome.code == 0);
        CHECK(contains(outcome.output, "2/2 spp"));
        CHECK(contains(outcome.output, "x.part.exr: is kept, since it holds 2 samples per pixel"));
        CHECK(renders.pixels("x.exr") == renders.pixels("whole.exr"));
        CHECK(readPartInfo(part).ranges.text() == "0:2");
        CHECK(readPartInfo(part).unfinishedSamples.empty());
    }
    const Outcome asked = run(aloud + "2");
    CHECK(asked.code == 0);
    CHECK_FALSE(contains(asked.output, "is kept"));
    CHECK_FALSE(fs::exists(part));
}

TEST_CASE("Part: what is there of a sample's splats is kept, not shown, and left out by a merge" *
          doctest::test_suite("slow")) {
    const Renders renders;
    const std::string set = " -s estimator.kind=bdpt";
    REQUIRE(renders.render("one.exr", "--samples 1" + set).code == 0);
    REQUIRE(renders.render("two.exr", "--samples 2" + set).code == 0);
    REQUIRE(renders.render("x.exr", "--samples 1 --keep-part" + set).code == 0);
    killAtCall(22, renders.renderLine("x.exr",
                                      "--samples 2 --resume --threads 1 --checkpoint 1e-9" + set));
    const Part part = readPart(renders.path("x.part.exr"));
    REQUIRE(part.info.unfinishedSamples == std::vector<std::uint32_t>{1});
    CHECK_FALSE(part.state.sampleLight == std::vector<SampleLight>(part.state.sampleLight.size()));
    CHECK(renders.pixels("x.part.exr") == renders.pixels("one.exr"));

    const Outcome merged = renders.merge({"x.part.exr"}, "merged.exr");
    CHECK(contains(merged.output, "x.part.exr: sample 1 is unfinished and left out\n"));
    CHECK(contains(merged.output, "samples 0:1, bit for bit"));
    CHECK(renders.pixels("merged.exr") == renders.pixels("one.exr"));
    REQUIRE(renders.render("b.part.exr", "--range 1:2" + set).code == 0);
    CHECK(renders.merge({"x.part.exr", "b.part.exr"}, "both.exr").code == 0);
    CHECK(renders.pixels("both.exr") == renders.pixels("two.exr"));

    REQUIRE(renders.render("x.exr", "--samples 2 --resume" + set).code == 0);
    CHECK(renders.pixels("x.exr") == renders.pixels("two.exr"));

    // Of the first sample, with features, which are in sums that all samples share.
    const std::string layers = set + " --layers albedo";
    killAtCall(22,
               renders.renderLine("y.exr", "--samples 1 --threads 1 --checkpoint 1e-9" + layers));
    REQUIRE(readPart(renders.path("y.part.exr")).state.samples == 0);
    const std::vector<float> black(renders.pixels("y.part.exr").size());
    CHECK_FALSE(renders.pixels("y.part.exr") == black);
    const Outcome none = renders.merge({"y.part.exr"}, "none.exr");
    CHECK(contains(none.output, "y.part.exr: the light of sample 0 is unfinished and left out\n"));
    CHECK(contains(none.output, "none.exr: black, since no sample is whole"));
    CHECK(renders.pixels("none.exr") == black);
}

TEST_CASE("Part: a file that a render or a merge would write twice, or over its input, is refused" *
          doctest::test_suite("slow")) {
    const Renders renders;
    const auto refuses = [](const Outcome& outcome, const std::string& reason) {
        CAPTURE(outcome.output);
        CHECK(outcome.code == 64);
        CHECK(contains(outcome.output, reason + ", and one would replace the other"));
    };
    const auto twice = [&](const std::string& output, const std::string& option,
                           const std::string& file) {
        return renders.render(
            output, "--estimator bdpt --samples 1 " + option + ' ' + renders.path(file).string());
    };
    const std::string images = "--technique-images";
    refuses(twice("t.exr", images, "t.exr"), "t.exr: is -o and " + images);
    refuses(twice("t.exr", images, "t.part.exr"), "is " + images + " and a part file of -o");
    refuses(twice("t.exr", images, "t.part.old.exr"), "is " + images + " and a part file of -o");
    refuses(twice("t", "--preview", "t"), "t: is -o and --preview");
    CHECK(renders.names() == std::vector<std::string>{"s.toml"});
    REQUIRE(renders.render("a.part.exr", "--range 0:1").code == 0);
    fs::rename(renders.path("a.part.exr"), renders.path("a"));
    refuses(renders.merge({"a"}, "a"), "a: is a part and -o");
    CHECK(readPartInfo(renders.path("a")).ranges.text() == "0:1");
    // What comes out of a pipe is not replaced.
    CHECK(run(renders.renderLine("t.exr",
                                 "--samples 1 --estimator bdpt --technique-images "
                                 "/dev/null --preview /dev/null"))
              .code == 0);
}

TEST_CASE("Part: SIGUSR1 writes it while the render goes on; --error ends one" *
          doctest::test_suite("slow")) {
    const Renders renders;
    const std::string scene = renders.path("s.toml").string();
    const std::string x = renders.path("x.exr").string();
    const std::string part = renders.path("x.part.exr").string();
    // Asked while the scene is being loaded, as soon as the output is locked; a checkpoint of its
    // own it would write in days.
    const auto waitFor = [](const std::string& condition) {
        return "until [ " + condition + " ]; do kill -0 $pid || exit 3; sleep 0.02; done; ";
    };
    const std::string line =
        "render " + scene + " -o " + x + " --quiet --samples 1000000 --checkpoint 1e6 & pid=$!; " +
        waitFor("-s " + renders.path(".x.part.exr.lock").string()) + "kill -USR1 $pid; " +
        waitFor("-e " + part) + "kill -INT $pid; wait $pid; echo code $?";
    const Outcome outcome = run(line);
    CAPTURE(outcome.output);
    CHECK(contains(outcome.output, "code 75"));
    CHECK(readPartInfo(part).ranges.count() > 0);
    const Outcome noise = run("render " + scene + " -o " + renders.path("n.exr").string() +
                              " --size 40,24 --progress json --error 0.5");
    CAPTURE(noise.output);
    CHECK(noise.code == 0);
    CHECK(contains(noise.output, "--error 0.5 is reached"));
}
