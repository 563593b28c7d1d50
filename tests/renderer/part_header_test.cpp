#include "renderer/part_header.h"

#include <doctest/doctest.h>

#include "config/config.h"

using namespace etendue;

TEST_CASE("Part header: sums that the film's layers have no place for are refused") {
    PartInfo info;
    info.window = {2, 2, 0, 0, 2, 2};
    info.ranges.add({0, 4});
    FilmState state;
    info.layers.luminanceVariance = true;
    const PartPlanes planes{.sampleLuminance = true};
    CHECK(parsePartHeader(partHeaderText(info, state, planes), "a").planes.sampleLuminance);
    info.layers.luminanceVariance = false;
    CHECK_THROWS_WITH_AS(parsePartHeader(partHeaderText(info, state, planes), "a"),
                         doctest::Contains("part.planes: \"sample-luminance\" is for"), InputError);
}
