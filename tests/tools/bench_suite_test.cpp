// Suites: what they may say, and what they are refused for.
#include "tools/bench_suite.h"

#include <doctest/doctest.h>

#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

/// scenes/box, scenes/hall, scenes/cameras/wide, and a suite beside them.
struct Files {
    Files() {
        for (const char* name : {"box", "hall", "cameras", "suites"})
            std::filesystem::create_directories(folder / name);
        folder.write("box/scene.toml", "");
        folder.write("hall/scene.toml", "");
        folder.write("cameras/wide.toml", "[camera]\n");
    }
    BenchSuite load(const std::string& text) {
        folder.write("suites/suite.toml", text);
        return loadBenchSuite(folder / "suites/suite.toml");
    }
    std::string refusal(const std::string& text) {
        try {
            load(text);
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    }
    TemporaryFolder folder;
};

bool has(const std::string& text, const std::string& fragment) {
    return text.find(fragment) != std::string::npos;
}

}  // namespace

TEST_CASE("Bench suite: every scene of a group through every camera") {
    Files files;
    const BenchSuite suite = files.load(R"(
[suite]
title = "All"
seeds = 3
[[group]]
cameras = ["own", "wide"]
estimators = ["pt", "bdpt"]
[[group.variant]]
name = "few"
set = ["camera.terms=8"]
[[group.variant]]
name = "many"
set = ["camera.terms=64"]
)");
    CHECK(suite.title == "All");
    CHECK(suite.views.size() == 4);
    CHECK(titleOf(suite.views.front().scene, suite.views.front().camera) == "box, own");
    CHECK(titleOf(suite.views.back().scene, suite.views.back().camera) == "hall, wide");
    CHECK(suite.views.front().variants.at(1).overrides.at(0) == "camera.terms=64");
    CHECK(suite.runCount() == 4 * 2 * 2 * 3);
}

TEST_CASE("Bench suite: its key changes with whatever its results depend on") {
    Files files;
    const std::string text = "[suite]\nseconds = 1\n[[group]]\nscenes = \"box\"\n";
    const std::string key = files.load(text).key();
    CHECK(files.load(text).key() == key);
    for (const char* more :
         {"estimators = [\"pt\"]\n", "cameras = [\"wide\"]\n", "set = [\"film.filter=gaussian\"]\n",
          "[[group.variant]]\nname = \"few\"\nset = [\"camera.terms=8\"]\n"}) {
        CAPTURE(std::string(more));
        CHECK(files.load(text + more).key() != key);
    }
    CHECK(files.load("[suite]\nseconds = 2\n[[group]]\nscenes = \"box\"\n").key() != key);
}

TEST_CASE("Bench suite: mistakes are named with their line") {
    Files files;
    CHECK(has(files.refusal("[suite]\n"), "group"));
    const std::string scene = files.refusal("[[group]]\nscenes = \"bix\"\n");
    CHECK(has(scene, "suite.toml:2: group[0].scenes: no scene \"bix\" in "));
    CHECK(has(scene, "did you mean \"box\""));
    const std::string camera = files.refusal("[[group]]\ncameras = [\"wise\"]\n");
    CHECK(has(camera, "suite.toml:2: group[0].cameras: no camera \"wise\" in "));
    CHECK(has(camera, "did you mean \"wide\""));
    CHECK(has(files.refusal("[[group]]\nestimators = [\"vcm\"]\n"),
              "suite.toml:2: group[0].estimators: no estimator is called \"vcm\""));
    CHECK(has(files.refusal("[suite]\nseeds = 1\n[[group]]\n"), "suite.toml:2: suite.seeds"));
    CHECK(has(files.refusal("[suite]\nseed = 4\n[[group]]\n"), "did you mean 'seeds'"));
    CHECK(has(files.refusal("[[group]]\nscenes = \"box\"\n[[group]]\nscenes = \"box\"\n"),
              "suite.toml:4: group[1].scenes: box, own is there twice"));
    CHECK(has(files.refusal("[[group]]\n[[group.variant]]\nname = \"a\"\n[[group.variant]]\nname = "
                            "\"a\"\n"),
              "another variant's"));
    CHECK(has(files.refusal("[[group]]\nset = [\"film.filter=box\", \"estimator.kind=lt\"]\n"),
              "suite.toml:2: group[0].set: estimator.kind has no effect"));
    CHECK(has(files.refusal("[[group]]\n[[group.variant]]\nname = \"a\"\nset = "
                            "[\"estimator = {kind = 'lt'}\"]\n"),
              "suite.toml:4: group[0].variant[0].set (\"a\"): estimator.kind has no effect"));
    CHECK(has(files.refusal("[[group]]\nset = [\"film.width=3\",\n\"film.filter\"]\n"),
              "suite.toml:3: group[0].set[1]: expected key=value"));
}

TEST_CASE("Bench suite: two files of one name are refused, since results are kept by names") {
    Files files;
    std::filesystem::create_directories(files.folder / "more/box");
    files.folder.write("more/box/scene.toml", "");
    const std::string other = (files.folder / "more/box/scene.toml").string();
    const std::string message = files.refusal("[[group]]\nscenes = [\"box\", \"" + other + "\"]\n");
    CHECK(has(message, "suite.toml:2: group[0].scenes: "));
    CHECK(has(message, "box/scene.toml and " + other + " are both called \"box\""));
    // Also through another camera, where no records clash, but where nobody could tell them apart.
    CHECK(has(
        files.refusal("[[group]]\nscenes = \"box\"\n[[group]]\ncameras = \"wide\"\nscenes = \"" +
                      other + "\"\n"),
        "are both called \"box\""));
    const std::string same = (files.folder / "suites/../box/scene.toml").string();
    CHECK(files.refusal("[[group]]\nscenes = \"box\"\n[[group]]\ncameras = \"wide\"\nscenes = \"" +
                        same + "\"\n") == "accepted");
}

TEST_CASE("Bench suite: those in scenes/suites are right") {
    const auto folder = std::filesystem::path(__FILE__).parent_path() / "../../scenes/suites";
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        CAPTURE(entry.path().string());
        CHECK(!loadBenchSuite(entry.path()).views.empty());
        ++count;
    }
    CHECK(count >= 4);
}
