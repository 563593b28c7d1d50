#include "lens/lens_fit.h"

#include <doctest/doctest.h>

#include <cmath>

#include "lens/polynomial.h"
#include "tests/lens/fitted_lenses.h"

namespace etendue {

TEST_CASE("Fit rays: each is what the exact trace says, and they are the same every time") {
    const FitDomain domain = doubleGaussDomain();
    const TracedLens lens = lensOf(doubleGauss(), domain);
    const FitRays rays = drawFitRays(lens, domain, 200, 5), again = drawFitRays(lens, domain, 200, 5);
    REQUIRE(rays.rays.size() == 200);
    CHECK(rays.counts.passed == 200);
    CHECK(rays.counts.passed + rays.counts.blocked + rays.counts.folded == rays.counts.drawn);
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

TEST_CASE("Lens fit: every basis can fit every lens, the axial one best per term") {
    FitSettings settings = smallSettings();
    settings.degree = 3;
    double axial = 0.0;
    for (const PolynomialBasis basis : {PolynomialBasis::axial, PolynomialBasis::twoPlane,
                                        PolynomialBasis::cartesian, PolynomialBasis::none}) {
        settings.basis = basis;
        settings.terms = basis == PolynomialBasis::axial ? 6 : 12;
        const LensFit fit = fitLens(doubleGauss(), doubleGaussDomain(), settings);
        CHECK(fit.errors.directionMrad.rms < 1.0);
        if (basis == PolynomialBasis::axial)
            axial = fit.errors.directionMrad.rms;
        else
            CHECK(fit.errors.directionMrad.rms > axial);
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
    const PolynomialEvaluator<double> evaluator(fit.clip.squaredHeights);
    for (const FitRay& ray : drawFitRays(lens, fit.domain, 200, 8).rays) {
        const double expected =
            (ray.pupil.x * ray.pupil.x + ray.pupil.y * ray.pupil.y) / (20.0 * 20.0);
        const double fitted = evaluator
                                  .evaluate({ray.query.sensor.mm, ray.query.aperture.mm,
                                             ray.query.wavelengthNm})
                                  .values[0];
        CHECK(std::abs(fitted - expected) < 1e-3);
    }
}

namespace {

struct AccuracyGoal {
    const char* file;
    Eigen::Vector2d sensorHalfSizeMm;
    double imageRadiusMm;
    PolynomialBasis basis;
    double mradWith32, mradWith64;
};

}  // namespace

TEST_CASE("Lens fit: the outgoing direction is as accurate as the goals ask, on every kind of lens" *
          doctest::test_suite("statistical")) {
    constexpr double full = std::numeric_limits<double>::infinity();
    const AccuracyGoal goals[] = {
        {"double-gauss-100mm.toml", {18.0, 12.0}, full, PolynomialBasis::axial, 0.007, 0.0012},
        {"fisheye-10mm.toml", {11.8, 7.85}, full, PolynomialBasis::axial, 0.22, 0.066},
        {"fisheye-181-10mm.toml", {14.2, 14.2}, 14.2, PolynomialBasis::axial, 0.45, 0.24},
        {"fisheye-220-6mm-f2.8.toml", {12.0, 12.0}, 12.0, PolynomialBasis::axial, 0.18, 0.054},
        {"anamorphic-80x90mm.toml", {11.8, 7.85}, full, PolynomialBasis::twoPlane, full, 0.1},
    };
    for (const AccuracyGoal& goal : goals) {
        CAPTURE(goal.file);
        const Prescription prescription = loadPrescription(lensFile(goal.file));
        const FitDomain domain = domainOf(prescription, goal.sensorHalfSizeMm, goal.imageRadiusMm);
        FitSettings settings;
        settings.basis = goal.basis;
        for (const auto& [terms, mrad] : {std::pair(32, goal.mradWith32), {64, goal.mradWith64}}) {
            if (std::isinf(mrad)) continue;
            settings.terms = terms;
            const LensFit fit = fitLens(prescription, domain, settings);
            CHECK(fit.errors.directionMrad.rms < mrad);
            CHECK(fit.errors.unsolved == 0);
            CHECK(fit.clipErrors.wronglyAccepted < 0.005);
            CHECK(fit.clipErrors.wronglyBlocked < 0.005);
        }
    }
}

}  // namespace etendue
