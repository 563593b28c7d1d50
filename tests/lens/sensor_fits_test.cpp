#include "lens/sensor_fits.h"

#include <doctest/doctest.h>

#include "lens/fit_domain.h"
#include "lens/fitted_map.h"
#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

TEST_CASE(
    "Connect start: it is that of the fit's rays, and one evaluation sees nearly all targets" *
    doctest::test_suite("statistical")) {
    // A start for the exact rays, which leave a little beside the fit's, has a seventh of a wide
    // open fisheye's targets in sight.
    for (const char* file : {"double-gauss-50mm-f1.1.toml", "fisheye-10mm.toml"}) {
        CAPTURE(file);
        const Prescription table = loadPrescription(lensFile(file));
        const FitDomain domain = fitDomain(table, {{24.0, 16.0}, 4000.0});
        const LensFit fit = fitLens(table, domain, {});
        const FitRays rays = drawFitRays(lensOf(table, domain), domain, 4000, 53);
        CHECK(shareInSight(fit.start, FittedMap(table, fit), rays.rays) > 0.9);
    }
}

}  // namespace
}  // namespace etendue
