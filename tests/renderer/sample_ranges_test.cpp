#include "renderer/sample_ranges.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <stdexcept>

using namespace etendue;

TEST_CASE("SampleRanges: neighbours become one, in whatever order they come") {
    std::vector<SampleRange> pieces;
    for (std::uint32_t i = 0; i < 12; ++i) pieces.push_back({10 * i, 10 * i + 10});
    std::mt19937 random(3);
    for (int i = 0; i < 50; ++i) {
        std::ranges::shuffle(pieces, random);
        SampleRanges ranges;
        for (const SampleRange& piece : pieces) ranges.add(piece);
        CHECK(ranges.ranges() == std::vector<SampleRange>{{0, 120}});
        CHECK(ranges.count() == 120);
    }
}

TEST_CASE("SampleRanges: what overlaps is refused, and named") {
    SampleRanges ranges;
    ranges.add({10, 20});
    ranges.add({30, 40});
    CHECK(ranges.overlap({15, 35}) == SampleRange{15, 20});
    CHECK(ranges.overlap({39, 50}) == SampleRange{39, 40});
    CHECK(ranges.overlap({0, 100}) == SampleRange{10, 20});
    CHECK_FALSE(ranges.overlap({20, 30}));
    CHECK_THROWS_AS(ranges.add({5, 11}), std::invalid_argument);
    CHECK_THROWS_AS(ranges.add({5, 5}), std::invalid_argument);
    CHECK(ranges.text() == "10:20,30:40");
    ranges.add({20, 30});
    CHECK(ranges.text() == "10:40");
}

TEST_CASE("SampleRanges: holes") {
    SampleRanges ranges;
    CHECK(ranges.text() == "none");
    CHECK(ranges.holes({0, 8}) == std::vector<SampleRange>{{0, 8}});
    ranges.add({2, 4});
    ranges.add({6, 9});
    CHECK(ranges.holes({0, 12}) == std::vector<SampleRange>{{0, 2}, {4, 6}, {9, 12}});
    CHECK(ranges.holes({3, 7}) == std::vector<SampleRange>{{4, 6}});
    CHECK(ranges.holes({2, 4}).empty());
    CHECK(ranges.holes({20, 22}) == std::vector<SampleRange>{{20, 22}});
}

TEST_CASE("SampleRanges: as text and back") {
    CHECK(parseSampleRange("0:64") == SampleRange{0, 64});
    CHECK(parseSampleRange("12:1073741824") == SampleRange{12, 1u << 30});
    for (const char* bad : {"", ":", "1", "1:", ":2", "2:2", "3:2", "-1:2", "1:2x", " 1:2", "1:2:3",
                            "0:1073741825", "0:99999999999", "1,2"}) {
        CAPTURE(bad);
        CHECK_FALSE(parseSampleRange(bad));
    }
    CHECK(textOf({3, 9}) == "3:9");
}
