#include "lens/clear_core.h"

#include <doctest/doctest.h>

#include "lens/fit_domain.h"
#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

/// Checks that the core lets through no ray that a rim blocks. Returns which share of the rays that
/// pass it spares the question.
double checkCore(const Prescription& prescription, const FitDomain& domain, std::uint64_t queries) {
    const TracedLens lens = lensOf(prescription, domain);
    const ClipFit clip =
        fitClip(lens, domain,
                isAnamorphic(prescription) ? PolynomialBasis::twoPlane : PolynomialBasis::axial);
    const ValueEvaluator squares(clip.squares);
    const ClearCore core(clip, squares, domain);
    int passing = 0, inside = 0, wrongly = 0;
    for (std::uint64_t i = 0; i < queries; ++i) {
        const FitQuery q = drawQuery(domain, 47, i);
        if (!domain.contains(q.sensor, q.aperture, q.wavelengthNm)) continue;
        const auto at = squares.values({q.sensor.mm, q.aperture.mm, q.wavelengthNm});
        const bool passes = passesRims({at.data(), clip.count()});
        const bool isInside = core.contains(q.sensor, q.aperture);
        passing += passes;
        inside += isInside;
        wrongly += isInside && !passes;
    }
    CHECK(wrongly == 0);
    return static_cast<double>(inside) / passing;
}

TEST_CASE("ClearCore: no rim blocks what it lets through, and it is most of a lens stopped down") {
    const Prescription fast = loadPrescription(lensFile("double-gauss-50mm-f1.1.toml"));
    CHECK(checkCore(fast, fitDomain(fast, {{36.0, 24.0}, 4000.0}), 50'000) > 0.3);
    CHECK(checkCore(fast, fitDomain(fast, {{36.0, 24.0}, 4000.0, 2.8}), 50'000) > 0.7);
}

TEST_CASE("ClearCore: no rim of any lens blocks what it lets through" *
          doctest::test_suite("statistical")) {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription table = load(shipped);
        const double share = checkCore(table, fitDomain(table, {}), 300'000);
        MESSAGE(table.name << ": " << share << " of the passing rays");
    }
}

}  // namespace
}  // namespace etendue
