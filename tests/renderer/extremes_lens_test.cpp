// Settings at the ends of their ranges, through lenses of glass.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "tests/renderer/small_scenes.h"

using namespace etendue;

TEST_SUITE_BEGIN("statistical");

namespace {

/// At one wavelength, so that pictures need few samples. `keys`: a line each.
std::string glassLens(const std::string& name, const std::string& representation,
                      const std::string& keys, const std::string& place) {
    const std::string file =
        (std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses" / name).string();
    const std::string fit = representation == "traced" ? "" : "terms = 12\ndegree = 5\n";
    return "[camera]\nlens = \"" + file + "\"\nrepresentation = \"" + representation +
           "\"\ndispersion = false\n" + fit + keys + place;
}

/// A trace for every step of every search takes a hundred times as long as a polynomial: few light
/// paths, and a wide bound.
struct Effort {
    const char* representation;
    std::uint32_t lightSamples, samples;
    double lightBound, bound;
};
constexpr Effort efforts[] = {{"two-point", 96, 32, 0.1, 0.25}, {"traced", 4, 4, 0.5, 1.0}};

const std::string sky = "[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";

/// `field`: radiance 1 wherever the lens looks from the origin.
void checkLens(const std::string& name, const std::string& keys, const std::string& standingKeys,
               const std::string& field) {
    for (const Effort& effort : efforts) {
        CAPTURE(std::string(effort.representation));
        checkUniform(
            sceneFromText(film() + glassLens(name, effort.representation, keys, atOrigin) + field),
            0.04, effort.lightSamples, effort.lightBound);
        checkAgreement(
            sceneFromText(film() + glassLens(name, effort.representation, standingKeys, standing) +
                          room()),
            effort.samples, effort.bound, 64);
    }
}

}  // namespace

TEST_CASE("Extremes: a lens of glass at f/1.1") {
    const std::string focus = "focus_distance = 3.4\n";
    checkLens("double-gauss-50mm-f1.1.toml", focus, focus, shiningWall(1.2, 1.0));
}

TEST_CASE("Extremes: a lens of glass at f/64") {
    const std::string keys = "f_number = 64\nfocus_distance = 3.4\n";
    checkLens("double-gauss-50mm-f1.1.toml", keys, keys, shiningWall(1.2, 1.0));
}

TEST_CASE("Extremes: a lens of glass focused 10 cm before it") {
    const std::string keys = "sensor_width_mm = 22\nfocus_point = ";
    checkLens("fisheye-10mm.toml", keys + "[0, 0, -0.1]\n",
              keys + "[0.194875, 0.997437, 3.800064]\n", sky);
}

TEST_CASE("Extremes: a lens of glass focused at infinity") {
    const std::string keys = "sensor_width_mm = 22\nfocus_distance = inf\n";
    checkLens("fisheye-10mm.toml", keys, keys, sky);
}

TEST_CASE("Extremes: fields beyond 90°") {
    // A sky all around, and a lamp 100° off the axis, behind the plane of the lens' vertex.
    constexpr double angle = 100.0 * std::numbers::pi / 180.0;
    const std::string lamp = material("lamp", black, 50.0) +
                             mesh("sphere", "lamp",
                                  "{scale = 0.5}, {translate = [" + number(3 * std::sin(angle)) +
                                      ", 0, " + number(-3 * std::cos(angle)) + "]}");
    const std::string keys = "sensor_width_mm = 20\n";
    for (const Effort& effort : efforts) {
        CAPTURE(std::string(effort.representation));
        const auto lens = [&](const std::string& more) {
            return sceneFromText(
                film() +
                glassLens("fisheye-220-6mm-f2.8.toml", effort.representation, keys, atOrigin) +
                more);
        };
        checkUniform(lens(sky), 0.04, effort.lightSamples, effort.lightBound);
        checkAgreement(lens(lamp), 4 * effort.samples, effort.bound, 1024);
    }
}

TEST_CASE("Extremes: a point light on the axis of a lens of glass") {
    // What the polynomial sees of it is what the trace sees.
    for (const double distance : {0.5, 20.0}) {
        CAPTURE(distance);
        const auto seen = [&](const char* representation, const char* kind) {
            return goodMeans(
                sceneFromText(film() +
                              glassLens("double-gauss-50mm-f1.1.toml", representation,
                                        "f_number = 4\nfocus_distance = 3.4\n", atOrigin) +
                              "[[light]]\ntype = \"point\"\nposition = [0, 0, " +
                              number(-distance) + "]\nintensity = [1, 1, 1]\n"),
                kind, 2, 4);
        };
        const auto traced = seen("traced", "lt");
        for (const char* kind : {"lt", "bdpt"}) {
            CAPTURE(std::string(kind));
            checkRatio(seen("two-point", kind), traced, 1.0, 0.02);
        }
    }
}

TEST_SUITE_END();
