// How often connect() loses rays that trace() produced, by lens and field: our search and the
// published one, on fits in both forms. Prints a table.
#include <cstdio>

#include "lens/connect_survey.h"
#include "lens/fit_cache.h"
#include "lens/fit_domain.h"
#include "lens/fitted_map.h"

namespace etendue {
namespace {

constexpr int rings = 6, raysPerRing = 4000;
constexpr double distancesMm[] = {100.0, 300.0, 1e3, 1e4, 1e9};

void printRow(const Prescription& prescription, FitForm form, ConnectMethod method) {
    FitSettings settings;
    settings.form = form;
    if (isAnamorphic(prescription)) settings.basis = PolynomialBasis::twoPlane;
    const FitDomain domain = fitDomain(prescription, {});
    const LensFit fit = cachedFit(prescription, domain, settings, fitCacheDirectory());
    const PolynomialLens lens(prescription, fit, Aperture(domain.apertureRadiusMm));
    const FitRays anew = drawFitRays(lensOf(prescription, domain), domain, 4000, 53);
    const double inSight = shareInSight(fit.start, FittedMap(prescription, fit), anew.rays);
    int rays = 0, lost = 0, most = 0;
    double iterations = 0.0;
    std::printf("| %s%s%s | %s | %s |", prescription.name.c_str(),
                prescription.zoomPosition.empty() ? "" : ", ", prescription.zoomPosition.c_str(),
                form == FitForm::twoPoint ? "two-point" : "sensor-state",
                method == ConnectMethod::newton ? "ours" : "two-step");
    for (const ConnectRing& ring : connectSurvey(lens, method, distancesMm, rings, raysPerRing)) {
        const int failed = ring.failures + ring.otherPoints;
        if (ring.rays == 0)
            std::printf(" – |");
        else
            std::printf(" %.0f°: %.2f |", ring.fieldDegrees, 100.0 * failed / ring.rays);
        rays += ring.rays;
        lost += failed;
        most = std::max(most, ring.mostIterations);
        iterations += ring.meanIterations * ring.rays;
    }
    std::printf(" %d of %d | %.1f, %d | %.0f %% of %zu |\n", lost, rays,
                iterations / std::max(1, rays), most, 100.0 * inSight,
                fit.start.sensor.groups[0].terms.size());
}

void run(int count, char** files) {
    std::printf(
        "Rays of the fit (40 terms, degree 11, 36 × 24 mm, wide open, 400–700 nm, focus at\n"
        "infinity) that connect loses or puts elsewhere, per cent, by rings of the sensor and the\n"
        "angle that they see; targets 0.1, 0.3, 1, 10 m and 1000 km off.\n\n"
        "| lens | form | search | ring 1 | ring 2 | ring 3 | ring 4 | ring 5 | ring 6 | all "
        "| steps: mean, most | targets in sight of the first guess, its terms |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < count; ++i)
        for (const Prescription& prescription : loadPrescriptions(files[i]))
            for (const FitForm form : {FitForm::twoPoint, FitForm::sensorState})
                for (const ConnectMethod method : {ConnectMethod::newton, ConnectMethod::twoStep})
                    printRow(prescription, form, method);
}

}  // namespace
}  // namespace etendue

int main(int argc, char** argv) {
    try {
        etendue::run(argc - 1, argv + 1);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "connect_bench: %s\n", error.what());
        return 1;
    }
}
