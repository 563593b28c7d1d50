// Each technique of bidirectional path tracing alone: without the others' help it must bring all
// the light of its paths, wherever light and camera stand.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/renderer/small_scenes.h"

using namespace etendue;

TEST_SUITE_BEGIN("statistical");

namespace {

/// By technique (s, t) alone, which makes paths of s + t − 1 edges.
std::vector<double> byTechnique(const LoadedScene& loaded, Technique technique,
                                std::uint32_t samples) {
    EstimatorSettings settings = loaded.estimator;
    settings.kind = "bdpt";
    settings.maxDepth = technique.s + technique.t - 1;
    settings.techniques = TechniqueSet::parse(nameOf(technique)).value();
    const PictureMeans result = pictureMeans(loaded, settings, samples);
    CHECK(result.badSamples == 0);
    return result.means;
}

/// By path tracing, paths of exactly `edges` edges: the same numbers draw the same beginnings, so
/// that the shorter paths' light is taken off exactly.
std::vector<double> byPathTracing(const LoadedScene& loaded, int edges, std::uint32_t samples) {
    EstimatorSettings settings = loaded.estimator;
    settings.maxDepth = edges;
    PictureMeans result = pictureMeans(loaded, settings, samples);
    settings.maxDepth = edges - 1;
    const PictureMeans shorter = pictureMeans(loaded, settings, samples);
    for (std::size_t i = 0; i < result.means.size(); ++i) result.means[i] -= shorter.means[i];
    return result.means;
}

/// A box of that half width from inside: of radiance 1, and half of what arrives comes back. Paths
/// of k edges bring 2^(1 − k) from everywhere, in a closed room of whatever shape and size.
std::string shiningBox(double halfWidth, const std::string& camera) {
    return film() +
           "[camera]\nmodel = \"thin-lens\"\nfov = 80\nf_number = 2\nfocus_distance = 1\n" +
           camera + material("shine", 0.5, 1.0) + "two_sided_emission = true\n" +
           mesh("box", "shine", "{scale = " + number(halfWidth) + "}");
}

constexpr int longestPath = 4;

/// All techniques of paths with up to four edges: of k edges there are k + 1.
constexpr double level = falseAlarmLevel / 14;

void checkShiningBox(double halfWidth, const std::string& camera) {
    const LoadedScene loaded = sceneFromText(shiningBox(halfWidth, camera));
    const std::vector<double> field = uniformField(loaded);
    for (int edges = 1; edges <= longestPath; ++edges)
        for (int s = 0; s <= edges; ++s) {
            const Technique technique{s, edges + 1 - s};
            CAPTURE(nameOf(technique));
            checkRatio(byTechnique(loaded, technique, 256), field, std::pow(2.0, 1 - edges), 0.2,
                       level);
        }
}

}  // namespace

TEST_CASE("Techniques: each alone brings a closed room's light") {
    checkShiningBox(1.0, "from = [0, 0, 0]\nto = [0, 0, 1]\n");
}

TEST_CASE("Techniques: …and as much in a room ten times as large, the lamp ten times as far") {
    checkShiningBox(10.0, "from = [0, 0, 0]\nto = [0, 0, 1]\n");
}

TEST_CASE("Techniques: …and as much from another place, in another direction") {
    checkShiningBox(1.0, "from = [0.5, -0.4, -0.6]\nto = [-0.3, 0.1, 1]\n");
}

TEST_CASE("Techniques: each alone sees a spot's light, with either ten times as far") {
    // A cone that covers what is seen, all of it within 0.8° of the spot's axis: cos³ is 1 to 3e-4
    // at its edge, and in the mean to a third of that. Radiance ρ / π · I / d² then.
    for (const double lightDistance : {1.0, 10.0})
        for (const double cameraDistance : {2.0, 20.0}) {
            CAPTURE(lightDistance);
            CAPTURE(cameraDistance);
            const std::string intensity = number(lightDistance * lightDistance);
            const LoadedScene loaded = sceneFromText(
                film() +
                pinhole("from = [" + number(0.8 * cameraDistance) + ", 0, " +
                            number(0.6 * cameraDistance) + "]\nto = [0, 0, 0]\n",
                        0.4 / cameraDistance) +
                material("grey", 0.5) + mesh("rectangle", "grey", "{scale = 0.2}") +
                "[[light]]\ntype = \"spot\"\ndirection = [0, 0, -1]\nposition = [0, 0, " +
                number(lightDistance) + "]\nintensity = [" + intensity + ", " + intensity + ", " +
                intensity + "]\nouter_angle = " + number(2.0 / lightDistance) + "\n");
            for (const Technique technique : {Technique{1, 2}, Technique{2, 1}}) {
                CAPTURE(nameOf(technique));
                checkMean(byTechnique(loaded, technique, 64), 0.5 / std::numbers::pi, 0.12, level,
                          1e-4);
            }
        }
}

TEST_CASE("Techniques: each alone sees a floor under rough glass as path tracing does") {
    // A sheet of water, of which only the surface is there, over a grey floor: light goes in and
    // comes out again, and the adjoint differs from the scattering by the square of the index.
    const LoadedScene loaded = sceneFromText(
        film() + thinLens("from = [0.2, 2, 3.9]\nto = [0, 0.4, 0]\n", 2.0, "3.4") +
        material("grey", grey) + material("lamp", black, 9.0) +
        "[[material]]\nname = \"water\"\ntype = \"dielectric\"\nior = 1.33\nroughness = 0.7\n" +
        mesh("rectangle", "grey", "{scale = 3}, {rotate = [1, 0, 0, -90]}") +
        mesh("rectangle", "water",
             "{scale = 3}, {rotate = [1, 0, 0, -90]}, {translate = [0, 0.5, 0]}") +
        mesh("rectangle", "lamp",
             "{scale = 1.5}, {rotate = [1, 0, 0, 90]}, {translate = [-0.4, 2.2, -0.5]}"));
    for (const int edges : {2, 4}) {  // by reflection, and twice through the surface
        const std::vector<double> expected = byPathTracing(loaded, edges, 512);
        for (int s = 0; s <= edges; ++s) {
            const Technique technique{s, edges + 1 - s};
            CAPTURE(nameOf(technique));
            checkRatio(byTechnique(loaded, technique, 384), expected, 1.0, 0.2, level);
        }
    }
}

TEST_SUITE_END();
