// A uniform field through a lens that vignettes: no steps, and the same from both sides.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "tests/renderer/small_scenes.h"

using namespace etendue;

namespace {

std::string throughLens() {
    const std::string lenses =
        (std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses").string();
    return film() + "[camera]\nlens = \"" + lenses +
           "/double-gauss-50mm-f1.1.toml\"\nterms = 12\ndegree = 5\ndispersion = false\n" +
           atOrigin + shiningWall(1.5, 1.3);
}

}  // namespace

TEST_CASE("Estimators: vignetting falls steadily to the corner, without a step" *
          doctest::test_suite("statistical")) {
    const LoadedScene loaded = sceneFromText(throughLens());
    // A Fibonacci lattice errs by some of its points, wherever rims cut it.
    constexpr std::int64_t points = 28657, generator = 17711;
    constexpr int radii = 256;
    constexpr double latticeError = 8.0 / points;
    std::vector<double> profile;
    for (int r = 0; r <= radii; ++r) {
        const float along = static_cast<float>(r) / radii;
        const Vec2 film{6.0f + 6.0f * along, 4.0f + 4.0f * along};
        double sum = 0.0;
        for (std::int64_t i = 0; i < points; ++i) {
            const Vec2 u{(static_cast<float>(i) + 0.5f) / points,
                         static_cast<float>(i * generator % points) / points};
            const auto ray = loaded.camera->sampleRay(film, u, {});
            if (ray) sum += static_cast<double>(ray->weight);
        }
        profile.push_back(sum / points);
    }
    CHECK(profile.front() == doctest::Approx(1.0).epsilon(latticeError));
    CHECK(profile.back() < 0.2);  // there is something to see
    for (std::size_t r = 1; r < profile.size(); ++r) {
        CAPTURE(r);
        CHECK(profile[r] <= profile[r - 1] + latticeError);
        // A step shows as a difference that a neighbour does not share. Slopes may break, where a
        // rim begins to cut: on so fine a grid that is half of it.
        if (r + 1 < profile.size())
            CHECK(std::abs(profile[r + 1] - 2.0 * profile[r] + profile[r - 1]) < 0.002);
    }
}

TEST_CASE("Estimators: …and light tracing sees it as path tracing does" *
          doctest::test_suite("statistical")) {
    LoadedScene loaded = sceneFromText(throughLens());
    const auto pictures = [&](const char* kind, std::uint32_t samples, std::uint64_t firstSeed) {
        loaded.estimator.kind = kind;
        std::vector<Picture> result;
        for (std::uint64_t seed = 0; seed < 16; ++seed)
            result.push_back(renderPixels(loaded, samples, firstSeed + seed, 2));
        return result;
    };
    const auto reference = pictures("pt", 256, 1);
    for (const char* kind : {"lt", "bdpt"}) {
        CAPTURE(std::string(kind));
        const PictureComparison comparison =
            comparePictures(pictures(kind, 256, 1001), reference, 12, 4);
        CAPTURE(comparison.smallestP);
        CAPTURE(comparison.relativeBias);
        CAPTURE(comparison.relativeBiasHalfWidth);
        CHECK(comparison.agree());
        CHECK(comparison.isEquivalent(0.03));
    }
}
