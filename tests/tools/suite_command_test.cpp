// etendue bench SUITE as a user meets it.
#include <doctest/doctest.h>

#include <algorithm>

#include "renderer/output_lock.h"
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
    void writeSuite(const std::string& text) const {
        writeFile(folder / "scenes/suites/suite.toml", text);
    }
    Outcome run(const std::string& more = "") const { return runWithCache(folder / "cache", more); }
    Outcome runWithCache(const std::filesystem::path& cache, const std::string& more = "") const {
        return etendue::run("bench " + (folder / "scenes/suites/suite.toml").string() + " -o " +
                                out().string() + " " + more,
                            "XDG_CACHE_HOME=" + cache.string());
    }
    std::filesystem::path out() const { return folder / "out"; }
    std::string records() const { return readFile(out() / "results.jsonl"); }
    TemporaryFolder folder;
};

auto linesOf(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

/// A group that is right, before others that are not.
const std::string tinySuite =
    "[suite]\nwidth = 4\nheight = 3\nseeds = 2\nseconds = 10\nmost_samples = 1\n"
    "reference_seconds = 0.01\n[[group]]\nscenes = \"ball\"\nestimators = [\"pt\"]\n";

struct Mistake {
    std::string group;
    int code;
    std::string message;
};

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
    const std::string unfinished = all.substr(0, all.rfind('\n', all.size() - 2) + 1);
    writeFile(bench.folder / "scenes/ball/scene.toml", std::string(ballScene) + "# changed\n");
    for (const std::string& records : {all, unfinished}) {
        CAPTURE(records);
        writeFile(bench.out() / "results.jsonl", records);
        const Outcome changed = bench.run();
        CHECK(changed.code == 65);
        CHECK(contains(changed.output, "as it was before it was changed"));
        CHECK(bench.records() == records);
    }
}

TEST_CASE("Bench: a mistake in a suite is told before anything is measured, with its line" *
          doctest::test_suite("slow")) {
    const Bench bench;
    for (const char* name : {"hall", "bad", "cameras"})
        std::filesystem::create_directories(bench.folder / "scenes" / name);
    writeFile(bench.folder / "scenes/hall/scene.toml", ballScene);
    writeFile(bench.folder / "scenes/bad/scene.toml", "[film]\nwidht = 3\n");
    writeFile(bench.folder / "scenes/cameras/bad.toml", "[camera]\nfof = 40\n");
    writeFile(bench.folder / "scenes/lens.toml", "nome = 1\n");
    const std::string scenes = (bench.folder / "scenes/").string();
    const std::string suite = scenes + "suites/suite.toml";
    const std::string slip = "film.fliter: unknown key; did you mean 'filter'?\n";
    const std::string variant = "[[group.variant]]\nname = \"few\"\n";
    for (const Mistake& mistake : std::vector<Mistake>{
             {"scenes = \"hall\"\nset = [\"film.fliter=box\"]\n", 65,
              suite + ":13: group[1].set[0]: " + slip},
             {"scenes = \"hall\"\n" + variant + "set = \"film.fliter=box\"\n", 65,
              suite + ":15: group[1].variant[0].set (\"few\"): " + slip},
             {"scenes = \"hall\"\n" + variant + "set = \"light.0={type='point'}\"\n", 65,
              suite + ":15: group[1].variant[0].set (\"few\"): light[0].position: missing"},
             {"scenes = \"hall\"\nset = \"camera.lens=nope.toml\"\n", 66,
              suite + ":13: group[1].set: camera.lens: "},
             {"scenes = \"hall\"\nset = \"camera.lens=" + scenes + "lens.toml\"\n", 65,
              suite + ":13: group[1].set: " + scenes + "lens.toml:1: "},
             {"scenes = \"hell\"\n", 66, suite + ":12: group[1].scenes: no scene \"hell\" in "},
             {"scenes = \"bad\"\n", 65,
              scenes +
                  "bad/scene.toml:2: film.widht: unknown key; did you mean 'width'? (named by " +
                  suite + ":12, group[1].scenes)\n"},
             {"scenes = \"hall\"\ncameras = \"bad\"\n", 65,
              "(named by " + suite + ":13, group[1].cameras)\n"},
         }) {
        CAPTURE(mistake.group);
        bench.writeSuite(tinySuite + "[[group]]\n" + mistake.group);
        const Outcome outcome = bench.run();
        CAPTURE(outcome.output);
        CHECK(outcome.code == mistake.code);
        CHECK(contains(outcome.output, mistake.message));
        CHECK(linesOf(outcome.output) == 1);
        CHECK(!std::filesystem::exists(bench.out() / "results.jsonl"));
    }
    bench.writeSuite(tinySuite + "[[group]]\nscenes = \"hall\"\nset = [\"film.filter=box\"]\n");
    CHECK(bench.run().code == 0);
}

