// Scenes whose answer is known in closed form.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "statistics/statistics.h"
#include "tests/support/scenes.h"

using namespace etendue;

namespace {

constexpr double pi64 = std::numbers::pi;

/// No false alarm among this file's hundred or so comparisons, with 99 %.
const double confidence = 1.0 - sidakLevel(0.01, 150);

/// The mean of independent batches agrees with `expected`: not further off than its standard error
/// explains, and known to better than `bound` relative, so that noise cannot hide a bias.
void checkMean(const std::vector<double>& batches, double expected, double bound) {
    const Summary s = summarize(batches);
    const double t = studentQuantile(confidence, static_cast<double>(s.count - 1));
    // Float rounding in a path's throughput: a few hundred operations of 2⁻²⁴ each.
    const double rounding = 3e-5 * expected;
    CAPTURE(s.mean);
    CAPTURE(s.standardError);
    CAPTURE(expected);
    CHECK(std::abs(s.mean - expected) <= t * s.standardError + rounding);
    CHECK(t * s.standardError <= bound * expected);
}

std::string plane(const std::string& material) {
    return "[[mesh]]\nshape = \"rectangle\"\nmaterial = \"" + material +
           "\"\ntransform = [{scale = 1000}, {rotate = [1, 0, 0, -90]}]\n";
}

const std::string greyPlane =
    "[[material]]\nname = \"grey\"\ncolor = [0.6, 0.6, 0.6]\n" + plane("grey");

/// Looking down at the origin of the plane y = 0.
std::vector<double> radianceAtOrigin(const std::string& text, int batches = 20,
                                     int samples = 2000) {
    return batchRadiances(sceneFromText(text), {0.0f, 1.0f, 0.0f}, {0, -1, 0}, batches, samples);
}

}  // namespace

TEST_CASE("Path tracer: an empty scene with an environment returns it exactly") {
    const auto values =
        batchRadiances(sceneFromText("[[light]]\ntype = \"constant\"\nradiance = [2, 2, 2]\n"), {},
                       {0, 0, 1}, 1, 10);
    CHECK(values[0] == 2.0);
}

TEST_CASE("Path tracer: a point light on a plane follows the inverse square and the cosine") {
    for (const double distance : {0.5, 1.0, 2.0, 4.0})
        for (const double angleDegrees : {0.0, 60.0}) {
            const double angle = angleDegrees * pi64 / 180.0;
            const std::string light =
                "[[light]]\ntype = \"point\"\nintensity = [5, 5, 5]\nposition = [" +
                std::to_string(distance * std::sin(angle)) + ", " +
                std::to_string(distance * std::cos(angle)) + ", 0]\n";
            const double expected = 0.6 / pi64 * 5.0 * std::cos(angle) / (distance * distance);
            CAPTURE(distance);
            CAPTURE(angleDegrees);
            checkMean(radianceAtOrigin(greyPlane + light, 4, 10), expected, 1e-4);
        }
}

TEST_CASE("Path tracer: a directional light on a plane") {
    const double expected = 0.6 / pi64 * 3.0 * std::cos(pi64 / 4);
    checkMean(
        radianceAtOrigin(greyPlane + "[[light]]\ntype = \"directional\"\nirradiance = [3, 3, 3]\n"
                                     "direction = [1, -1, 0]\n",
                         4, 10),
        expected, 1e-4);
}

TEST_CASE(
    "Path tracer: a spot light is constant inside its inner cone and nothing outside its outer "
    "one") {
    const std::string spot =
        "[[light]]\ntype = \"spot\"\nposition = [0, 2, 0]\nintensity = [4, 4, 4]\n"
        "inner_angle = 20\nouter_angle = 30\ndirection = ";
    checkMean(radianceAtOrigin(greyPlane + spot + "[0.3, -1, 0]\n", 4, 10), 0.6 / pi64 * 4.0 / 4.0,
              1e-4);
    checkMean(radianceAtOrigin(greyPlane + spot + "[1, -1, 0]\n", 4, 10), 0.0, 1e-4);
}

