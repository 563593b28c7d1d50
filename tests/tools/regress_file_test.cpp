// What regression tests compare with, as files: whole, or refused with the file's name.
#include <doctest/doctest.h>

#include "tests/support/scenes.h"
#include "tests/tools/command_outcome.h"
#include "tests/tools/every_material_scene.h"
#include "tools/regress_baseline.h"
#include "tools/regress_reference.h"

using namespace etendue;

namespace {

RegressReference smallReference() {
    RegressReference reference{"box", "wide", "0123", 2, 1, {}};
    reference.pictures.push_back({"lt",
                                  "bdpt",
                                  false,
                                  64,
                                  1.5,
                                  3e-6,
                                  {{0.1, 0.2, 0.3, 0.2}, {0.11, 0.21, 0.31, 0.21}},
                                  {0.0f, 1e-20f, 0.333333f, 1.0f, -0.25f, 12345.678f}});
    reference.pictures.push_back(reference.pictures.front());
    reference.pictures.back().estimator = "pt";
    reference.pictures.back().leavesOut = true;
    return reference;
}

template <typename Read>
std::string messageOf(const Read& read, ExitCode code) {
    try {
        read();
    } catch (const InputError& error) {
        CHECK(error.code() == code);
        return error.what();
    }
    return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

const char* const rowText =
    R"({scene = "box", camera = "wide", estimator = "pt", samples = 16, bias_bound = 0.5, noise = 2, interval = [1.9, 2.1]},)";

}  // namespace

TEST_CASE("Regress reference: what is written is read again") {
    const TemporaryFolder folder;
    const RegressReference before = smallReference();
    const auto file = folder.write("box.wide.toml", referenceText(before));
    CHECK(file == referenceFile(folder.path(), "box", "wide"));
    const RegressReference after = readReference(file);
    CHECK(after.scene == "box");
    CHECK(after.camera == "wide");
    CHECK(after.sceneHash == "0123");
    REQUIRE(after.pictures.size() == 2);
    CHECK(after.of("bdpt") == nullptr);
    CHECK(after.of("pt")->leavesOut);
    const ReferencePicture& picture = *after.of("lt");
    CHECK(!picture.leavesOut);
    CHECK(picture.by == "bdpt");
    CHECK(picture.samples == 64);
    CHECK(picture.largest == 1.5);
    CHECK(picture.noise == 3e-6);
    CHECK(picture.means == before.pictures[0].means);
    CHECK(picture.pixels[0] == 0.0f);
    // 15 of 23 bits are kept, rounded.
    for (std::size_t i = 1; i < picture.pixels.size(); ++i)
        CHECK(picture.pixels[i] ==
              doctest::Approx(before.pictures[0].pixels[i]).epsilon(0x1p-16).scale(0.0));
    CHECK(referenceText(after) == referenceText(readReference(file)));
}

TEST_CASE("Regress reference: a file that is not there or not what was written is refused") {
    const TemporaryFolder folder;
    const std::string text = referenceText(smallReference());
    const auto refusal = [&](const std::string& bytes) {
        const auto file = folder.write("r.toml", bytes);
        return messageOf([&] { readReference(file); }, ExitCode::badInput);
    };
    CHECK(contains(messageOf([&] { readReference(folder / "no.toml"); }, ExitCode::missingFile),
                   "no.toml"));
    CHECK(contains(refusal(text.substr(0, text.size() / 2)), "r.toml"));
    CHECK(contains(refusal(replaced(text, "0.21", "0.22")), "not the one that was written"));
    const std::size_t pixels = text.find("pixels = \"") + 10;
    std::string changed = text;
    changed[pixels + 8] = changed[pixels + 8] == 'A' ? 'B' : 'A';
    CHECK(contains(refusal(changed), "not the one that was written"));
    CHECK(contains(refusal(replaced(text, "pixels = \"", "pixels = \"AAAA")), "base64"));
    CHECK(contains(refusal(replaced(text, "width = 2", "width = 3")), "base64"));
    CHECK(contains(refusal(replaced(text, "by = ", "bye = ")), "r.toml"));
    CHECK(contains(refusal(replaced(text, "\"lt\"", "\"vcm\"")), "vcm"));
    CHECK(contains(refusal(""), "scene"));
}

TEST_CASE("Regress reference: those of estimators that see one picture are one") {
    const LoadedScene loaded =
        sceneFromText(everyMaterialScene, {"film.width=12", "film.height=8"});
    RegressReferenceSettings settings;
    settings.batches = 3;
    settings.samples = 2;
    const auto goOn = [] { return true; };
    const auto reference = makeReference(loaded, settings, goOn);
    REQUIRE(reference);
    REQUIRE(reference->pictures.size() == 3);
    // Its mirrors are none of lt's, its points none of pt's.
    CHECK(reference->of("pt")->means != reference->of("lt")->means);
    CHECK(reference->of("bdpt")->by == "bdpt");
    CHECK(reference->of("lt")->by == "bdpt");
    for (const ReferencePicture& picture : reference->pictures) {
        CHECK(picture.means.size() == 3);
        CHECK(picture.means[0].size() == 4);
        CHECK(picture.noise > 0.0);
        CHECK(picture.largest > 0.0);
    }
    CHECK(!makeReference(loaded, settings, [] { return false; }));
    // What is rendered to be held against it leaves out what it lacks, and no more.
    CHECK(testedPaths(loaded.estimator, "pt", true).other.kind == "bdpt");
    CHECK(!testedPaths(loaded.estimator, "pt", true).keepsByChance);
    CHECK(testedPaths(loaded.estimator, "pt", false).other.kind == "pt");
    CHECK(testedPaths(loaded.estimator, "pt", false).keepsByChance);
}

TEST_CASE("Regress baseline: what is written is read again, in order") {
    const TemporaryFolder folder;
    Baseline before;
    before.put({{"b", "wide", "pt"}, 16, 0.005, true, 2.0, {1.9, 2.1}});
    before.put({{"a", "wide", "lt"}, 64, {}, false, 1e-5, {0.9e-5, 1.1e-5}});
    before.put({{"b", "wide", "pt"}, 32, 0.02, true, 3.0, {2.9, 3.1}});
    REQUIRE(before.rows.size() == 2);
    const Baseline after = readBaseline(folder.write("b.toml", baselineText(before)));
    REQUIRE(after.rows.size() == 2);
    CHECK(after.rows[0].cell.scene == "a");
    CHECK(!after.rows[0].biasBound);
    CHECK(!after.rows[0].judgesRate);
    CHECK(after.rows[0].noise == 1e-5);
    const BaselineRow* row = after.of({"b", "wide", "pt"});
    REQUIRE(row);
    CHECK(row->samples == 32);
    CHECK(row->biasBound.value() == doctest::Approx(0.02));
    CHECK(row->interval.high == 3.1);
    CHECK(!after.of({"b", "wide", "lt"}));
    CHECK(baselineText(after) == baselineText(before));
}

TEST_CASE("Regress baseline: a file that is not there or not whole is refused with its name") {
    const TemporaryFolder folder;
    const auto refusal = [&](const std::string& rows) {
        const auto file = folder.write("b.toml", "cell = [\n" + rows + "\n]\n");
        return messageOf([&] { readBaseline(file); }, ExitCode::badInput);
    };
    CHECK(refusal(rowText) == "");
    CHECK(contains(messageOf([&] { readBaseline(folder / "no.toml"); }, ExitCode::missingFile),
                   "no.toml"));
    CHECK(contains(refusal(std::string(rowText) + "\n" + rowText), "b.toml:3: cell[1]"));
    CHECK(contains(refusal(std::string(rowText).substr(0, 60)), "b.toml"));
    CHECK(
        contains(refusal(replaced(rowText, "[1.9, 2.1]", "[2.1, 2.2]")), "the noise between them"));
    CHECK(contains(refusal(replaced(rowText, "noise = 2", "noise = nan")), "b.toml:2"));
    CHECK(contains(refusal(replaced(rowText, "bias_bound", "bias_bond")), "bias_bound"));
    CHECK(contains(refusal(replaced(rowText, "\"pt\"", "\"vcm\"")), "vcm"));
}
