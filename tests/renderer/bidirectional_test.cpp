// Path tracing, light tracing and bidirectional path tracing estimate one picture.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "statistics/statistics.h"
#include "tests/support/scenes.h"

using namespace etendue;

namespace {

constexpr int width = 24, tileSize = 8;
constexpr std::uint64_t seeds = 16;

std::string sceneWith(const std::string& camera, const std::string& rest) {
    return "[film]\nwidth = 24\nheight = 16\n[estimator]\nmax_depth = 5\n[camera]\n" + camera +
           rest;
}

const std::string pinhole =
    "model = \"pinhole\"\nfrom = [0.2, 1, 3.9]\nto = [0, 0.9, 0]\nfov = 50\n";
const std::string thinLens =
    "model = \"thin-lens\"\nfrom = [0.2, 1, 3.9]\nto = [0, 0.9, 0]\nfov = 50\nf_number = "
    "0.4\nfocus_distance = 3.4\n";

/// A floor, a back wall and a block of given materials.
std::string room(const std::string& materials) {
    return materials + R"(
[[mesh]]
shape = "rectangle"
material = "floor"
transform = [{scale = 3}, {rotate = [1, 0, 0, -90]}]
[[mesh]]
shape = "rectangle"
material = "wall"
transform = [{scale = 3}, {translate = [0, 1, -1]}]
[[mesh]]
shape = "sphere"
segments = 12
material = "ball"
transform = [{scale = 0.6}, {translate = [0.3, 0.6, 0]}]
)";
}

const std::string areaLamp = R"(
[[material]]
name = "lamp"
color = [0, 0, 0]
emission = [9, 8, 6]
[[mesh]]
shape = "rectangle"
material = "lamp"
transform = [{scale = 0.4}, {rotate = [1, 0, 0, 90]}, {translate = [-0.4, 2.2, 0.3]}]
)";

const std::string matte =
    "[[material]]\nname = \"floor\"\ncolor = [0.7, 0.6, 0.5]\n"
    "[[material]]\nname = \"wall\"\ncolor = [0.4, 0.5, 0.7]\n"
    "[[material]]\nname = \"ball\"\ncolor = [0.6, 0.6, 0.6]\n";
const std::string glossy =
    "[[material]]\nname = \"floor\"\ntype = \"plastic\"\ncolor = [0.5, 0.4, 0.3]\nroughness = 0.5\n"
    "[[material]]\nname = \"wall\"\ntype = \"conductor\"\nmetal = \"gold\"\nroughness = 0.6\n"
    "[[material]]\nname = \"ball\"\ntype = \"dielectric\"\nroughness = 0.5\n";
const std::string mirrors =
    "[[material]]\nname = \"floor\"\ncolor = [0.5, 0.5, 0.5]\n"
    "[[material]]\nname = \"wall\"\ntype = \"conductor\"\nmetal = \"silver\"\nroughness = 0\n"
    "[[material]]\nname = \"ball\"\ntype = \"dielectric\"\n";

std::vector<std::vector<float>> pictures(const LoadedScene& loaded, std::uint32_t samples,
                                         std::uint64_t firstSeed) {
    std::vector<std::vector<float>> result;
    for (std::uint64_t seed = 0; seed < seeds; ++seed)
        result.push_back(renderPixels(loaded, samples, firstSeed + seed, 2));
    return result;
}

/// `bound`: of the relative bias, with its 99 % confidence interval.
void checkAgreement(const std::string& scene, const std::vector<std::string>& estimators,
                    std::uint32_t samples, double bound) {
    const auto reference = pictures(sceneFromText(scene), samples, 1);
    std::uint64_t firstSeed = 1000;
    for (const std::string& estimator : estimators) {
        CAPTURE(estimator);
        const LoadedScene loaded =
            sceneFromText(scene, {"estimator.kind=" + estimator.substr(0, estimator.find(' '))});
        const auto other = pictures(loaded, samples, firstSeed += 1000);
        const PictureComparison comparison = comparePictures(other, reference, width, tileSize);
        CAPTURE(comparison.smallestP);
        CAPTURE(comparison.relativeBias);
        CAPTURE(comparison.relativeBiasHalfWidth);
        CHECK(comparison.agree());
        CHECK(comparison.isEquivalent(bound));
    }
}

}  // namespace

