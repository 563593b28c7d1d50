// etendue bench agreement as a user meets it.
#include <doctest/doctest.h>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command_outcome.h"
#include "tests/tools/every_material_scene.h"

using namespace etendue;

namespace {

/// scenes/box/scene.toml, scenes/cameras/wide.toml.
struct Scenes {
    Scenes() {
        std::filesystem::create_directories(folder / "box");
        std::filesystem::create_directories(folder / "cameras");
        folder.write("box/scene.toml", everyMaterialScene);
        folder.write("cameras/wide.toml", "[camera]\nmodel = \"pinhole\"\nfov = 80\n");
    }
    std::string arguments() const { return "bench agreement --scenes " + folder.path().string(); }
    TemporaryFolder folder;
};

}  // namespace

TEST_CASE("Bench agreement: prints a row for each scene, camera and estimator") {
    const Scenes scenes;
    const Outcome outcome =
        run(scenes.arguments() + " --cameras own,wide --samples 2 --size 16,12 --seeds 4");
    CHECK(outcome.code == 0);
    for (const char* row :
         {"box    own     lt      pt", "box    own     bdpt    pt", "box    own     lt      bdpt",
          "box    wide    lt      pt", "box    wide    bdpt    pt", "box    wide    lt      bdpt"})
        CHECK(contains(outcome.output, row));
    CHECK(contains(outcome.output, "box, own, lt against pt: "));
    CHECK(contains(outcome.output, "of pt's light: what is seen first in a mirror"));
    CHECK(contains(outcome.output,
                   "6/6  box, wide, lt against bdpt: "));  // progress, without a terminal
    CHECK(contains(outcome.output, "4 pictures a side"));
    const Outcome json = run(scenes.arguments() +
                             " --samples 2 --seeds 4 --json --cameras wide --estimators lt box");
    CHECK(contains(json.output, "\"half_width_percent\": "));
    CHECK(contains(json.output, "\"verdict\": \"too noisy to tell\""));
}

TEST_CASE("Bench agreement: the same command gives the same figures for any number of threads") {
    const Scenes scenes;
    const auto figures = [&](const std::string& more) {
        const std::string text =
            run(scenes.arguments() + " --cameras own --samples 2 --size 16,12 --seeds 4 --json " +
                more + " 2> /dev/null")
                .output;
        const std::size_t bias = text.find("\"bias_percent\"");
        return text.substr(bias, text.find("\"seconds\"", bias) - bias);
    };
    const std::string one = figures("--threads 1");
    CHECK(one.size() > 50);
    CHECK(figures("--threads 2") == one);
    CHECK(figures("--seed 99") != one);
}

TEST_CASE("Bench agreement: each technique alone is held against path tracing") {
    const Scenes scenes;
    const std::string few = " --samples 1 --size 16,12 --seeds 2 --cameras own --techniques 2";
    const std::string text = run(scenes.arguments() + few).output;
    for (const char* row : {"bdpt:s1t1  bdpt", "bdpt:s1t2  pt", "bdpt:s2t1  pt"})
        CHECK(contains(text, row));
    CHECK(contains(text, "of pt's light: a mirror, smooth glass or a smooth coat where"));
    // Its point and its sun are met by no ray.
    CHECK(contains(text, "not complete"));
    CHECK(contains(text, "comparisons. agree"));
}

TEST_CASE("Bench agreement: time reckoned by a table gives the same samples in every run") {
    const Scenes scenes;
    const auto samplesOf = [&](const std::string& more) {
        const std::string text =
            run(scenes.arguments() + " --cameras own --size 16,12 --seeds 4 " +
                "--estimators bdpt --json --reckon --time 0.05" + more + " 2> /dev/null")
                .output;
        return text.substr(0, text.find("\"seconds\""));
    };
    const std::string once = samplesOf("");
    CHECK(contains(once, "\"samples\": "));
    CHECK(samplesOf(" --threads 1") == once);
    CHECK(run(scenes.arguments() + " --cameras own --size 16,12 --seeds 4 --samples 1 " +
              "--must-agree 1")
              .code == 1);
}

TEST_CASE("Bench agreement: names that do not exist are told with the nearest that does" *
          doctest::test_suite("slow")) {
    const Scenes scenes;
    const Outcome scene = run(scenes.arguments() + " bux");
    CHECK(scene.code == 66);
    CHECK(contains(scene.output, "did you mean \"box\"?"));
    const Outcome camera = run(scenes.arguments() + " --cameras wode");
    CHECK(camera.code == 66);
    CHECK(contains(camera.output, "did you mean \"wide\"?"));
    CHECK(run("bench agreement --scenes " + (scenes.folder / "cameras").string()).code == 66);
    CHECK(run(scenes.arguments() + " --estimators vcm").code == 64);
    CHECK(run(scenes.arguments() + " --estimators bdpt:s2").code == 64);
    CHECK(run(scenes.arguments() + " --estimators bdpt:s2t2 --against bdpt:s2t1").code == 64);
    CHECK(run(scenes.arguments() + " --seeds 1").code == 64);
    CHECK(run("bench").code == 64);
}

TEST_CASE("Bench agreement: the estimator of a scene is not set, where it would have no effect") {
    const Scenes scenes;
    const Outcome option = run(scenes.arguments() + " --estimator lt", "timeout 5");
    CHECK(option.code == 64);
    CHECK(contains(option.output, "--estimator"));
    for (const char* set : {"estimator.kind=lt", "'estimator . kind = \"lt\"'"}) {
        const Outcome outcome = run(scenes.arguments() + " -s " + set, "timeout 5");
        CHECK(outcome.code == 64);
        CHECK(contains(outcome.output, "-s estimator.kind: has no effect; --estimators names"));
    }
}

TEST_CASE("Bench agreement: a scene that cannot be loaded costs its own rows only") {
    const Scenes scenes;
    std::filesystem::create_directories(scenes.folder / "a-bad-one");
    scenes.folder.write("a-bad-one/scene.toml", "[film]\nwidht = 3\n");
    const Outcome outcome =
        run(scenes.arguments() + " --cameras own --estimators lt --samples 1 --size 16,12");
    CHECK(outcome.code == 65);
    CHECK(contains(outcome.output, "a-bad-one, own, lt against pt: "));
    CHECK(contains(outcome.output, "scene.toml:2"));
    CHECK(contains(outcome.output, "box        own"));
}

TEST_CASE("Bench agreement: a signal ends it with 75, and with the rows that were done") {
    const Scenes scenes;
    const std::string progress = (scenes.folder / "progress").string();
    // The first comparison is short, the second would take hours.
    const std::string line = scenes.arguments() +
                             " --cameras own --estimators lt,bdpt --time 0.2 --size 16,12 2> " +
                             progress + " & pid=$!; until [ -s " + progress +
                             " ]; do sleep 0.02; done; kill -INT $pid; wait $pid";
    const Outcome outcome = run(line);
    // It may have been done when the signal came.
    CHECK((outcome.code == 75 || outcome.code == 0));
    CHECK(contains(outcome.output, "box    own     lt"));
}
