#include <doctest/doctest.h>

#include "config/config.h"

namespace etendue {

TEST_CASE("nearestName: finds what a slip of the keyboard meant") {
    const std::vector<std::string> names = {"f_number", "focus_distance", "from",      "to",
                                            "up",       "lens",           "radius_mm", "ior"};
    struct Slip {
        std::string written, meant;
    };
    const std::vector<Slip> slips = {
        {"fnumber", "f_number"},    // a letter missing
        {"ff_number", "f_number"},  // one too many
        {"g_number", "f_number"},   // a wrong one
        {"iro", "ior"},             // two swapped
        {"form", "from"},           // the same
        {"f_nubmer", "f_number"},   // the same
        {"radius", "radius_mm"},    // a unit forgotten
        {"focus_distence", "focus_distance"},
        {"lens", "lens"},
    };
    for (const Slip& slip : slips) {
        CAPTURE(slip.written);
        CHECK(nearestName(slip.written, names) == slip.meant);
    }
}

TEST_CASE("nearestName: is empty when nothing is near") {
    const std::vector<std::string> names = {"f_number", "to", "x", "lens"};
    for (const char* stranger : {"", "q", "aperture", "number_of_things", "height", "sn"}) {
        CAPTURE(stranger);
        CHECK(!nearestName(stranger, names));
    }
    CHECK(!nearestName("lens", {}));
    CHECK(!nearestName(std::string(10'000'000, 'a'), names));
}

TEST_CASE("nearestName: prefers the nearer, then the earlier") {
    CHECK(nearestName("width", {"widths", "width_a", "width"}) == "width");
    CHECK(nearestName("abcd", {"abce", "abcf"}) == "abce");
    CHECK(nearestName("abcd", {"abef", "abdc"}) == "abdc");
}

}  // namespace etendue
