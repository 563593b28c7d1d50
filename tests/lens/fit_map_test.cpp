#include "lens/fit_map.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

TEST_CASE("fitMap: two pinholes differ by the angle between their rays") {
    const auto exact = makePinhole(50.0), fitted = makePinhole(50.1);
    const FitMap map = fitMap(*exact, *fitted, {0.6, 0.8}, 20.0, 0.0, 550.0, 5, 3);
    for (int field = 0; field < 5; ++field) {
        const double height = map.heightsMm[static_cast<std::size_t>(field)];
        CHECK(height == doctest::Approx(2.0 + 4.0 * field));
        const double angle = std::atan(height / 50.0) - std::atan(height / 50.1);
        CHECK(map.directionMrad[map.index(1, field)] ==
              doctest::Approx(1e3 * 2.0 * std::sin(0.5 * angle)).epsilon(1e-9));
    }
}

TEST_CASE("fitMap: rays that only one of the lenses lets through are told apart") {
    const auto wide = makeThinLens(50.0, 2000.0, 10.0), narrow = makeThinLens(50.0, 2000.0, 5.0);
    const auto count = [](const std::vector<bool>& cells) {
        return std::ranges::count(cells, true);
    };
    // Of ten aperture points from −9 to 9 mm, those at ±7 and ±9 mm; ±5 are inside both (rim
    // included).
    const FitMap accepted = fitMap(*narrow, *wide, {0.0, 1.0}, 5.0, 10.0, 550.0, 2, 10);
    CHECK(count(accepted.isWronglyAccepted) == 2 * 4);
    CHECK(count(accepted.isWronglyBlocked) == 0);
    CHECK(std::isnan(accepted.directionMrad[accepted.index(0, 0)]));
    CHECK(accepted.directionMrad[accepted.index(4, 0)] < 1e-9);
    const FitMap blocked = fitMap(*wide, *narrow, {0.0, 1.0}, 5.0, 10.0, 550.0, 2, 10);
    CHECK(count(blocked.isWronglyBlocked) == 2 * 4);
    CHECK(count(blocked.isWronglyAccepted) == 0);
}

}  // namespace
}  // namespace etendue
