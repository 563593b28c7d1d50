#include "lens/dual.h"

#include <doctest/doctest.h>

#include <cmath>

namespace etendue {
namespace {

template <class T>
T everyOperation(const T& x, const T& y) {
    using std::sqrt;
    return (2.0 * x - y * 3.0 + 1.0) / (x * y + 4.0) - sqrt(x * x + y) / 2.0 + (1.0 - x) / y -
           (-y) * (5.0 / x) + (y - 0.5) * (0.25 + x);
}

TEST_CASE("Dual: the derivatives of an expression agree with central differences") {
    for (const double x : {0.3, 1.7, 4.0})
        for (const double y : {0.6, 2.5}) {
            const auto dual = everyOperation(Dual<2>::variable(x, 0), Dual<2>::variable(y, 1));
            CHECK(dual.value == doctest::Approx(everyOperation(x, y)).epsilon(1e-15));
            // Error h²/6 f‴, where 5 y/x has f‴ = 1e4 at x = 0.3, and rounding, 1e-10.
            constexpr double h = 1e-5;
            const double byX = (everyOperation(x + h, y) - everyOperation(x - h, y)) / (2.0 * h);
            const double byY = (everyOperation(x, y + h) - everyOperation(x, y - h)) / (2.0 * h);
            CHECK(std::abs(dual.partials[0] - byX) <= 2e-7);
            CHECK(std::abs(dual.partials[1] - byY) <= 2e-7);
        }
}

TEST_CASE("Dual: a constant has no derivatives") {
    const Dual<3> constant = 2.5;
    for (const double partial : constant.partials) CHECK(partial == 0.0);
    CHECK(valueOf(constant * constant) == 6.25);
}

}  // namespace
}  // namespace etendue
