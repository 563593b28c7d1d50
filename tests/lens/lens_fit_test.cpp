#include "lens/lens_fit.h"

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "lens/fit_domain.h"
#include "lens/fit_file.h"
#include "lens/polynomial.h"
#include "tests/lens/fitted_lenses.h"

namespace etendue {

TEST_CASE("Fit rays: each is what the exact trace says, and they are the same every time") {
    const FitDomain domain = doubleGaussDomain();
    const TracedLens lens = lensOf(doubleGauss(), domain);
    const FitRays rays = drawFitRays(lens, domain, 200, 5),
                  again = drawFitRays(lens, domain, 200, 5);
    REQUIRE(rays.rays.size() == 200);
    CHECK(rays.counts.passed == 200);
    const RayCounts& n = rays.counts;
    CHECK(n.passed + n.blocked + n.folded + n.unsolved + n.besidePupil == n.drawn);
    const PupilSphere sphere(lens.system());
    for (std::size_t i = 0; i < rays.rays.size(); ++i) {
        const FitRay& ray = rays.rays[i];
        CHECK(ray.query.sensor.mm == again.rays[i].query.sensor.mm);
        CHECK(ray.throughput == again.rays[i].throughput);
        CHECK(domain.contains(ray.query.sensor, ray.query.aperture, ray.query.wavelengthNm));
        const std::optional<ExitRay> exit =
            lens.trace(ray.query.sensor, ray.query.aperture, ray.query.wavelengthNm);
        REQUIRE(exit.has_value());
        CHECK((exit->direction - ray.direction).norm() <= 1e-12);
        const std::optional<LensRay<double>> back = sphere.ray(ray.pupil);
        REQUIRE(back.has_value());
        CHECK((toEigen(back->direction) - ray.direction).norm() <= 1e-12);
        CHECK(exit->throughput == ray.throughput);
    }
}

TEST_CASE("Fit rays: queries are uniform over the domain") {
    FitDomain domain = doubleGaussDomain();
    domain.imageRadiusMm = 15.0;
    constexpr int count = 20'000;
    Eigen::Vector2d sensor(0.0, 0.0), aperture(0.0, 0.0);
    double squared = 0.0, wavelength = 0.0;
    for (std::uint64_t i = 0; i < count; ++i) {
        const FitQuery query = drawQuery(domain, 9, i);
        REQUIRE(domain.contains(query.sensor, query.aperture, query.wavelengthNm));
        sensor += query.sensor.mm / count;
        aperture += query.aperture.mm / count;
        squared += query.aperture.mm.squaredNorm() / count;
        wavelength += query.wavelengthNm / count;
    }
    // Four standard errors: of a mean over [-r, r] at most r/√(3n), of a squared radius R²/√(12n).
    const double error = 4.0 / std::sqrt(3.0 * count), radius = domain.apertureRadiusMm;
    CHECK(sensor.cwiseAbs().maxCoeff() <= 15.0 * error);
    CHECK(aperture.cwiseAbs().maxCoeff() <= radius * error);
    CHECK(std::abs(squared - 0.5 * radius * radius) <= 0.5 * radius * radius * error);
    CHECK(std::abs(wavelength - 550.0) <= 150.0 * error);
}

TEST_CASE("Lens fit: a small fit is near, a larger one nearer, in both forms") {
    for (const FitForm form : {FitForm::twoPoint, FitForm::sensorState}) {
        FitSettings settings = smallSettings();
        settings.form = form;
        const LensFit small = fitLens(doubleGauss(), doubleGaussDomain(), settings);
        settings.terms = 24;
        settings.degree = 9;
        const LensFit larger = fitLens(doubleGauss(), doubleGaussDomain(), settings);
        CHECK(small.errors.unsolved == 0);
        CHECK(small.errors.directionMrad.rms < 0.1);
        CHECK(larger.errors.directionMrad.rms < 0.2 * small.errors.directionMrad.rms);
        CHECK(larger.errors.pupilMm.rms < small.errors.pupilMm.rms);
        CHECK(larger.errors.etendue.rms < 0.5 * small.errors.etendue.rms);
        CHECK(small.errors.directionMrad.rms <= small.errors.directionMrad.percentile999);
        CHECK(small.errors.directionMrad.percentile999 <= small.errors.directionMrad.most);
        // At infinity focus a direction moves the picture by the focal length, 100 mm.
        CHECK(small.errors.sensorMicrometres.rms ==
              doctest::Approx(100.0 * small.errors.directionMrad.rms).epsilon(0.1));
    }
}

TEST_CASE("Lens fit: it has the same bits on one thread and on several") {
    const LensFit several = fitLens(doubleGauss(), doubleGaussDomain(), smallSettings());
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const LensFit alone = fitLens(doubleGauss(), doubleGaussDomain(), smallSettings());
    CHECK(fitFileText(alone) == fitFileText(several));
}

TEST_CASE("Lens fit: a paraboloid whose rim is wider than its vertex radius is refused by that") {
    // Light comes in up to 13.7 mm from the axis, and the sphere at the vertex ends at 10 mm.
    Surface front = spherical(10.0, 12.0, 14.0, plainGlass(1.5));
    front.kind = SurfaceKind::conic;
    front.conic = -1.0;
    Prescription lens;
    lens.name = "paraboloid";
    lens.surfaces = {front, spherical(std::numeric_limits<double>::infinity(), 1.0, 14.0),
                     stop(11.0, 8.2)};
    const FitDomain wide = domainOf(lens, {0.5, 0.5});
    const FitRays rays = drawFitRays(lensOf(lens, wide), wide, 200, 5);
    CHECK(rays.counts.besidePupil > 20);
    CHECK_THROWS_WITH_AS(fitLens(lens, wide, smallSettings()), doctest::Contains("vertex radius"),
                         std::invalid_argument);
    FitDomain narrow = wide;
    narrow.apertureRadiusMm = 2.0;
    CHECK(fitLens(lens, narrow, smallSettings()).training.besidePupil == 0);
}

TEST_CASE("Lens fit: every basis can fit every lens, the axial one with fewest terms") {
    FitSettings settings = smallSettings();
    settings.degree = 3;
    // All six axial terms of degree 3 against 12 of 16 for each output, and 40 of 56 for all.
    settings.terms = 6;
    const double axial =
        fitLens(doubleGauss(), doubleGaussDomain(), settings).errors.directionMrad.rms;
    for (const auto& [basis, terms] : {std::pair(PolynomialBasis::twoPlane, 12),
                                       {PolynomialBasis::cartesian, 12},
                                       {PolynomialBasis::none, 40}}) {
        settings.basis = basis;
        settings.terms = terms;
        const LensFit fit = fitLens(doubleGauss(), doubleGaussDomain(), settings);
        CHECK(fit.errors.directionMrad.rms < 1.0);
        CHECK(fit.errors.directionMrad.rms > 0.9 * axial);
    }
}

TEST_CASE("Lens fit: a lens of twice the size has the same fit, twice the size") {
    const FitDomain domain = doubleGaussDomain();
    FitDomain twice = domain;
    twice.sensorHalfSizeMm *= 2.0;
    twice.sensorDistanceMm *= 2.0;
    twice.apertureRadiusMm *= 2.0;
    const LensFit fit = fitLens(doubleGauss(), domain, smallSettings());
    const LensFit large = fitLens(scaled(doubleGauss(), 2.0), twice, smallSettings());
    CHECK(large.errors.directionMrad.rms ==
          doctest::Approx(fit.errors.directionMrad.rms).epsilon(1e-3));
    CHECK(large.errors.pupilMm.rms == doctest::Approx(2.0 * fit.errors.pupilMm.rms).epsilon(1e-3));
}

TEST_CASE("Lens fit: clipping by polynomials decides as the exact trace does") {
    FitSettings settings = smallSettings();
    settings.clip = {};
    const LensFit fit = fitLens(doubleGauss(), doubleGaussDomain(), settings);
    CHECK(fit.clip.surfaces.front() == 0);
    CHECK(fit.clip.surfaces.back() == 9);
    CHECK(fit.clip.surfaces.size() > 2);  // interior elements of the double Gauss do clip
    CHECK(fit.clipErrors.wronglyAccepted < 0.005);
    CHECK(fit.clipErrors.wronglyBlocked < 0.005);
    // A squared height on the front surface is that of the ray on the pupil sphere, which is it.
    const TracedLens lens = lensOf(doubleGauss(), doubleGaussDomain());
    const PolynomialEvaluator<double> evaluator(fit.clip.squares);
    for (const FitRay& ray : drawFitRays(lens, fit.domain, 200, 8).rays) {
        const double expected =
            (ray.pupil.x * ray.pupil.x + ray.pupil.y * ray.pupil.y) / (20.0 * 20.0);
        const double fitted =
            evaluator.evaluate({ray.query.sensor.mm, ray.query.aperture.mm, ray.query.wavelengthNm})
                .values[0];
        CHECK(std::abs(fitted - expected) < 1e-3);
    }
}

namespace {

constexpr double full = std::numeric_limits<double>::infinity();

/// Held out, over the whole sensor, the whole aperture and 400–700 nm, rms.
void checkAccuracy(const char* file, const FitDomain& domain, PolynomialBasis basis, int terms,
                   double mrad) {
    CAPTURE(file);
    FitSettings settings;
    settings.basis = basis;
    settings.terms = terms;
    const LensFit fit = fitLens(loadPrescription(lensFile(file)), domain, settings);
    CHECK(fit.errors.directionMrad.rms < mrad);
    CHECK(fit.errors.unsolved == 0);
    CHECK(fit.clipErrors.wronglyAccepted < 0.005);
    CHECK(fit.clipErrors.wronglyBlocked < 0.005);
}

void checkAxialAccuracy(const char* file, Eigen::Vector2d sensorHalfSizeMm, double imageRadiusMm,
                        double mradWith32, double mradWith64) {
    const FitDomain domain =
        domainOf(loadPrescription(lensFile(file)), sensorHalfSizeMm, imageRadiusMm);
    checkAccuracy(file, domain, PolynomialBasis::axial, 32, mradWith32);
    checkAccuracy(file, domain, PolynomialBasis::axial, 64, mradWith64);
}

}  // namespace

TEST_CASE("Lens fit: directions through the double Gauss are off by 7 µrad, then 1.2" *
          doctest::test_suite("statistical")) {
    checkAxialAccuracy("double-gauss-100mm.toml", {18.0, 12.0}, full, 0.007, 0.0012);
}

TEST_CASE("Lens fit: directions through a 10 mm fisheye are off by 0.22 mrad, then 0.066" *
          doctest::test_suite("statistical")) {
    checkAxialAccuracy("fisheye-10mm.toml", {11.8, 7.85}, full, 0.22, 0.066);
}

TEST_CASE("Lens fit: directions through an aspheric fisheye are off by 0.45 mrad, then 0.24" *
          doctest::test_suite("statistical")) {
    checkAxialAccuracy("fisheye-181-10mm.toml", {14.2, 14.2}, 14.2, 0.45, 0.24);
}

TEST_CASE("Lens fit: directions through a 220 degree fisheye are off by 0.18 mrad, then 0.054" *
          doctest::test_suite("statistical")) {
    checkAxialAccuracy("fisheye-220-6mm-f2.8.toml", {12.0, 12.0}, 12.0, 0.18, 0.054);
}

TEST_CASE("Lens fit: hardly a ray passes that a rim or total reflection ends, on any lens" *
          doctest::test_suite("statistical")) {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        const bool isAxial = !isAnamorphic(prescription);
        const FitDomain domain = fitDomain(prescription, {});
        const TracedLens lens = lensOf(prescription, domain);
        const ClipFit clip =
            fitClip(lens, domain, isAxial ? PolynomialBasis::axial : PolynomialBasis::twoPlane);
        const ClipErrors errors = measureClip(clip, lens, domain, 20'000, 9);
        CHECK(errors.wronglyAccepted < 0.005);
        CHECK(errors.wronglyBlocked < 0.005);
    }
}

TEST_CASE("Lens fit: directions through the anamorphic lens are off by 0.1 mrad" *
          doctest::test_suite("statistical")) {
    const char* file = "anamorphic-80x90mm.toml";
    checkAccuracy(file, domainOf(loadPrescription(lensFile(file)), {11.8, 7.85}),
                  PolynomialBasis::twoPlane, 64, 0.1);
}

}  // namespace etendue
