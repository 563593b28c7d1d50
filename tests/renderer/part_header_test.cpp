#include "renderer/part_header.h"

#include <doctest/doctest.h>

#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "config/config.h"

using namespace etendue;

TEST_CASE("Part header: what a picture says of scene and camera comes back") {
    PartInfo info;
    info.window = {2, 2, 0, 0, 2, 2};
    info.picture["etendue:scene"] = std::string("a \"b\" é.toml");
    std::vector<float> matrix(16);
    std::iota(matrix.begin(), matrix.end(), 0.1f);
    info.picture["worldToCamera"] = matrix;
    info.picture["aperture"] = 2.8f;
    info.picture["focus"] = std::numeric_limits<float>::infinity();
    const std::string text = partHeaderText(info, {}, {});
    CHECK(parsePartHeader(text, "a").part.info.picture == info.picture);
    info.picture["etendue:scene"] = std::string("sc\xe8ne.toml");
    const Metadata picture = parsePartHeader(partHeaderText(info, {}, {}), "a").part.info.picture;
    CHECK(std::get<std::string>(picture.at("etendue:scene")) == "sc\uFFFDne.toml");
    info.picture["aperture"] = std::string("wide open");
    CHECK_THROWS_AS(parsePartHeader(partHeaderText(info, {}, {}), "a"), InputError);
}
