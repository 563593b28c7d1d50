// Defects that other renderers' trackers report of light tracing and bidirectional path tracing:
// each changes the brightness of a whole picture, and each is looked for here.
#include <doctest/doctest.h>

#include <cmath>

#include "statistics/statistics.h"
#include "tests/support/scenes.h"

using namespace etendue;

TEST_SUITE_BEGIN("statistical");

namespace {

constexpr std::uint64_t seeds = 16;

/// The mean of the picture, once for each seed.
std::vector<double> means(const std::string& scene, const std::string& kind, std::uint32_t samples,
                          std::vector<std::string> overrides = {}) {
    overrides.push_back("estimator.kind=" + kind);
    const LoadedScene loaded = sceneFromText(scene, overrides);
    std::vector<double> result;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const std::vector<float> pixels = renderPixels(loaded, samples, 7 + seed, 2);
        double sum = 0.0;
        for (const float v : pixels) sum += static_cast<double>(v);
        result.push_back(sum / static_cast<double>(pixels.size()));
    }
    return result;
}

/// a = factor · b: not further apart than one in a thousand by chance, and known to `bound`.
void checkRatio(const std::vector<double>& a, std::vector<double> b, double factor, double bound) {
    for (double& v : b) v *= factor;
    const WelchResult welch = welchTest(a, b);
    const double mean = summarize(b).mean;
    CAPTURE(summarize(a).mean);
    CAPTURE(mean);
    CHECK(welch.pValue > 1e-3);
    CHECK(std::abs(welch.difference) + 3.0 * welch.standardError < bound * mean);
}

std::string film(double scale = 1.0) {
    const auto metres = [&](double value) { return std::to_string(value * scale); };
    return "[film]\nwidth = 16\nheight = 12\n[estimator]\nmax_depth = 4\n[camera]\nmodel = "
           "\"thin-lens\"\nfov = 50\nfrom = [" +
           metres(0.2) + ", " + metres(1.0) + ", " + metres(3.9) + "]\nto = [0, " + metres(0.9) +
           ", 0]\nf_number = 2\nfocus_distance = " + metres(3.4) + "\n";
}

std::string shape(const std::string& what, const std::string& material, const std::string& place,
                  double scale = 1.0) {
    return "[[mesh]]\nshape = \"" + what + "\"\nmaterial = \"" + material + "\"\ntransform = [" +
           place + ", {scale = " + std::to_string(scale) + "}]\n";
}

const std::string materials =
    "[[material]]\nname = \"grey\"\ncolor = [0.6, 0.5, 0.4]\n"
    "[[material]]\nname = \"black\"\ncolor = [0, 0, 0]\n"
    "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nroughness = 0.5\n"
    "[[material]]\nname = \"lamp\"\ncolor = [0, 0, 0]\nemission = [9, 8, 6]\n"
    "[[material]]\nname = \"blue\"\ncolor = [0, 0, 0]\nemission = [1, 2, 5]\n";

const std::string lampPlace =
    "{scale = 0.4}, {rotate = [1, 0, 0, 90]}, {translate = [-0.4, 2.2, 0.3]}";
const std::string bluePlace = "{scale = 0.3}, {rotate = [0, 1, 0, -90]}, {translate = [1.4, 1, 0]}";

std::string room(double scale = 1.0) {
    return materials + shape("rectangle", "grey", "{scale = 3}, {rotate = [1, 0, 0, -90]}", scale) +
           shape("rectangle", "grey", "{scale = 3}, {translate = [0, 1, -1]}", scale) +
           shape("box", "grey", "{scale = 0.4}, {translate = [0.3, 0.4, 0]}", scale);
}
std::string lamp(double scale = 1.0) { return shape("rectangle", "lamp", lampPlace, scale); }

const char* const splatting[] = {"lt", "bdpt"};

}  // namespace

TEST_CASE("Estimators: the mean does not depend on the number of samples or of light paths") {
    for (const char* kind : splatting) {
        CAPTURE(std::string(kind));
        const auto many = means(film() + room() + lamp(), kind, 64);
        for (const std::uint32_t samples : {1u, 2u, 4u, 7u, 16u}) {
            CAPTURE(samples);
            checkRatio(means(film() + room() + lamp(), kind, samples), many, 1.0,
                       0.3 / std::sqrt(samples));
        }
        checkRatio(means(film() + room() + lamp(), kind, 16, {"estimator.light_paths=4"}), many,
                   1.0, 0.05);
    }
}

