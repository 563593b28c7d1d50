// etendue bench regress as a user meets it.
#include <doctest/doctest.h>

#include "tests/support/scenes.h"
#include "tests/tools/command_outcome.h"
#include "tests/tools/every_material_scene.h"
#include "tools/regress_reference.h"

using namespace etendue;

namespace {

/// scenes/box/scene.toml with scenes/cameras/wide.toml, and data/references/ of a size that is
/// quick to test.
struct Regression {
    Regression() {
        for (const char* name : {"scenes/box", "scenes/cameras", "data/references"})
            std::filesystem::create_directories(folder / name);
        folder.write("scenes/box/scene.toml", everyMaterialScene);
        folder.write("scenes/cameras/wide.toml", "[camera]\nmodel = \"pinhole\"\nfov = 80\n");
        LoadOptions options;
        options.overrides = {"film.width=12", "film.height=8"};
        options.threads = 8;  // Embree caps all threads of the process
        options.camera = folder / "scenes/cameras/wide.toml";
        options.disperses = false;
        RegressReferenceSettings settings;
        settings.batches = 8;
        settings.samples = 32;
        settings.threads = 2;
        auto reference =
            makeReference(loadScene(folder / "scenes/box/scene.toml", options), settings, [] {
                return true;
            }).value();
        reference.scene = "box";
        reference.camera = "wide";
        folder.write(referenceName, referenceText(reference));
    }
    Outcome regress(const std::string& more) const {
        return run("bench regress --cameras wide --scenes " + (folder / "scenes").string() +
                   " --data " + (folder / "data").string() + " " + more);
    }
    std::string baseline() const { return readFile(folder / "data/baseline.toml"); }

    static constexpr const char* referenceName = "data/references/box.wide.toml";
    TemporaryFolder folder;
};

const Regression& regression() {
    static const Regression made;
    return made;
}

/// Of the first row that has it, the number after `key` times `factor`, and its interval.
std::string withNoiseTimes(std::string text, double factor) {
    const std::size_t at = text.find("noise = ", text.find("cell = ["));
    const std::size_t end = text.find("}", at);
    double value = 0.0, low = 0.0, high = 0.0;
    REQUIRE(std::sscanf(text.c_str() + at, "noise = %lf, interval = [%lf, %lf]", &value, &low,
                        &high) == 3);
    return text.replace(at, end - at,
                        "noise = " + std::to_string(factor * value) + ", interval = [" +
                            std::to_string(factor * low) + ", " + std::to_string(factor * high) +
                            "]");
}

}  // namespace

TEST_CASE("Bench regress: a baseline is made, kept to, and found to be left" *
          doctest::test_suite("slow")) {
    const Regression& r = regression();
    std::filesystem::remove(r.folder / "data/baseline.toml");
    const Outcome none = r.regress("");
    CHECK(none.code == 66);
    CHECK(contains(none.output, "baseline.toml: no such file"));

    const Outcome made = r.regress("--rebaseline --estimators pt,lt 2> /dev/null");
    CHECK(made.code == 0);
    CHECK(contains(made.output, "judged"));
    CHECK(contains(made.output, "→"));
    CHECK(contains(r.baseline(), "camera = \"wide\", estimator = \"lt\", samples = 16, "));
    CHECK(!contains(r.baseline(), "bdpt\""));

    const Outcome kept = r.regress("--estimators pt,lt");
    CHECK(kept.code == 0);
    CHECK(contains(kept.output, "2/2  box, wide, lt: pass"));  // progress, without a terminal
    CHECK(contains(kept.output, "0 of 2 cells fail, 0 of 1 pairs of estimators differ"));

    // A cell without a row is no pass.
    const Outcome unknown = r.regress("");
    CHECK(unknown.code == 1);
    CHECK(contains(unknown.output, "box, wide, bdpt: noise NO BASELINE"));

    const std::string before = r.baseline();
    r.folder.write("data/baseline.toml", withNoiseTimes(before, 0.2));
    const Outcome left = r.regress("--estimators lt");
    CHECK(left.code == 1);
    CHECK(contains(left.output, "box, wide, lt: noise WORSE"));
    r.folder.write("data/baseline.toml", withNoiseTimes(before, 5.0));
    CHECK(contains(r.regress("--estimators lt").output, "box, wide, lt: noise BETTER"));
    // Taking what is measured makes that the standard, to the digit, and keeps the other rows.
    const Outcome again = r.regress("--estimators lt --rebaseline");
    CHECK(again.code == 0);
    CHECK(contains(again.output, "-80.00"));
    CHECK(r.baseline() == before);
}

