#include "lens/slides_table.h"

#include <doctest/doctest.h>

#include "tests/lens/prescriptions.h"

namespace etendue {

TEST_CASE("Slides' table: our fits of the published form come to the published errors") {
    const std::size_t doubleGauss = 3;
    const SlidesMeasurement measurement(
        loadPrescription(lensFile(std::string(slidesLenses[doubleGauss]) + ".toml")), 3000);
    for (const SlidesRow& row : slidesRows()) {
        if (row.coefficients > 21) continue;  // 3000 rays are few for more
        CAPTURE(row.coefficients);
        const SlidesResult result = measurement.measure(row);
        // Both are means over rays drawn at random, of squares that vary by some factors.
        CHECK(result.again == doctest::Approx(row.published[doubleGauss]).epsilon(0.2));
        CHECK(result.twoPoint < 0.05 * result.again);
        CHECK(result.twoPointMultiplyAdds <= result.multiplyAdds);
    }
}

TEST_CASE("Slides' table: complete polynomials err least, sparse ones less than Taylor's") {
    const SlidesMeasurement measurement(loadPrescription(lensFile("fisheye-10mm.toml")), 1000);
    const auto error = [&](SlidesMethod method, int degree, int coefficients) {
        return measurement.measure({method, degree, coefficients, {}}).again;
    };
    const double taylor = error(SlidesMethod::taylor, 3, 16);
    CHECK(error(SlidesMethod::complete, 3, 56) <= taylor);
    CHECK(error(SlidesMethod::sparse, 11, 16) < taylor);
    CHECK(error(SlidesMethod::taylor, 2, 4) > taylor);
}

}  // namespace etendue