TEST_CASE("Bench: a signal while the scenes are checked leaves no records") {
    const Bench bench;
    std::string suite = tinySuite;
    for (int i = 0; i < 5000; ++i)  // far more than are loaded until the signal comes
        suite +=
            "[[group.variant]]\nname = \"" + std::to_string(i) + "\"\nset = \"film.filter=box\"\n";
    bench.writeSuite(suite);
    const std::string pictures = (bench.out() / "pictures").string();
    const Outcome outcome = bench.run("& pid=$!; until [ -e " + pictures +
                                      " ]; do sleep 0.01; done; kill -INT $pid; wait $pid");
    CAPTURE(outcome.output);
    CHECK(outcome.code == 75);
    CHECK(outcome.output == "stopped early: nothing has been measured\n");
    CHECK(!std::filesystem::exists(bench.out() / "results.jsonl"));
    CHECK(!std::filesystem::exists(bench.out() / "report.html"));
}

TEST_CASE("Bench: a folder that another process writes into is refused") {
    const Bench bench;
    std::filesystem::create_directories(bench.out());
    {
        const OutputLock lock(bench.out() / "results.jsonl");
        const Outcome second = bench.run();
        CHECK(second.code == 1);
        CHECK(contains(second.output, "results.jsonl: process "));
        CHECK(contains(second.output, "is writing it"));
        CHECK(!std::filesystem::exists(bench.out() / "results.jsonl"));
    }
    CHECK(bench.run().code == 0);
    CHECK(!std::filesystem::exists(bench.out() / ".results.jsonl.lock"));
}

TEST_CASE("Bench: a reference that cannot be kept ends nothing") {
    const Bench bench;
    const Outcome outcome = bench.runWithCache("/proc/nope");
    CAPTURE(outcome.output);
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.output, "note: the reference is not kept: /proc/nope/etendue/"));
    CHECK(std::filesystem::exists(bench.out() / "report.html"));
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
    const std::string out = " -o " + (bench.folder / "o3").string();
    writeFile(bench.folder / "scenes/ball.toml", "[film]\nwidht = 3\n");
    const std::string other = (bench.folder / "scenes/ball.toml").string();
    const Outcome bad = run("bench " + other + out);
    CHECK(bad.code == 65);
    CHECK(bad.output ==
          "etendue: " + other + ":2: film.widht: unknown key; did you mean 'width'?\n");
    CHECK(!std::filesystem::exists(bench.folder / "o3/results.jsonl"));
    const Outcome clash = run("bench ball " + other + " " + folder + out);
    CHECK(clash.code == 64);
    CHECK(contains(clash.output, other + " are both called \"ball\""));
    const Outcome twice = run("bench ball ball " + folder + out);
    CHECK(twice.code == 64);
    CHECK(contains(twice.output, "ball, own is there twice"));
}

TEST_CASE("Bench: a file in the place of its folder is an error") {
    const Bench bench;
    writeFile(bench.out(), "a picture");
    const Outcome outcome = bench.run();
    CHECK(outcome.code == 65);
    CHECK(outcome.output ==
          "etendue: " + bench.out().string() + ": is a file, expected a folder\n");
    std::filesystem::remove(bench.out());
    std::filesystem::create_directories(bench.out());
    writeFile(bench.out() / "pictures", "");
    CHECK(contains(bench.run().output, "pictures: is a file, expected a folder"));
}