TEST_CASE("Path tracer: direct light of a sphere") {
    // Irradiance of a uniform sphere whose centre is on the normal: E = π L (r / d)². The
    // tessellated sphere's area, and with it its solid angle, falls short by less than 1.1 / n²
    // = 2.7e-4 (n = 64).
    const std::string light = R"(
[[material]]
name = "light"
color = [0, 0, 0]
emission = [7, 7, 7]
[[mesh]]
shape = "sphere"
segments = 256
material = "light"
transform = [{scale = 0.5}, {translate = [0, 2, 0]}]
)";
    const double expected = 0.6 * 7.0 * (0.5 / 2.0) * (0.5 / 2.0);
    // The camera looks from between the plane and the sphere.
    const auto values = batchRadiances(sceneFromText(greyPlane + light, {"estimator.max_depth=2"}),
                                       {0.0f, 1.0f, 0.0f}, {0, -1, 0}, 20, 20000);
    const Summary s = summarize(values);
    const double t = studentQuantile(confidence, 19);
    CHECK(std::abs(s.mean - expected) <= t * s.standardError + 3e-4 * expected);
    CHECK(t * s.standardError <= 0.02 * expected);
}

TEST_CASE("Path tracer: direct light of a rectangle, at any tessellation") {
    // A rectangle a × b at height h, its corner above the point: E = L/2 (A/√(1+A²) atan(B/√(1+A²))
    // + B/√(1+B²) atan(A/√(1+B²))), A = a/h, B = b/h (Lambert). Four of them around the axis.
    const double h = 1.5, A = 0.8 / h, B = 0.4 / h, L = 3.0;
    const double corner = 0.5 * L *
                          (A / std::sqrt(1 + A * A) * std::atan(B / std::sqrt(1 + A * A)) +
                           B / std::sqrt(1 + B * B) * std::atan(A / std::sqrt(1 + B * B)));
    const double expected = 0.6 / pi64 * 4.0 * corner;
    for (const char* subdivisions : {"1", "10", "100"}) {
        const std::string light = std::string(R"(
[[material]]
name = "light"
color = [0, 0, 0]
emission = [3, 3, 3]
[[mesh]]
shape = "rectangle"
material = "light"
transform = [{scale = [0.8, 0.4, 1]}, {rotate = [1, 0, 0, 90]}, {translate = [0, 1.5, 0]}]
subdivisions = )") + subdivisions +
                                  "\n";
        CAPTURE(std::string(subdivisions));
        checkMean(radianceAtOrigin(greyPlane + light, 20, 10000), expected, 0.008);
    }
}

TEST_CASE("Path tracer: two lights give the sum of each alone") {
    const std::string near =
        "[[light]]\ntype = \"point\"\nintensity = [1, 1, 1]\nposition = [0, 0.5, 0]\n";
    const std::string far = "[[light]]\ntype = \"constant\"\nradiance = [0.3, 0.3, 0.3]\n";
    const double expected = 0.6 / pi64 * 1.0 / 0.25 + 0.6 * 0.3;
    checkMean(radianceAtOrigin(greyPlane + near + far, 20, 8000), expected, 0.01);
}

TEST_CASE(
    "Path tracer: a closed box of albedo ρ and emission e has radiance e / (1 − ρ) everywhere") {
    for (const char* albedo : {"0.2", "0.5", "0.8"}) {
        const std::string grey = std::string("[") + albedo + ", " + albedo + ", " + albedo + "]";
        const std::string box =
            "[estimator]\nmax_depth = 10000\n[[material]]\nname = \"wall\"\ncolor = " + grey +
            "\nemission = [0.4, 0.4, 0.4]\ntwo_sided_emission = true\n"
            "[[mesh]]\nshape = \"box\"\nmaterial = \"wall\"\n";
        CAPTURE(std::string(albedo));
        checkMean(batchRadiances(sceneFromText(box), {0.1f, 0.2f, 0.3f},
                                 normalize(Vec3{0.5f, 0.3f, -0.7f}), 20, 3000),
                  0.4 / (1.0 - std::stod(albedo)), 0.02);
    }
}

TEST_CASE("Path tracer: depth counts edges: 1 is light seen directly, 2 direct light") {
    const std::string box =
        "[[material]]\nname = \"wall\"\ncolor = [0.5, 0.5, 0.5]\nemission = [1, 1, 1]\n"
        "two_sided_emission = true\n[[mesh]]\nshape = \"box\"\nmaterial = \"wall\"\n";
    double expected = 0.0;
    for (int depth = 1; depth <= 6; ++depth) {
        expected += std::pow(0.5, depth - 1);
        CAPTURE(depth);
        checkMean(
            batchRadiances(sceneFromText(box, {"estimator.max_depth=" + std::to_string(depth)}),
                           {0.1f, 0.2f, 0.3f}, normalize(Vec3{0.5f, 0.3f, -0.7f}), 20, 1000),
            expected, 0.02);
    }
}