TEST_CASE("Estimators: two lights together are the sum of each alone") {
    const std::string blue = shape("rectangle", "blue", bluePlace);
    for (const char* kind : splatting) {
        CAPTURE(std::string(kind));
        std::vector<double> sum = means(film() + room() + lamp(), kind, 64);
        const std::vector<double> other = means(film() + room() + blue, kind, 64);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += other[i];
        checkRatio(means(film() + room() + lamp() + blue, kind, 64), sum, 1.0, 0.05);
    }
}

TEST_CASE("Estimators: a lamp of 200 or 20,000 triangles is as bright as one of two") {
    for (const int subdivisions : {10, 100}) {
        CAPTURE(subdivisions);
        const std::string fine =
            "[[mesh]]\nshape = \"rectangle\"\nsubdivisions = " + std::to_string(subdivisions) +
            "\nmaterial = \"lamp\"\ntransform = [" + lampPlace + "]\n";
        for (const char* kind : splatting) {
            CAPTURE(std::string(kind));
            checkRatio(means(film() + room() + fine, kind, 64),
                       means(film() + room() + lamp(), kind, 64), 1.0, 0.05);
        }
    }
}

TEST_CASE("Estimators: the picture does not depend on the scene's scale") {
    for (const char* kind : splatting)
        for (const double scale : {1e-2, 1e2}) {
            CAPTURE(std::string(kind));
            CAPTURE(scale);
            // The lens grows with the scene, so that the picture is the same.
            const std::vector<std::string> lens = {
                "camera.focal_length_mm=" + std::to_string(50.0 * scale),
                "camera.sensor_width_mm=" + std::to_string(36.0 * scale)};
            const auto withLens = [&](std::string text) {
                text.erase(text.find("fov = 50\n"), 9);
                return text;
            };
            checkRatio(
                means(withLens(film(scale) + room(scale) + lamp(scale)), kind, 64, lens),
                means(withLens(film() + room() + lamp()), kind, 64, {"camera.focal_length_mm=50"}),
                1.0, 0.05);
        }
}

TEST_CASE("Estimators: Russian roulette changes no mean") {
    for (const char* kind : splatting)
        checkRatio(
            means(film() + room() + lamp(), kind, 64, {"estimator.russian_roulette_depth=1"}),
            means(film() + room() + lamp(), kind, 64, {"estimator.russian_roulette_depth=0"}), 1.0,
            0.08);
}

TEST_CASE("Estimators: a knife's edge over half the aperture halves what is out of focus") {
    // A wall far out of focus; a black half plane right before the lens.
    const std::string view =
        "[film]\nwidth = 4\nheight = 4\n[estimator]\nmax_depth = 1\n[camera]\nmodel = "
        "\"thin-lens\"\n"
        "from = [0, 0, 1]\nto = [0, 0, 0]\nfocal_length_mm = 50\nsensor_width_mm = 4\nf_number = "
        "1\n"
        "focus_distance = 1e4\n" +
        materials + shape("rectangle", "lamp", "{scale = 0.07}");
    const std::string knife =
        shape("rectangle", "black", "{scale = 0.5}, {translate = [0.5, 0, 0.999]}");
    for (const char* kind : {"pt", "lt", "bdpt"}) {
        CAPTURE(std::string(kind));
        checkRatio(means(view + knife, kind, 512), means(view, kind, 512), 0.5, 0.05);
    }
}

TEST_CASE("Estimators: an empty scene under a constant sky is the sky") {
    const std::string sky =
        "[film]\nwidth = 8\nheight = 8\n[camera]\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nfov = 60\n"
        "[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";
    const std::vector<double> expected = means(sky, "pt", 64);
    checkRatio(means(sky, "bdpt", 256), expected, 1.0, 0.02);
    checkRatio(means(sky, "lt", 2048), expected, 1.0, 0.05);
}

TEST_CASE("Estimators: rough glass in the way of the light") {
    const std::string slab =
        shape("box", "glass", "{scale = [1.2, 0.05, 1.2]}, {translate = [-0.4, 1.6, 0.3]}");
    const auto expected = means(film() + room() + lamp() + slab, "pt", 256);
    for (const char* kind : splatting)
        checkRatio(means(film() + room() + lamp() + slab, kind, 256), expected, 1.0, 0.08);
}

TEST_SUITE_END();