TEST_CASE("Bench regress: the same figures for any number of threads, other ones for other seeds" *
          doctest::test_suite("statistical")) {
    const Regression& r = regression();
    r.regress("--rebaseline --estimators lt");
    const auto figures = [&](const std::string& more) {
        const std::string text = r.regress("--estimators lt --json 2> /dev/null " + more).output;
        CHECK(contains(text, "\"outcome\": "));
        const std::size_t bias = text.find("\"bias\"");
        return text.substr(bias, text.find("\"outcome\"") - bias);
    };
    const std::string one = figures("--threads 1");
    CHECK(contains(one, "\"relmse_times_samples\": "));
    CHECK(contains(one, "\"slope\": -"));
    CHECK(figures("--threads 2") == one);
    CHECK(figures("--seed 99") != one);
}

TEST_CASE(
    "Bench regress: a scene that is not as bright as its reference fails, and is no baseline" *
    doctest::test_suite("statistical")) {
    const Regression& r = regression();
    r.regress("--rebaseline --estimators bdpt");
    const std::string before = r.baseline();
    r.folder.write("scenes/cameras/wide.toml",
                   "[camera]\nmodel = \"pinhole\"\nfov = 80\nexposure = 0.5\n");
    const Outcome brighter = r.regress("--estimators bdpt");
    CHECK(brighter.code == 1);
    CHECK(contains(brighter.output, "box, wide, bdpt: bias BIASED"));
    CHECK(contains(brighter.output, "Scenes that have changed since their reference was made:"));
    const Outcome refused = r.regress("--estimators bdpt --rebaseline");
    CHECK(refused.code == 1);
    CHECK(contains(refused.output, "NOT TAKEN: bias BIASED"));
    CHECK(r.baseline() == before);
    r.folder.write("scenes/cameras/wide.toml", "[camera]\nmodel = \"pinhole\"\nfov = 80\n");
}

TEST_CASE("Bench regress: what cannot be used is told once, with its name" *
          doctest::test_suite("slow")) {
    const Regression& r = regression();
    r.folder.write("data/baseline.toml", "");
    const std::string reference = readFile(r.folder / r.referenceName);
    r.folder.write(r.referenceName, reference.substr(0, reference.size() / 2));
    const Outcome cut = r.regress("--estimators lt");
    CHECK(cut.code == 65);
    CHECK(contains(cut.output, "references/box.wide.toml"));
    std::filesystem::remove(r.folder / r.referenceName);
    const Outcome gone = r.regress("--estimators lt");
    CHECK(gone.code == 66);
    CHECK(contains(gone.output, "references/box.wide.toml: no such file"));
    r.folder.write(r.referenceName, reference);
    r.folder.write("data/baseline.toml", "cell = [{scene = 3}]\n");
    const Outcome wrong = r.regress("--estimators lt");
    CHECK(wrong.code == 65);
    CHECK(contains(wrong.output, "baseline.toml:1"));

    CHECK(r.regress("--make-references --rebaseline").code == 64);
    CHECK(r.regress("--estimators vcm").code == 64);
    CHECK(r.regress("--samples 24").code == 64);
    const Outcome scene = r.regress("bux");
    CHECK(scene.code == 66);
    CHECK(contains(scene.output, "did you mean \"box\"?"));
}
