// What is left out of a comparison of estimators, and what is not.
#include "tools/path_classes.h"

#include <doctest/doctest.h>

#include <array>
#include <numeric>

#include "lens/lens_model.h"
#include "renderer/render.h"
#include "tests/support/scenes.h"
#include "tests/tools/every_material_scene.h"

using namespace etendue;

namespace {

constexpr std::uint32_t samples = 64;

struct Outcome {
    double mean;
    LeftOutMeans leftOut;
};

/// The mean of a picture of what `self` and `other` both make, and what was left out.
Outcome renderCommon(const LoadedScene& loaded, const std::string& self, const std::string& other,
                     bool keepsByChance = true) {
    const auto estimator = makeCommonPaths(*loaded.scene, *loaded.camera,
                                           {loaded.estimator, parseContender(self).value(),
                                            parseContender(other).value(), keepsByChance});
    Film film(loaded.film.fullFrame(), {}, loaded.film.color);
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    RenderSettings render;
    render.samples = samples;
    render.threads = 2;
    etendue::render(*loaded.scene, *loaded.camera, *estimator, filter, film, render, {});
    const std::vector<float> pixels = film.channels().front().pixels;
    const double sum = std::accumulate(pixels.begin(), pixels.end(), 0.0);
    return {sum / static_cast<double>(pixels.size()),
            estimator->leftOut(samples, pixels.size() / 3, loaded.film.color)};
}

/// A thin lens that does not find what lies on one side of its axis.
class HalfBlindLens final : public LensModel {
public:
    std::optional<ExitRay> trace(SensorPoint sensor, AperturePoint aperture,
                                 double wavelengthNm) const override {
        return lens_->trace(sensor, aperture, wavelengthNm);
    }
    std::optional<SensorPoint> connect(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                       double wavelengthNm) const override {
        if (targetMm.x() > 0.0) return {};
        return lens_->connect(targetMm, aperture, wavelengthNm);
    }
    AperturePoint sampleAperture(Eigen::Vector2d u) const override {
        return lens_->sampleAperture(u);
    }
    double apertureAreaMm2() const override { return lens_->apertureAreaMm2(); }

private:
    std::unique_ptr<LensModel> lens_ = makeThinLens(30.0, 3400.0, 8.0);
};

double total(const LeftOutMeans& means) { return std::accumulate(means.begin(), means.end(), 0.0); }

double of(const Outcome& outcome, PathClass pathClass) {
    return outcome.leftOut[static_cast<std::size_t>(pathClass)];
}

}  // namespace

TEST_CASE("Path classes: what is left out and what is not are all of the picture") {
    for (const std::string& color : {std::string("film.color=auto"), dispersiveGlass}) {
        CAPTURE(color);
        const LoadedScene loaded = sceneFromText(everyMaterialScene, {color});
        // What bdpt:s0t4 makes are all paths of three edges that path tracing does.
        for (const auto& names : {std::array<std::string, 3>{"pt", "lt", "pt"},
                                  {"lt", "pt", "lt"},
                                  {"bdpt", "pt", "bdpt"},
                                  {"bdpt", "lt", "bdpt"},
                                  {"pt", "bdpt", "pt"},
                                  {"pt", "bdpt:s2t2", "bdpt:s0t4"},
                                  {"pt", "bdpt:s3t1", "bdpt:s0t4"},
                                  {"bdpt", "bdpt:s1t3", "bdpt:s0t4"}}) {
            const std::string self = names[0], other = names[1], whole = names[2];
            CAPTURE(self);
            CAPTURE(other);
            const Outcome all = renderCommon(loaded, self, whole);
            const Outcome common = renderCommon(loaded, self, other, other.size() > 4);
            CHECK(total(all.leftOut) == 0.0);
            CHECK(total(common.leftOut) > 0.01 * all.mean);
            // The same samples, summed in another order as floats.
            CHECK((common.mean + total(common.leftOut)) / all.mean ==
                  doctest::Approx(1).epsilon(1e-4));
        }
    }
}

