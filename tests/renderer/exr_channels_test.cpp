#include <doctest/doctest.h>

#include <limits>

#include "config/config.h"
#include "renderer/image_io.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

/// 2 × 1 pixels with a layer beside R, G, B.
std::filesystem::path writeLayers(const TemporaryFolder& folder, float last) {
    const std::filesystem::path file = folder / "layers.exr";
    writeExr(file, {2, 1, 0, 0, 2, 1},
             {{{"R", "G", "B"}, {1, 2, 3, 4, 5, 6}},
              {{"variance.R", "variance.G"}, {0.25F, 0.5F, 0.75F, last}}},
             {});
    return file;
}

}  // namespace

TEST_CASE("EXR channels: come by name, in the order asked for, whatever lies between") {
    const TemporaryFolder folder;
    const auto file = writeLayers(folder, 1.0F);
    const auto layer = readExrChannels(file, {"variance.R", "variance.G"});
    REQUIRE(layer);
    CHECK(layer->names == std::vector<std::string>{"variance.R", "variance.G"});
    CHECK(layer->pixels == std::vector<float>{0.25F, 0.5F, 0.75F, 1.0F});
    const auto mixed = readExrChannels(file, {"variance.G", "R", "B"});
    REQUIRE(mixed);
    CHECK(mixed->pixels == std::vector<float>{0.5F, 1.0F, 3.0F, 1.0F, 4.0F, 6.0F});
}

TEST_CASE("EXR channels: one that is missing is no error, nor is a file of another kind") {
    const TemporaryFolder folder;
    const auto file = writeLayers(folder, 1.0F);
    CHECK_FALSE(readExrChannels(file, {"variance.R", "variance.B"}));
    CHECK_FALSE(readExrChannels(file, {"variance.r"}));
    writePng(folder / "a.png", 1, 1, {1, 2, 3});
    CHECK_FALSE(readExrChannels(folder / "a.png", {"variance.R"}));
}

TEST_CASE("EXR channels: NaN and missing files are errors as of any image") {
    const TemporaryFolder folder;
    const auto file = writeLayers(folder, std::numeric_limits<float>::quiet_NaN());
    CHECK_THROWS_WITH_AS(
        readExrChannels(file, {"variance.R", "variance.G"}),
        (file.string() + ": pixel 1, 0 is NaN or infinite, expected finite numbers").c_str(),
        InputError);
    CHECK(readExrChannels(file, {"R", "variance.R"}));
    CHECK_THROWS_AS(readExrChannels(folder / "none.exr", {"R"}), InputError);
}
