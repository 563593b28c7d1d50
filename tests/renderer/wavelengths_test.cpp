#include "renderer/wavelengths.h"

#include <doctest/doctest.h>

#include <cmath>

#include "renderer/colorimetry.h"
#include "tests/support/scenes.h"

using namespace etendue;

namespace {

/// The colour of `lanes(wavelengths)`, by the midpoint rule over the sample's random number: the
/// curves are straight between nodes 5 nm apart, so the rule's steps meet the nodes.
template <class Lanes>
Vec3d colorOf(const Lanes& lanes) {
    constexpr int count = 6000;
    Vec3d xyz;
    for (int i = 0; i < count; ++i) {
        const SpectralSample sample =
            sampleWavelengths((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
        const Spectrum onFilm = sample.onFilm(lanes(sample.wavelengths));
        xyz += Vec3d{onFilm[0], onFilm[1], onFilm[2]} / count;
    }
    return rec709FromXyz(xyz);
}

}  // namespace

TEST_CASE("Colorimetry: D65 is Rec. 709's white, and the matrices are inverse") {
    Vec3d xyz;
    for (double nm = 380.0; nm <= 780.0; nm += 1.0) xyz += xyzMatching(nm) * d65(nm);
    const double sum = xyz.x + xyz.y + xyz.z;
    // The analytic curves are within one in a hundred of the tables.
    CHECK(xyz.x / sum == doctest::Approx(0.3127).epsilon(0.005));
    CHECK(xyz.y / sum == doctest::Approx(0.3290).epsilon(0.005));
    const Vec3d back = rec709FromXyz(xyzFromRec709({0.2, 0.5, 0.9}));
    CHECK(length(back - Vec3d{0.2, 0.5, 0.9}) < 1e-12);
}

TEST_CASE("Wavelengths: four of them, a quarter of the range apart, each uniform over it") {
    for (const float u : {0.0f, 0.1f, 0.3f, 0.77f, 0x1.fffffep-1f}) {
        const Wavelengths w = sampleWavelengths(u).wavelengths;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            CHECK(w.nm[lane] >= 400.0f);
            CHECK(w.nm[lane] <= 700.0f);
            const float apart = w.nm[(lane + 1) % 4] - w.nm[lane];
            CHECK((apart == doctest::Approx(75.0).epsilon(1e-5) ||
                   apart == doctest::Approx(-225.0).epsilon(1e-5)));
        }
    }
}

TEST_CASE("Wavelengths: the primaries' spectra are positive and sum to one") {
    for (int i = 0; i < 1000; ++i) {
        const Wavelengths w = sampleWavelengths(static_cast<float>(i) / 1000.0f).wavelengths;
        for (int lane = 0; lane < 4; ++lane) {
            double sum = 0.0;
            for (const Spectrum& primary : w.primaries) {
                CHECK(primary[lane] >= 0.0f);
                sum += static_cast<double>(primary[lane]);
            }
            CHECK(sum == doctest::Approx(1.0).epsilon(1e-6));
        }
    }
}

TEST_CASE("Wavelengths: a colour's spectrum has that colour") {
    for (const Vec3 c : {Vec3{1, 1, 1}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1},
                         Vec3{0.2f, 0.7f, 0.1f}, Vec3{30, 2, 400}}) {
        const Vec3d back =
            colorOf([&](const Wavelengths& w) { return w.lanesOf(rgb(c.x, c.y, c.z)); });
        const double scale = static_cast<double>(maxComponent(c));
        // The trapezoidal rule over products of straight lines errs by their curvature.
        for (int i = 0; i < 3; ++i) CHECK(std::abs(back[i] - double{c[i]}) < 2e-3 * scale);
    }
}

TEST_CASE("Spectral render: light seen directly, and once reflected, has its RGB colour") {
    const std::string scene =
        "[film]\nwidth = 8\nheight = 8\n[estimator]\nmax_depth = 2\n[camera]\nfrom = [0, 1, 0]\n"
        "to = [0, 0, 0]\nup = [0, 0, 1]\nfov = 5\n"
        "[[material]]\nname = \"teal\"\ncolor = [0.1, 0.5, 0.6]\n"
        "[[mesh]]\nshape = \"rectangle\"\nmaterial = \"teal\"\n"
        "transform = [{scale = 9}, {rotate = [1, 0, 0, -90]}]\n"
        "[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";
    for (const char* kind : {"pt", "bdpt"}) {
        const LoadedScene loaded =
            sceneFromText(scene, {"film.color=spectral", std::string("estimator.kind=") + kind});
        const std::vector<float> pixels = renderPixels(loaded, 2048, 1);
        Vec3d mean;
        for (std::size_t i = 0; i < pixels.size(); i += 3)
            mean += Vec3d{pixels[i], pixels[i + 1], pixels[i + 2]} *
                    (3.0 / static_cast<double>(pixels.size()));
        // 131072 samples of spread below one.
        CHECK(std::abs(mean.x - 0.1) < 0.006);
        CHECK(std::abs(mean.y - 0.5) < 0.006);
        CHECK(std::abs(mean.z - 0.6) < 0.006);
    }
}