TEST_CASE("Path classes: each is found where a scene has it, and nowhere else") {
    const LoadedScene lamps = sceneFromText(everyMaterialFrame + everyMaterialRoom + lampAndSky);
    const Outcome fromCamera = renderCommon(lamps, "pt", "lt");
    CHECK(of(fromCamera, PathClass::mirrorFirst) > 0.01 * fromCamera.mean);
    // A thin lens and its connections are exact inverses.
    CHECK(of(fromCamera, PathClass::lostByLens) == 0.0);
    CHECK(total(renderCommon(lamps, "lt", "pt").leftOut) == 0.0);
    CHECK(total(renderCommon(lamps, "bdpt", "pt").leftOut) == 0.0);

    const std::string matte = everyMaterialFrame +
                              "[[material]]\nname = \"m\"\ncolor = [0.5, 0.5, 0.5]\n[[mesh]]\n"
                              "shape = \"sphere\"\nmaterial = \"m\"\n";
    const LoadedScene points = sceneFromText(matte + pointAndSun);
    CHECK(total(renderCommon(points, "pt", "lt").leftOut) == 0.0);
    // The point itself is in view, and there is no mirror.
    const Outcome fromLight = renderCommon(points, "lt", "pt");
    CHECK(of(fromLight, PathClass::mirroredPoint) == total(fromLight.leftOut));
    CHECK(of(fromLight, PathClass::mirroredPoint) > 0.0);
    // What a camera path met of it is no connection's to make: bdpt leaves out the same light.
    const Outcome fromBoth = renderCommon(points, "bdpt", "pt");
    CHECK(of(fromBoth, PathClass::mirroredPoint) / of(fromLight, PathClass::mirroredPoint) ==
          doctest::Approx(1).epsilon(0.05));
}

TEST_CASE("Path classes: light that the lens does not find by connecting is left out, and told") {
    LoadedScene loaded = sceneFromText(everyMaterialScene);
    loaded.camera =
        std::make_unique<Camera>(std::make_shared<HalfBlindLens>(), loaded.camera->settings());
    const Outcome all = renderCommon(loaded, "pt", "pt"), common = renderCommon(loaded, "pt", "lt");
    const double lost = of(common, PathClass::lostByLens);
    CHECK(lost > 0.2 * all.mean);
    CHECK(lost < 0.8 * all.mean);
    // What is left is what light tracing finds. Each mean is of 16 × 12 × 64 samples of a relative
    // spread below 10: 0.09 is their standard error, at most.
    CHECK(renderCommon(loaded, "lt", "pt").mean / common.mean == doctest::Approx(1).epsilon(0.1));
}

TEST_CASE("Path classes: a path that belongs to two of them is left out if either is") {
    // A wall of mirror, and behind the camera a floor and a wall that are seen in it and lit by it.
    const LoadedScene loaded = sceneFromText(everyMaterialFrame + silverMirror + R"(
[[mesh]]
shape = "rectangle"
material = "mirror"
transform = [{scale = 20}, {translate = [0, 0, -1]}]
[[material]]
name = "floor"
color = [0.5, 0.5, 0.5]
[[mesh]]
shape = "rectangle"
material = "floor"
transform = [{scale = 3}, {rotate = [1, 0, 0, -90]}, {translate = [0, 0, 8]}]
[[mesh]]
shape = "rectangle"
material = "floor"
transform = [{scale = 3}, {rotate = [1, 0, 0, 180]}, {translate = [0, 3, 11]}]
[[light]]
type = "point"
position = [0, 1, 4.8]
intensity = [30, 30, 30]
)");
    const Outcome againstLight = renderCommon(loaded, "bdpt", "lt");
    CHECK(againstLight.mean == 0.0);
    CHECK(of(againstLight, PathClass::mirrorFirst) == total(againstLight.leftOut));
    const Outcome againstPath = renderCommon(loaded, "bdpt", "pt");
    CHECK(of(againstPath, PathClass::mirroredPoint) > 0.001 * againstPath.mean);
}

