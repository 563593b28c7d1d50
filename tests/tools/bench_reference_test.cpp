// References: how far they say they can be trusted, and that they are rendered once.
#include "tools/bench_reference.h"

#include <doctest/doctest.h>

#include <cmath>

#include "statistics/statistics.h"
#include "tests/support/scenes.h"

using namespace etendue;

namespace {

/// With noise of more than one kind: a floor, and a lamp beside the sky.
const std::string scene = std::string(ballScene) + R"(
[[mesh]]
shape = "rectangle"
material = "wall"
transform = [{scale = 3}, {rotate = [1, 0, 0, -90]}, {translate = [0, -1, 0]}]
[[light]]
type = "point"
position = [2, 2, 2]
intensity = [9, 8, 7]
)";

const auto patiently = [](double) { return true; };

/// Of a scene by the same settings, and all that was said on the way.
struct Told {
    Told(const LoadedScene& loaded, const std::filesystem::path& directory)
        : reference(referenceFor(loaded, {"pt", 0.01, 1}, directory, patiently,
                                 [this](const std::string& sentence) { notices += sentence; })
                        .value()) {}
    std::string notices;
    Reference reference;
};

}  // namespace

TEST_CASE("Bench reference: its error is what it says") {
    const LoadedScene loaded = sceneFromText(scene, {"film.width=60", "film.height=40"});
    const Reference a = referenceFor(loaded, {"pt", 0.1, 1}, {}, patiently).value();
    const Reference b = referenceFor(loaded, {"bdpt", 0.2, 1}, {}, patiently).value();
    CHECK(a.samples >= 16);
    // Of each value: squared difference less the sum of the variances, whose expectation is zero.
    std::vector<double> excess;
    double said = 0.0;
    for (std::size_t i = 0; i < a.mean.pixels.size(); ++i) {
        const double difference = static_cast<double>(a.mean.pixels[i]) - b.mean.pixels[i];
        const double variance = static_cast<double>(a.mean.variance[i]) + b.mean.variance[i];
        const double scale = b.mean.pixels[i] * b.mean.pixels[i] + 0.01;
        excess.push_back((difference * difference - variance) / scale);
        said += variance / scale;
    }
    said /= static_cast<double>(excess.size());
    CHECK(said == doctest::Approx(a.mean.relMse + b.mean.relMse).epsilon(0.05));
    // Three channels of a pixel move together: as if there were a third of them. Four standard
    // errors; and the bound is tight enough to see an error of a quarter.
    const Summary summary = summarize(excess);
    const double standardError = std::sqrt(3.0) * summary.standardError;
    CHECK(std::abs(summary.mean) < 4.0 * standardError);
    CHECK(standardError < 0.25 / 4.0 * said);
}

TEST_CASE("Bench reference: rendered once, and anew for whatever it depends on") {
    const TemporaryFolder cache;
    const LoadedScene loaded = sceneFromText(scene);
    const BenchReferenceSettings settings{"pt", 0.01, 1};
    const Reference first = referenceFor(loaded, settings, cache.path(), patiently).value();
    int asked = 0;
    const auto counting = [&](double) {
        ++asked;
        return true;
    };
    const Reference again = referenceFor(loaded, settings, cache.path(), counting).value();
    CHECK(asked == 0);
    CHECK(again.mean.pixels == first.mean.pixels);
    CHECK(again.mean.variance == first.mean.variance);
    CHECK(again.samples == first.samples);
    CHECK(again.mean.relMse == first.mean.relMse);
    CHECK(again.key == first.key);
    const auto keyOf = [&](const LoadedScene& other, const BenchReferenceSettings& changed) {
        return referenceFor(other, changed, {}, patiently).value().key;
    };
    CHECK(keyOf(loaded, {"lt", 0.01, 1}) != first.key);
    CHECK(keyOf(loaded, {"pt", 0.02, 1}) != first.key);
    CHECK(keyOf(loaded, {"pt", 0.01, 2}) == first.key);
    CHECK(keyOf(sceneFromText(scene, {"film.width=25"}), settings) != first.key);
}

TEST_CASE("Bench reference: what is damaged of a kept one is rendered again, and kept again") {
    const TemporaryFolder cache;
    const LoadedScene loaded = sceneFromText(scene);
    const std::string key = Told(loaded, cache.path()).reference.key;
    const auto check = [&](const std::string& name, const std::string& what) {
        CAPTURE(name);
        const std::string notices = Told(loaded, cache.path()).notices;
        CAPTURE(notices);
        CHECK(notices.find(key + name + ":") != std::string::npos);
        CHECK(notices.find(what + "; the reference is rendered again") != std::string::npos);
        CHECK(Told(loaded, cache.path()).notices.empty());
    };
    std::filesystem::remove(cache / (key + ".variance.exr"));
    check(".variance.exr", "no such file");
    cache.write(key + ".exr", "nonsense");
    check(".exr", "");
    writeExr(cache / (key + ".exr"), {1, 1, 0, 0, 1, 1}, {{{"R", "G", "B"}, {1, 1, 1}}}, {});
    check(".exr", "expected 30 × 20 pixels in colour");
    cache.write(key + ".jsonl", "nonsense\n");
    check(".jsonl", "");
}

TEST_CASE("Bench reference: one that cannot be kept is told of, and is there all the same") {
    const LoadedScene loaded = sceneFromText(scene);
    const Told told(loaded, "/proc/nope/references");
    CHECK(told.reference.mean.pixels.size() == 3 * 30 * 20);
    CHECK(told.notices.find("the reference is not kept: /proc/nope/references/") == 0);
    CHECK(told.notices.find("No such file or directory") != std::string::npos);
}

TEST_CASE("Bench reference: given up, it is not kept") {
    const TemporaryFolder cache;
    const LoadedScene loaded = sceneFromText(scene);
    CHECK(!referenceFor(loaded, {"pt", 1.0, 1}, cache.path(), [](double) { return false; }));
    CHECK(cache.names().empty());
}