TEST_CASE("Path tracer: Russian roulette changes the noise and not the mean") {
    const std::string box =
        "[estimator]\nmax_depth = 30\n[[material]]\nname = \"wall\"\ncolor = [0.6, 0.6, 0.6]\n"
        "emission = [0.4, 0.4, 0.4]\ntwo_sided_emission = true\n"
        "[[mesh]]\nshape = \"box\"\nmaterial = \"wall\"\n";
    // The geometric series to 30 edges.
    const double expected = 0.4 * (1.0 - std::pow(0.6, 30)) / 0.4;
    for (const char* depth : {"0", "1", "3"}) {
        CAPTURE(std::string(depth));
        checkMean(
            batchRadiances(
                sceneFromText(box, {std::string("estimator.russian_roulette_depth=") + depth}),
                {0.1f, 0.2f, 0.3f}, normalize(Vec3{0.5f, 0.3f, -0.7f}), 20, 2000),
            expected, 0.02);
    }
}

namespace {

struct FurnaceMaterial {
    const char* name;
    const char* lines;
    bool isRough;
};

constexpr FurnaceMaterial furnaceMaterials[] = {
    {"diffuse", "type = \"diffuse\"\ncolor = [1, 1, 1]\n", false},
    {"mirror", "type = \"conductor\"\ncolor = [1, 1, 1]\n", false},
    {"rough conductor", "type = \"conductor\"\ncolor = [1, 1, 1]\n", true},
    {"glass", "type = \"dielectric\"\nior = 1.5\n", false},
    {"rough glass", "type = \"dielectric\"\nior = 1.5\n", true},
    {"plastic", "type = \"plastic\"\ncolor = [1, 1, 1]\n", false},
    {"rough plastic", "type = \"plastic\"\ncolor = [1, 1, 1]\n", true},
};

/// An object of the material, lossless, where radiance is 1 from everywhere: it must be invisible.
/// Flat facets, because interpolated normals by themselves lose light.
std::vector<double> furnaceRadiances(const std::string& material, const std::string& surroundings,
                                     int samples) {
    const std::string text =
        "[estimator]\nmax_depth = 10000\nrussian_roulette_depth = 20\n" + surroundings +
        "[[material]]\nname = \"object\"\n" + material +
        "[[mesh]]\nshape = \"sphere\"\nsmooth = false\nsegments = 24\nmaterial = \"object\"\n"
        "transform = [{scale = 0.5}, {rotate = [1, 2, 3, 20]}]\n";
    return batchRadiances(sceneFromText(text), {0.2f, 0.13f, 0.95f}, {0, 0, -1}, 20, samples);
}

const std::string openSky = "[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";
const std::string closedBox =
    "[[material]]\nname = \"wall\"\ncolor = [0.5, 0.5, 0.5]\n"
    "emission = [0.5, 0.5, 0.5]\ntwo_sided_emission = true\n"
    "[[mesh]]\nshape = \"box\"\nmaterial = \"wall\"\n";

void checkFurnaces(const std::string& surroundings, int samples, double bound) {
    for (const FurnaceMaterial& m : furnaceMaterials)
        for (const char* roughness : {"0.01", "0.03", "0.1", "0.3", "0.6", "1.0"}) {
            CAPTURE(std::string(m.name));
            CAPTURE(std::string(roughness));
            const std::string lines =
                m.isRough ? std::string(m.lines) + "roughness = " + roughness + "\n" : m.lines;
            checkMean(furnaceRadiances(lines, surroundings, samples), 1.0, bound);
            if (!m.isRough) break;
        }
}

}  // namespace

TEST_CASE("Path tracer: in an open white furnace every lossless material is invisible") {
    checkFurnaces(openSky, 1000, 0.05);
}

TEST_CASE("Path tracer: in a closed white furnace every lossless material is invisible" *
          doctest::test_suite("slow")) {
    checkFurnaces(closedBox, 400, 0.08);
}

TEST_CASE("Path tracer: white furnaces, to one percent" * doctest::test_suite("statistical")) {
    checkFurnaces(openSky, 20000, 0.01);
    checkFurnaces(closedBox, 10000, 0.015);
}