TEST_CASE("Path classes: lamps met by chance are left out of all three, and no others") {
    // A wall of mirror behind a matte floor, and a lamp that the mirror throws on the floor.
    const std::string scene = everyMaterialFrame + silverMirror + R"(
[[mesh]]
shape = "rectangle"
material = "mirror"
transform = [{scale = 3}, {translate = [0, 1, -2]}]
[[material]]
name = "floor"
color = [0.5, 0.5, 0.5]
[[mesh]]
shape = "rectangle"
material = "floor"
transform = [{scale = 2}, {rotate = [1, 0, 0, -90]}]
[[material]]
name = "lamp"
color = [0, 0, 0]
emission = [9, 8, 6]
[[mesh]]
name = "lamp"
shape = "sphere"
material = "lamp"
transform = [{scale = 0.15}, {translate = [0.3, 0.8, 0]}]
)";
    const LoadedScene small = sceneFromText(scene);
    const Outcome all = renderCommon(small, "bdpt", "pt", false);
    CHECK(of(all, PathClass::caustic) > 0.0);
    CHECK(of(all, PathClass::smallLamp) > 0.0);
    CHECK(of(renderCommon(small, "bdpt", "bdpt:s0t4", false), PathClass::caustic) > 0.0);
    CHECK(of(renderCommon(small, "bdpt", "bdpt:s0t3", false), PathClass::smallLamp) > 0.0);
    for (const std::string pt : {"pt", "bdpt:s0t4"})
        CHECK(total(renderCommon(small, "bdpt", pt, true).leftOut) == 0.0);
    CHECK(total(renderCommon(small, "bdpt", "bdpt", false).leftOut) == 0.0);
    CHECK(of(renderCommon(small, "lt", "bdpt", false), PathClass::caustic) == 0.0);
    // Without a mirror there is no caustic; from near the lamp is large.
    const LoadedScene matte = sceneFromText(scene, {"material.mirror.roughness=0.3"});
    const Outcome fromCamera = renderCommon(matte, "pt", "bdpt", false);
    CHECK(of(fromCamera, PathClass::caustic) == 0.0);
    CHECK(of(fromCamera, PathClass::smallLamp) == total(fromCamera.leftOut));
    CHECK(of(fromCamera, PathClass::smallLamp) > 0.0);
    const LoadedScene near = sceneFromText(scene, {"camera.from=[0.3, 1, 1.2]"});
    CHECK(of(renderCommon(near, "pt", "bdpt", false), PathClass::smallLamp) == 0.0);
}

TEST_CASE("Path classes: a contender's name is what it was read from") {
    for (const std::string name : {"pt", "lt", "bdpt", "bdpt:s0t2", "bdpt:s2t11"})
        CHECK(nameOf(parseContender(name).value()) == name);
    for (const std::string text : {"", "vcm", "pt:s1t2", "bdpt:", "bdpt:s1", "bdpt:t1", "bdpt:s1t0",
                                   "bdpt:s0t1", "bdpt:s01t2", "bdpt:s1t2,s2t1", "bdpt:s1t2x"}) {
        CAPTURE(text);
        CHECK_FALSE(parseContender(text));
    }
}

TEST_CASE("Path classes: each estimator is blind to what it is, and bdpt to none of it") {
    const Contender pt{"pt", {}}, lt{"lt", {}}, bdpt{"bdpt", {}};
    const Contender toLens{"bdpt", Technique{2, 1}}, toLight{"bdpt", Technique{0, 3}};
    for (std::size_t i = 0; i < pathClassCount; ++i) {
        CHECK(canMake(bdpt, static_cast<PathClass>(i)));
        CHECK_FALSE(makesByChance(bdpt, static_cast<PathClass>(i)));
        CHECK_FALSE(makesByChance(lt, static_cast<PathClass>(i)));
        CHECK_FALSE(describe(static_cast<PathClass>(i)).empty());
    }
    for (const Contender& blind : {lt, toLens}) {
        CHECK_FALSE(canMake(blind, PathClass::mirrorFirst));
        CHECK_FALSE(canMake(blind, PathClass::lostByLens));
    }
    CHECK_FALSE(canMake(pt, PathClass::mirroredPoint));
    for (const Contender& blind : {pt, toLight}) {
        CHECK(makesByChance(blind, PathClass::caustic));
        CHECK(makesByChance(blind, PathClass::smallLamp));
    }
}