TEST_CASE("Estimators: pt, lt and bdpt agree on matte surfaces under an area light" *
          doctest::test_suite("slow")) {
    for (const std::string& camera : {pinhole, thinLens})
        checkAgreement(sceneWith(camera, room(matte) + areaLamp), {"lt", "bdpt"}, 64, 0.05);
}

TEST_CASE("Estimators: …on glossy ones" * doctest::test_suite("statistical")) {
    checkAgreement(sceneWith(thinLens, room(glossy) + areaLamp), {"lt", "bdpt"}, 128, 0.05);
}

TEST_CASE("Estimators: …by mirrors and glass, where the light has extent" *
          doctest::test_suite("statistical")) {
    checkAgreement(sceneWith(thinLens, room(mirrors) + areaLamp), {"bdpt"}, 128, 0.08);
}

TEST_CASE("Estimators: …under each kind of light without extent, and from far away" *
          doctest::test_suite("statistical")) {
    const std::string spot =
        "type = \"spot\"\nposition = [-0.5, 2, 1]\ndirection = [0.3, -1, -0.4]\n"
        "intensity = [9, 8, 7]\nouter_angle = 50\n";
    const std::string lights[] = {
        "type = \"point\"\nposition = [-0.5, 2, 1]\nintensity = [3, 4, 5]\n",
        spot,
        "type = \"directional\"\ndirection = [0.3, -1, -0.6]\nirradiance = [2, 2, 3]\n",
        "type = \"constant\"\nradiance = [1, 1.5, 2]\n",
    };
    for (const std::string& light : lights) {
        CAPTURE(light);
        checkAgreement(sceneWith(thinLens, room(matte) + "[[light]]\n" + light), {"lt", "bdpt"},
                       128, 0.08);
    }
}

TEST_CASE("Estimators: …through lenses of glass that part the colours" *
          doctest::test_suite("statistical")) {
    const std::string lenses =
        (std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses").string();
    struct Case {
        const char* lens;
        const char* more;
        std::uint32_t samples;
        double bound;
    };
    for (const Case& c : {
             Case{"petzval-50mm.toml", "terms = 24\ndegree = 9\n", 64, 0.05},
             Case{"double-gauss-50mm-f1.1.toml", "terms = 24\ndegree = 9\nf_number = 2\n", 64,
                  0.05},
             Case{"fisheye-10mm.toml", "terms = 24\ndegree = 9\nsensor_width_mm = 22\n", 256, 0.08},
             // A trace for every step of every search: as few as will do.
             Case{"double-gauss-50mm-f1.1.toml", "representation = \"traced\"\nf_number = 4\n", 8,
                  0.15},
         }) {
        CAPTURE(std::string(c.lens));
        const std::string camera = "lens = \"" + lenses + "/" + c.lens +
                                   "\"\nfocus_distance = 3.4\nfrom = [0.2, 1, 3.9]\nto = [0, "
                                   "0.9, 0]\n" +
                                   c.more;
        checkAgreement(sceneWith(camera, room(matte) + areaLamp), {"lt", "bdpt"}, c.samples,
                       c.bound);
    }
}

const std::string prism = R"(
[[material]]
name = "flint"
type = "dielectric"
ior = 1.7
abbe_number = 8
[[mesh]]
shape = "box"
material = "flint"
transform = [{scale = [0.7, 0.5, 0.4]}, {rotate = [0, 1, 0, 35]}, {translate = [0.3, 0.9, 1.2]}]
)";

TEST_CASE("Estimators: …and through a prism" * doctest::test_suite("statistical")) {
    // Through the prism a camera path is left with its hero, and so is a light path.
    for (const std::string& camera : {thinLens, pinhole})
        checkAgreement(sceneWith(camera, room(matte) + areaLamp + prism), {"bdpt"}, 128, 0.08);
}

