// etendue bench SUITE as a user meets it.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/scenes.h"
#include "tests/tools/command_outcome.h"

using namespace etendue;

namespace {

/// A scene, a suite of it, and a cache of references of their own.
struct Bench {
    Bench() {
        for (const char* name : {"scenes", "scenes/ball", "scenes/suites", "cache"})
            std::filesystem::create_directories(folder / name);
        folder.write("scenes/ball/scene.toml", ballScene);
        folder.write("scenes/suites/suite.toml",
                     "[suite]\ntitle = \"A <ball>\"\nwidth = 8\nheight = 6\nseeds = 2\nseconds = "
                     "10\nmost_samples = 8\nreference_seconds = 0.01\n[[group]]\nscenes = "
                     "\"ball\"\nestimators = [\"pt\", \"bdpt\"]\n");
    }
    Outcome run(const std::string& more = "") const {
        return etendue::run("bench " + (folder / "scenes/suites/suite.toml").string() + " -o " +
                                out().string() + " " + more,
                            "XDG_CACHE_HOME=" + (folder / "cache").string());
    }
    std::filesystem::path out() const { return folder / "out"; }
    std::string records() const { return readFile(out() / "results.jsonl"); }
    TemporaryFolder folder;
};

auto linesOf(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace

TEST_CASE("Bench: a suite gives records, a table, a CSV and a report") {
    const Bench bench;
    const Outcome outcome = bench.run();
    CAPTURE(outcome.output);
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.output, "4/4  ball, own, bdpt, seed 1: 8 samples in "));
    CHECK(contains(outcome.output, "efficiency, to the first"));
    CHECK(linesOf(bench.records()) == 1 + 1 + 1 + 4);  // suite, lens, reference, runs
    CHECK(contains(bench.records(), "\"kind\": \"reference\", \"scene\": \"ball\""));
    CHECK(linesOf(readFile(bench.out() / "results.csv")) == 1 + 4 * 4);  // of 1, 2, 4, 8 samples
    const std::string page = readFile(bench.out() / "report.html");
    CHECK(contains(page, "A \\u003cball>"));
    CHECK(contains(page, "\"isComplete\": true"));
    CHECK(contains(page, "\"half\": \""));
    for (const char* name :
         {"ball.own.reference.exr", "ball.own.pt.1.exr", "ball.own.techniques.exr"})
        CHECK(std::filesystem::exists(bench.out() / "pictures" / name));
}

TEST_CASE("Bench: what is done is not done again, and what is missing is") {
    const Bench bench;
    CHECK(bench.run().code == 0);
    const std::string all = bench.records();
    const Outcome again = bench.run();
    CHECK(again.code == 0);
    CHECK(!contains(again.output, ", seed "));
    CHECK(bench.records() == all);
    // As if it had been killed while it wrote the last but one.
    const std::size_t last = all.rfind('\n', all.size() - 2);
    const std::size_t before = all.rfind('\n', last - 1);
    writeFile(bench.out() / "results.jsonl", all.substr(0, before + 30));
    const Outcome rest = bench.run();
    CHECK(rest.code == 0);
    CHECK(contains(rest.output, "3/4  ball, own, pt, seed 1"));
    CHECK(!contains(rest.output, "seed 0:"));
    CHECK(linesOf(bench.records()) == linesOf(all));
    CHECK(bench.records().substr(0, before + 1) == all.substr(0, before + 1));
}

TEST_CASE("Bench: results of other settings, or of a scene that has changed, are not mixed in") {
    const Bench bench;
    CHECK(bench.run().code == 0);
    const Outcome other = bench.run("--seeds 3");
    CHECK(other.code == 65);
    CHECK(contains(other.output, "results.jsonl: holds results of another suite"));
    const Outcome threads = bench.run("--threads 7");
    CHECK(threads.code == 65);
    CHECK(contains(threads.output, "threads"));
    const std::string all = bench.records();
    writeFile(bench.out() / "results.jsonl", all.substr(0, all.rfind('\n', all.size() - 2) + 1));
    writeFile(bench.folder / "scenes/ball/scene.toml", std::string(ballScene) + "# changed\n");
    const Outcome changed = bench.run();
    CHECK(changed.code == 65);
    CHECK(contains(changed.output, "as it was before it was changed"));
}

TEST_CASE("Bench: of a group without estimators the cameras are measured alone") {
    const Bench bench;
    writeFile(bench.folder / "scenes/suites/suite.toml",
              "[suite]\nwidth = 8\nheight = 6\n[[group]]\nscenes = \"ball\"\nestimators = []\n");
    CHECK(bench.run().code == 0);
    CHECK(linesOf(bench.records()) == 2);
    CHECK(contains(bench.records(), "\"kind\": \"lens\", \"camera\": \"ball, own\""));
}

TEST_CASE("Bench: scenes without a suite, and what is asked for wrongly") {
    const Bench bench;
    const std::string folder = "--scenes " + (bench.folder / "scenes").string();
    const std::string cache = "XDG_CACHE_HOME=" + (bench.folder / "cache").string();
    const Outcome scene =
        run("bench ball " + folder + " -o " + (bench.folder / "o").string() +
                " --time 0.002 --reference-time 0.01 --seeds 2 --size 4,3 --estimators lt",
            cache);
    CAPTURE(scene.output);
    CHECK(scene.code == 0);
    CHECK(contains(scene.output, "2/2  ball, own, lt, seed 1"));
    CHECK(run("bench ball " + folder).code == 64);  // no -o
    const Outcome unknown = run("bench bell " + folder + " -o " + (bench.folder / "o2").string());
    CHECK(unknown.code == 66);
    CHECK(contains(unknown.output, "did you mean \"ball\""));
    CHECK(bench.run("--cameras own").code == 64);
}
