// Settings at the ends of their ranges: every estimator takes every sample there, sees light where
// there is light, and sees what the others or a closed form say.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/renderer/small_scenes.h"

using namespace etendue;

namespace {

void checkThinLens(double fNumber, const std::string& focus, double focalMm, double wall) {
    checkUniform(sceneFromText(film() + thinLens(atOrigin, fNumber, focus, focalMm) +
                               shiningWall(wall, wall + 0.04)));
    checkAgreement(sceneFromText(film() + thinLens(standing, fNumber, focus, focalMm) + room()), 48,
                   0.15);
}

/// All lengths times `scale`, those of the lens times `lensScale`.
std::string scaled(const std::string& camera, double scale, double lensScale = 1.0) {
    const auto at = [&](double value) { return number(value * scale); };
    return film() + "[camera]\n" + camera + "\nfrom = [" + at(0.2) + ", " + at(1.0) + ", " +
           at(3.9) + "]\nto = [0, " + at(0.9) + ", 0]\n" +
           (camera.find("thin-lens") == std::string::npos
                ? ""
                : "focal_length_mm = " + number(50 * lensScale) + "\nsensor_width_mm = " +
                      number(36 * lensScale) + "\nfocus_distance = " + at(3.4) + "\n") +
           room(scale);
}

/// The same numbers draw the same paths but for rounding: the noise cancels.
void checkScale(double scale) {
    const LoadedScene one = sceneFromText(scaled("fov = 50", 1.0));
    const LoadedScene other = sceneFromText(scaled("fov = 50", scale));
    for (const char* kind : kinds) {
        CAPTURE(std::string(kind));
        const auto a = goodMeans(other, kind, 16), b = goodMeans(one, kind, 16);
        std::vector<double> ratios;
        for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
        checkMean(ratios, 1.0, 0.01);
    }
}

}  // namespace

TEST_CASE("Extremes: a thin lens at f/0.7") { checkThinLens(0.7, "1", 50.0, 1.2); }

TEST_CASE("Extremes: a thin lens at f/64") { checkThinLens(64.0, "1", 50.0, 1.2); }

TEST_CASE("Extremes: a thin lens focused at 10 cm") { checkThinLens(1.4, "0.1", 20.0, 0.08); }

TEST_CASE("Extremes: a thin lens focused at infinity") { checkThinLens(1.4, "inf", 20.0, 0.08); }

TEST_CASE("Extremes: a scene of 1e-4 times the size") { checkScale(1e-4); }

TEST_CASE("Extremes: a scene of 1e6 times the size") { checkScale(1e6); }

TEST_CASE("Extremes: a scene of 1e-4 times the size through a lens of 1e-4 times the size") {
    checkAgreement(sceneFromText(scaled("model = \"thin-lens\"\nf_number = 2", 1e-4, 1e-4)), 48,
                   0.1);
}

TEST_CASE("Extremes: a scene of 1e6 times the size through a lens as it is") {
    checkAgreement(sceneFromText(scaled("model = \"thin-lens\"\nf_number = 2", 1e6)), 48, 0.15);
}

TEST_CASE("Extremes: a lamp of radius 1e-6 lights as a point does") {
    // At the origin, where floats can tell its corners apart, and out of the picture.
    const auto lit = [](const std::string& light) {
        return film() + pinhole("from = [0.2, 0.3, 3]\nto = [0, -1.2, -0.5]\n", 30.0) +
               material("grey", grey) +
               mesh("rectangle", "grey",
                    "{scale = 3}, {rotate = [1, 0, 0, -90]}, {translate = [0, -1, 0]}") +
               mesh("rectangle", "grey", "{scale = 3}, {translate = [0, 0, -1]}") + light;
    };
    const LoadedScene sphere = sceneFromText(
        lit(material("tiny", black, 1e12) + mesh("sphere", "tiny", "{scale = 1e-6}")));
    REQUIRE(sphere.scene->lights().size() == 1);
    // A convex body's mean silhouette is a quarter of its surface (Cauchy): over all directions its
    // intensity is that of the power.
    const std::string i =
        number(static_cast<double>(sphere.scene->lights()[0].power()) / (4.0 * std::numbers::pi));
    const LoadedScene point =
        sceneFromText(lit("[[light]]\ntype = \"point\"\nposition = [0, 0, 0]\nintensity = [" + i +
                          ", " + i + ", " + i + "]\n"));
    for (const char* kind : kinds) {
        CAPTURE(std::string(kind));
        checkRatio(goodMeans(sphere, kind, 64), goodMeans(point, kind, 64, 12, 1001), 1.0, 0.05);
    }
}

TEST_CASE("Extremes: an emission of 1e7 is 1e7 times that of 1") {
    const std::string view = film() + thinLens(standing, 2.0, "3.4");
    const LoadedScene one = sceneFromText(view + room(1.0, 1.0));
    const LoadedScene bright = sceneFromText(view + room(1.0, 1e7));
    for (const char* kind : kinds) {
        CAPTURE(std::string(kind));
        const auto a = goodMeans(bright, kind, 16, 4), b = goodMeans(one, kind, 16, 4);
        // The same paths: what differs is how floats round, some ten times a path.
        for (std::size_t i = 0; i < a.size(); ++i)
            CHECK(a[i] == doctest::Approx(1e7 * b[i]).epsilon(1e-5).scale(0.0));
    }
}

