// Small scenes as the text of a file, and what all estimators should make of them.
#pragma once

#include <cstdio>
#include <numbers>
#include <string>

#include "tests/renderer/estimator_means.h"

namespace etendue {

inline constexpr double black = 0.0, grey = 0.6;

inline std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9e", value);
    return text;
}

inline std::string film(int depth = 4) {
    return "[film]\nwidth = 12\nheight = 8\n[estimator]\nmax_depth = " + std::to_string(depth) +
           "\nrussian_roulette_depth = 0\n";
}

inline std::string material(const std::string& name, double color, double emission = 0.0) {
    const auto triple = [](double v) {
        return "[" + number(v) + ", " + number(v) + ", " + number(v) + "]\n";
    };
    return "[[material]]\nname = \"" + name + "\"\ncolor = " + triple(color) +
           "emission = " + triple(emission);
}

inline std::string mesh(const std::string& shape, const std::string& material_,
                        const std::string& place) {
    return "[[mesh]]\nshape = \"" + shape + "\"\nmaterial = \"" + material_ + "\"\ntransform = [" +
           place + "]\n";
}

inline const std::string standing = "from = [0.2, 1, 3.9]\nto = [0, 0.9, 0]\n";

/// A floor, a back wall and a box under a lamp of that radiance, all lengths times `scale`.
inline std::string room(
    double scale = 1.0, double emission = 9.0,
    const std::string& lampPlace =
        "{scale = 0.4}, {rotate = [1, 0, 0, 90]}, {translate = [-0.4, 2.2, 0.3]}") {
    const std::string scaled = ", {scale = " + number(scale) + "}";
    return material("grey", grey) + material("lamp", black, emission) +
           mesh("rectangle", "grey", "{scale = 3}, {rotate = [1, 0, 0, -90]}" + scaled) +
           mesh("rectangle", "grey", "{scale = 3}, {translate = [0, 1, -1]}" + scaled) +
           mesh("box", "grey", "{scale = 0.4}, {translate = [0.3, 0.4, 0]}" + scaled) +
           mesh("rectangle", "lamp", lampPlace + scaled);
}

/// An OBJ of 8 × 8 squares, as wide as the room's floor. The normals of its corners lean so far to
/// either side in turn.
inline std::string bumpyFloor(double leanDegrees) {
    std::string obj;
    for (int j = 0; j <= 8; ++j)
        for (int i = 0; i <= 8; ++i)
            obj += "v " + number(-3 + 0.75 * i) + " 0 " + number(3 - 0.75 * j) + "\n";
    const double up = std::cos(leanDegrees * std::numbers::pi / 180.0);
    for (const double side : {1.0, -1.0})
        obj += "vn " + number(side * std::sqrt(1.0 - up * up)) + " " + number(up) + " 0\n";
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) {
            const auto corner = [&](int x, int y) {
                return std::to_string(1 + x + 9 * y) + "//" + std::to_string(1 + (x + y) % 2) + " ";
            };
            obj += "f " + corner(i, j) + corner(i + 1, j) + corner(i + 1, j + 1) +
                   corner(i, j + 1) + "\n";
        }
    return obj;
}

/// Radiance 1 from all that the camera sees.
inline std::string shiningWall(double distance, double halfWidth) {
    return material("shine", black, 1.0) +
           mesh("rectangle", "shine",
                "{scale = " + number(halfWidth) + "}, {translate = [0, 0, " + number(-distance) +
                    "]}");
}

inline const char* const kinds[] = {"pt", "lt", "bdpt"};
inline const std::string atOrigin = "from = [0, 0, 0]\nto = [0, 0, -1]\n";

/// Of light tracing, and of path tracing with `pathSamples` (0: as many), against bidirectional
/// path tracing.
inline void checkAgreement(const LoadedScene& loaded, std::uint32_t samples, double bound,
                           std::uint32_t pathSamples = 0) {
    const auto reference = goodMeans(loaded, "bdpt", samples, 12, 1001);
    checkRatio(goodMeans(loaded, "lt", samples), reference, 1.0, bound);
    checkRatio(goodMeans(loaded, "pt", pathSamples > 0 ? pathSamples : samples), reference, 1.0,
               bound);
}

/// Of all three with the field that the camera's rays weigh. Of light paths most miss the film:
/// they take more samples and are known to `lightBound`.
inline void checkUniform(const LoadedScene& loaded, double bound = 0.03,
                         std::uint32_t lightSamples = 96, double lightBound = 0.06) {
    const std::vector<double> field = uniformField(loaded);
    checkRatio(goodMeans(loaded, "pt", 16), field, 1.0, bound);
    checkRatio(goodMeans(loaded, "bdpt", 16), field, 1.0, bound);
    checkRatio(goodMeans(loaded, "lt", lightSamples), field, 1.0, lightBound);
}

inline std::string thinLens(const std::string& place, double fNumber, const std::string& focus,
                            double focalMm = 50.0) {
    return "[camera]\nmodel = \"thin-lens\"\nsensor_width_mm = 36\nfocal_length_mm = " +
           number(focalMm) + "\nf_number = " + number(fNumber) + "\nfocus_distance = " + focus +
           "\n" + place;
}
inline std::string pinhole(const std::string& place, double fov = 50.0) {
    return "[camera]\nfov = " + number(fov) + "\n" + place;
}

}  // namespace etendue
