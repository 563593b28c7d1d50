// etendue replay shows the sample that etendue render takes.
#include <doctest/doctest.h>

#include <optional>
#include <sstream>

#include "renderer/parallel.h"
#include "tests/support/scenes.h"
#include "tests/tools/command_outcome.h"
#include "tests/tools/every_material_scene.h"

using namespace etendue;

namespace {

/// "key": [a, b, c] of a JSON text, as the floats that were printed.
Vec3 vectorIn(const std::string& json, const std::string& key) {
    const std::size_t at = json.rfind("\"" + key + "\": [");
    REQUIRE(at != std::string::npos);
    std::istringstream text(json.substr(json.find('[', at) + 1));
    std::array<double, 3> v{};
    char comma = 0;
    text >> v[0] >> comma >> v[1] >> comma >> v[2];
    REQUIRE(text);
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// Another estimator's samples, but for what they splat.
class WithoutSplats final : public Estimator {
public:
    explicit WithoutSplats(std::unique_ptr<Estimator> whole) : whole_(std::move(whole)) {}
    void takeSample(const View& view, SampleId id, SampleRequest request,
                    Sample& result) const override {
        whole_->takeSample(view, id, request, result);
        std::erase_if(result.contributions, [](const Contribution& c) { return c.isSplat; });
    }

private:
    std::unique_ptr<Estimator> whole_;
};

/// What `samples` samples add to one pixel, splats apart.
Vec3 renderedSum(const std::filesystem::path& scene, const std::vector<std::string>& overrides,
                 int x, int y, std::uint32_t samples) {
    const LoadedScene loaded = loadScene(scene, {overrides, 2});
    Film film({loaded.film.width, loaded.film.height, x, y, 1, 1}, {}, loaded.film.color);
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    RenderSettings settings;
    settings.samples = samples;
    settings.seed = 5;
    const WithoutSplats estimator(makeEstimator(loaded.estimator));
    render(*loaded.scene, *loaded.camera, estimator, filter, film, settings, {});
    return toFloat(film.state().colorSums[0].value());
}

}  // namespace

TEST_CASE("Replay: the sum that it prints is what the render adds to the pixel, to the bit" *
          doctest::test_suite("slow")) {
    const TemporaryFolder folder;
    const std::filesystem::path scene = folder.write("s.toml", everyMaterialScene);
    for (const std::string kind : {"pt", "bdpt"})
        for (const std::string& color : {std::string("film.color=auto"), dispersiveGlass}) {
            CAPTURE(kind);
            CAPTURE(color);
            const std::vector<std::string> overrides{"estimator.kind=" + kind, color};
            const std::string command = "replay " + scene.string() + " --seed 5 --json -s " +
                                        overrides[0] + " -s " + overrides[1] + " ";
            int lit = 0;
            for (const auto& [x, y] : {std::pair{4, 7}, {8, 8}}) {
                const std::string pixel =
                    "--pixel " + std::to_string(x) + "," + std::to_string(y) + " --sample ";
                const Outcome first = run(command + pixel + "0"),
                              second = run(command + pixel + "1");
                REQUIRE(first.code == 0);
                const Vec3 a = vectorIn(first.output, "own_pixel"),
                           b = vectorIn(second.output, "own_pixel");
                CHECK(a == renderedSum(scene, overrides, x, y, 1));
                CHECK(toFloat(toDouble(a) + toDouble(b)) == renderedSum(scene, overrides, x, y, 2));
                lit += a.x > 0.0f && !(a == b);
            }
            CHECK(lit >= 1);
        }
}

TEST_CASE("Replay: prints the camera sample, both walks and every contribution by its technique") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", everyMaterialScene).string();
    const Outcome pt = run("replay " + scene + " --pixel 8,8 --sample 0");
    CHECK(pt.code == 0);
    for (const char* part :
         {"pt, pixel 8,8 of 16 × 12, sample 0, seed 0", "film point", "aperture", "weight",
          "footprint", "path from the camera", "surface  floor", "contributions", "s1t2", "sum"})
        CHECK(contains(pt.output, part));
    CHECK_FALSE(contains(pt.output, "path from a light"));
    const Outcome lt =
        run("replay " + scene +
            " --pixel 8,8 --sample 0 -s estimator.kind=lt -s estimator.light_paths=2");
    CHECK(contains(lt.output, "path 1 of 2 from a light"));
    CHECK(contains(lt.output, "path 2 of 2 from a light"));
    CHECK_FALSE(contains(lt.output, "camera sample"));
    const Outcome spectral =
        run("replay " + scene +
            " --pixel 8,8 --sample 0 -s estimator.kind=bdpt -s film.color=spectral");
    CHECK(contains(spectral.output, "value, XYZ"));
    CHECK(contains(spectral.output, " nm\n"));
    // The command line's size is another frame, and so another sample.
    CHECK(contains(run("replay " + scene + " --pixel 30,8 --sample 0 --size 32,24").output,
                   "of 32 × 24"));
}

TEST_CASE("Replay: a contribution that the film refuses is marked") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", everyMaterialScene).string();
    const Outcome outcome = run(
        "replay " + scene +
        " --pixel 8,2 --sample 0 -s material.lamp.emission=[1e30,1e30,1e30] -s camera.exposure=60");
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.output, "NOT FINITE"));
}

TEST_CASE("Replay: a pixel outside the frame is wrong usage, and so is no sample") {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.toml", everyMaterialScene).string();
    const Outcome outside = run("replay " + scene + " --pixel 16,0 --sample 0");
    CHECK(outside.code == 64);
    CHECK(contains(outside.output, "--pixel 16,0: must lie in the frame of 16 × 12 pixels"));
    CHECK(run("replay " + scene + " --pixel 0,12 --sample 0").code == 64);
    CHECK(run("replay " + scene + " --pixel 0,0").code == 64);
    CHECK(run("replay " + scene + " --sample 0").code == 64);
    CHECK(run("replay " + scene + "x --pixel 0,0 --sample 0").code == 66);
}