TEST_CASE("Extremes: surfaces 1e-6 apart, in a furnace") {
    // A shining wall, and before it a sheet of rough glass as thick as its distance from the wall.
    // All around is radiance 1, the wall's and the sky's: the sheet must not be seen.
    const std::string scene =
        film(24) + pinhole("from = [0, 0, 1]\nto = [0, 0, 0]\n") + material("wall", black, 1.0) +
        "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nroughness = 0.5\n"
        "[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n" +
        mesh("rectangle", "wall", "{scale = 0.7}") +
        mesh("box", "glass", "{scale = [0.6, 0.6, 0.5e-6]}, {translate = [0, 0, 1.5e-6]}");
    const LoadedScene loaded = sceneFromText(scene);
    const std::vector<double> field = uniformField(loaded);
    checkRatio(goodMeans(loaded, "pt", 16), field, 1.0, 0.01);
    checkRatio(goodMeans(loaded, "bdpt", 16), field, 1.0, 0.05);
    // Of its light paths few end in the picture.
    checkRatio(goodMeans(loaded, "lt", 96), field, 1.0, 0.25);
}

TEST_CASE("Extremes: a camera inside glass") {
    // Radiance in glass of index n is n² times that outside. From the middle of a sphere no ray is
    // totally reflected for ever.
    const auto inside = [](const std::string& roughness) {
        return sceneFromText(
            film(24) + pinhole("from = [0, 0, 0]\nto = [0, 0, 1]\n", 90.0) +
            "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nior = 1.5\nroughness = " +
            roughness + "\n[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n" +
            mesh("sphere", "glass", "{scale = 0.5}"));
    };
    const LoadedScene rough = inside("1"), smooth = inside("0");
    const std::vector<double> field = uniformField(rough);
    for (const char* kind : {"pt", "bdpt"}) {
        CAPTURE(std::string(kind));
        checkRatio(goodMeans(smooth, kind, 16), field, 1.5 * 1.5, 0.01);
        checkRatio(goodMeans(rough, kind, 16), field, 1.5 * 1.5, 0.05);
    }
    checkRatio(goodMeans(rough, "lt", 128), field, 1.5 * 1.5, 0.1);
}

TEST_CASE("Extremes: the light behind the camera") {
    const std::string behind =
        "{scale = 0.4}, {rotate = [0, 1, 0, 180]}, {translate = [0.5, 1.5, 6]}";
    checkAgreement(sceneFromText(film() + thinLens(standing, 2.0, "3.4") + room(1.0, 9.0, behind)),
                   128, 0.1);
}

TEST_CASE("Extremes: a point light on the lens' axis") {
    // In focus, and before it; all of its light lands on the film. Through an aperture point at
    // radius r the film's element ds shows (d/v)² ds at the light's distance d, where L ds' cosθ is
    // the intensity: equation (1) is then (v/d)² I ⟨J / cosθ⟩ / ⟨J⟩, J = cos⁴ between the aperture
    // and the sensor's centre, cos²= v² / (v² + r²), and cosθ = d / √(d² + r²).
    constexpr double focalM = 0.05, focusM = 2.0, pixelM = 0.036 / 12, pixels = 12 * 8;
    const double v = 1.0 / (1.0 / focalM - 1.0 / focusM);
    for (const double fNumber : {1.0, 64.0})
        for (const double distance : {2.0, 1.7}) {
            CAPTURE(fNumber);
            CAPTURE(distance);
            const LoadedScene loaded =
                sceneFromText(film() + thinLens(atOrigin, fNumber, number(focusM + v)) +
                              "[[light]]\ntype = \"point\"\nposition = [0, 0, " +
                              number(-distance) + "]\nintensity = [1, 1, 1]\n");
            double weighted = 0.0, weights = 0.0;
            for (double t = 5e-4; t < 1.0; t += 1e-3) {  // r² is uniform over the disc
                const double squared = t * std::pow(0.5 * focalM / fNumber, 2);
                const double j = std::pow(1.0 + squared / (v * v), -2);
                weights += j;
                weighted += j * std::sqrt(1.0 + squared / (distance * distance));
            }
            const double expected =
                std::pow(v / (pixelM * distance), 2) * weighted / weights / pixels;
            for (const char* kind : {"lt", "bdpt"}) {
                CAPTURE(std::string(kind));
                checkMean(goodMeans(loaded, kind, 8), expected, 0.01);
            }
        }
}

TEST_CASE("Extremes: a floor seen at a grazing angle") {
    // From 1 cm above its plane and three metres away: 0.1° to 0.2°.
    checkAgreement(
        sceneFromText(
            film() + pinhole("from = [0, 0.01, 4]\nto = [0, 0.005, 0]\n", 2.0) +
            material("grey", grey) + material("lamp", black, 9.0) +
            mesh("rectangle", "grey", "{rotate = [1, 0, 0, -90]}") +
            mesh("rectangle", "lamp", "{rotate = [1, 0, 0, 90]}, {translate = [0, 2, 0]}")),
        128, 0.15);
}

TEST_CASE("Extremes: shading normals at a grazing angle") {
    // 85° off the floor's.
    const TemporaryFolder folder;
    folder.write("bumps.obj", bumpyFloor(85.0));
    const LoadedScene loaded = loadScene(
        folder.write("scene.toml", film() + thinLens(standing, 2.0, "3.4") + room() +
                                       "[[mesh]]\nfile = \"bumps.obj\"\nmaterial = \"grey\"\n"
                                       "transform = [{translate = [0, 0.02, 0]}]\n"),
        {{}, 8});
    checkAgreement(loaded, 64, 0.1);
}