TEST_CASE("Estimators: …through such a lens and a prism, and by mirrors" *
          doctest::test_suite("statistical")) {
    const std::string lens =
        (std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses/petzval-50mm.toml")
            .string();
    const std::string camera = "lens = \"" + lens +
                               "\"\nterms = 24\ndegree = 9\nfocus_distance = 3.4\n"
                               "from = [0.2, 1, 3.9]\nto = [0, 0.9, 0]\n";
    checkAgreement(sceneWith(camera, room(matte) + areaLamp + prism), {"bdpt"}, 96, 0.08);
    checkAgreement(sceneWith(camera, room(mirrors) + areaLamp), {"bdpt"}, 96, 0.08);
    // In a bulb of such glass, which leaves each light path its hero, and camera paths theirs where
    // they look into it.
    checkAgreement(sceneWith(camera, room(matte) + R"(
[[material]]
name = "bulb"
type = "dielectric"
abbe_number = 8
[[material]]
name = "filament"
color = [0, 0, 0]
emission = [3, 3, 2]
[[mesh]]
shape = "sphere"
material = "bulb"
transform = [{scale = 0.6}, {translate = [-0.3, 2.2, 0.5]}]
[[mesh]]
shape = "sphere"
material = "filament"
transform = [{scale = 0.5}, {translate = [-0.3, 2.2, 0.5]}]
)"),
                   {"bdpt"}, 96, 0.08);
}

TEST_CASE("Estimators: a mirror that shines is seen once, by the camera's walk and the light's") {
    checkAgreement(sceneWith(thinLens, R"(
[[material]]
name = "shining mirror"
type = "conductor"
color = [0, 0, 0]
roughness = 0
emission = [2, 2, 2]
[[mesh]]
shape = "rectangle"
material = "shining mirror"
transform = [{scale = 9}]
)"),
                   {"bdpt"}, 32, 0.02);
}

TEST_CASE("Estimators: Sobol' numbers make the same picture, with less noise" *
          doctest::test_suite("statistical")) {
    const std::string scene = sceneWith(thinLens, room(matte) + areaLamp);
    for (const std::string estimator : {"pt", "lt", "bdpt"}) {
        CAPTURE(estimator);
        const auto picturesBy = [&](const std::string& sampler, std::uint64_t firstSeed) {
            return pictures(sceneFromText(scene, {"estimator.kind=" + estimator,
                                                  "estimator.sampler=" + sampler}),
                            64, firstSeed);
        };
        const auto independent = picturesBy("independent", 1), sobol = picturesBy("sobol", 1000);
        const PictureComparison comparison = comparePictures(sobol, independent, width, tileSize);
        CAPTURE(comparison.smallestP);
        CAPTURE(comparison.relativeBias);
        CHECK(comparison.agree());
        CHECK(comparison.isEquivalent(0.05));
        const double ratio =
            summarize(meansOf(independent)).variance / summarize(meansOf(sobol)).variance;
        CAPTURE(ratio);
        // F's 99th percentile at 15 and 15 degrees of freedom: more than chance brings about.
        CHECK(ratio > 3.52);
    }
}

TEST_CASE("Estimators: light that enters through the outer pupil makes the same picture" *
          doctest::test_suite("statistical")) {
    const std::string lenses =
        (std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses").string();
    for (const char* lens : {"fisheye-10mm.toml", "double-gauss-50mm-f1.1.toml"}) {
        CAPTURE(std::string(lens));
        const std::string scene =
            sceneWith("lens = \"" + lenses + "/" + lens +
                          "\"\nsensor_width_mm = 20\ndispersion = false\nfocus_distance = 3.4\n"
                          "from = [0.2, 1, 3.9]\nto = [0, 0.9, 0]\n",
                      room(matte) + areaLamp);
        const auto inner = pictures(sceneFromText(scene, {"estimator.kind=lt"}), 64, 1);
        const auto outer =
            pictures(sceneFromText(scene, {"estimator.kind=lt", "estimator.pupil_sampling=outer"}),
                     256, 1000);
        const PictureComparison comparison = comparePictures(outer, inner, width, tileSize);
        CAPTURE(comparison.relativeBias);
        CAPTURE(comparison.relativeBiasHalfWidth);
        CHECK(comparison.agree());
        CHECK(comparison.isEquivalent(0.05));
    }
}
