// Pictures that regression tests judge.
#include "tools/regress_pictures.h"

#include <doctest/doctest.h>

#include "tests/support/scenes.h"
#include "tests/tools/every_material_scene.h"

using namespace etendue;

namespace {

const LoadedScene& scene() {
    static const LoadedScene loaded =
        sceneFromText(everyMaterialScene, {"film.width=12", "film.height=8"});
    return loaded;
}

CommonPathsSettings all(const std::string& kind) {
    return {scene().estimator, {kind, {}}, {kind, {}}, true};
}

}  // namespace

TEST_CASE("Regress pictures: a checkpoint is the render of as many samples, for any threads") {
    SeedSettings settings;
    settings.checkpoints = {1, 4};
    settings.seeds = 3;
    settings.firstSeed = 7;
    const auto goOn = [] { return true; };
    const auto one = renderSeeds(scene(), all("bdpt"), settings, goOn);
    settings.threads = 3;
    const auto three = renderSeeds(scene(), all("bdpt"), settings, goOn);
    REQUIRE(one);
    REQUIRE(three);
    CHECK(one->pictures == three->pictures);
    CHECK(one->largest == three->largest);
    LoadedScene bdpt = sceneFromText(everyMaterialScene,
                                     {"film.width=12", "film.height=8", "estimator.kind=bdpt"});
    bdpt.estimator.lightPaths = 1;
    bdpt.sampler = Sampler::independent;
    CHECK(one->pictures[0][0] == renderPixels(bdpt, 1, 7));
    CHECK(one->pictures[1][2] == renderPixels(bdpt, 4, 9));
    CHECK(one->pictures[1][0] != one->pictures[1][1]);
}

TEST_CASE("Regress pictures: they end when they are told to") {
    int asked = 0;
    SeedSettings settings;
    settings.checkpoints = {1, 2};
    settings.seeds = 8;
    CHECK(!renderSeeds(scene(), all("pt"), settings, [&] { return ++asked < 3; }));
    CHECK(asked == 3);
}

TEST_CASE("Regress pictures: regions are tiles by colour, and all of it") {
    const PictureRegions regions{3, 2, 2};  // a tile of 2 × 2 and one of 1 × 2
    CHECK(regions.count() == 7);
    CHECK(regions.pixels() == std::vector<int>{4, 4, 4, 2, 2, 2, 6});
    Picture picture(18);
    for (std::size_t i = 0; i < picture.size(); ++i)
        picture[i] = static_cast<float>(i / 3) + 10.0f * static_cast<float>(i % 3);
    // Pixels 0, 1, 3, 4 and 2, 5: means of 2 and 3.5.
    CHECK(regions.meansOf(picture) == std::vector<double>{2.0, 12.0, 22.0, 3.5, 13.5, 23.5, 12.5});
}
