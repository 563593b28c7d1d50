#include "lens/polynomial_lens.h"

#include <doctest/doctest.h>

#include <cmath>

#include "lens/fit_domain.h"
#include "lens/target_solver.h"
#include "tests/lens/fitted_lenses.h"
#include "tests/lens/lens_checks.h"

namespace etendue {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A lens, its fit and its exact trace.
struct Fitted {
    Fitted(const Prescription& table, const FitDomain& domain, const FitSettings& settings,
           double stopShare = 1.0)
        : prescription(table),
          fit(fitLens(prescription, domain, settings)),
          stop(stopShare * domain.apertureRadiusMm),
          lens(prescription, fit, stop),
          exact(prescription, stop, domain.sensorDistanceMm) {}

    /// One of those uniform over sensor, stop and wavelengths.
    FitQuery query(std::uint64_t index) const {
        FitQuery q = drawQuery(fit.domain, 31, index);
        q.aperture.mm *= stop.radiusMm() / fit.domain.apertureRadiusMm;
        return q;
    }

    Prescription prescription;
    LensFit fit;
    Aperture stop;
    PolynomialLens lens;
    TracedLens exact;
};

FitSettings settingsOf(FitForm form, int terms = 24, int degree = 9) {
    FitSettings settings = smallSettings();
    settings.form = form;
    settings.terms = terms;
    settings.degree = degree;
    settings.clip = {24, 7, 3000};
    return settings;
}

const Fitted& doubleGaussIn(FitForm form) {
    static const Fitted twoPoint(doubleGauss(), doubleGaussDomain(), settingsOf(FitForm::twoPoint));
    static const Fitted sensorState(doubleGauss(), doubleGaussDomain(),
                                    settingsOf(FitForm::sensorState));
    return form == FitForm::twoPoint ? twoPoint : sensorState;
}

const Fitted& fisheye() {
    static const Prescription table = loadPrescription(lensFile("fisheye-220-6mm-f2.8.toml"));
    static const Fitted fitted(table, fitDomain(table, {{20.0, 20.0}}),
                               settingsOf(FitForm::twoPoint));
    return fitted;
}

constexpr FitForm bothForms[] = {FitForm::twoPoint, FitForm::sensorState};

TEST_CASE("PolynomialLens: a ray is the exact one within the fit's own errors") {
    for (const FitForm form : bothForms) {
        const Fitted& fitted = doubleGaussIn(form);
        const FitErrors& errors = fitted.fit.errors;
        double squared = 0.0;
        int rays = 0, disagreements = 0;
        for (std::uint64_t i = 0; i < 2000; ++i) {
            const FitQuery q = fitted.query(i);
            const auto ray = fitted.lens.trace(q.sensor, q.aperture, q.wavelengthNm);
            const auto exact = fitted.exact.trace(q.sensor, q.aperture, q.wavelengthNm);
            if (ray.has_value() != exact.has_value()) ++disagreements;
            if (!ray || !exact) continue;
            ++rays;
            const double mrad = 1e3 * (ray->direction - exact->direction).norm();
            squared += mrad * mrad;
            // The largest of 10,000 held-out errors; of these 2000 none should be twice that.
            CHECK(mrad <= 2.0 * errors.directionMrad.most);
        }
        REQUIRE(rays > 1000);
        // Of n rays the rms varies by 1/√(2n) of itself were they Gaussian; their tails are longer.
        CHECK(std::sqrt(squared / rays) == doctest::Approx(errors.directionMrad.rms).epsilon(0.15));
        CHECK(disagreements <= 20);  // rims: 0.5 % each way
    }
}

TEST_CASE("PolynomialLens: its derivatives are those of its own rays") {
    LensRandom random(71);
    for (const FitForm form : bothForms) {
        const Fitted& fitted = doubleGaussIn(form);
        for (int i = 0; i < 40; ++i) {
            const SensorPoint s = random.onSensor(15.0, 10.0);
            const AperturePoint a{3.0 * (random.inUnitSquare() - Eigen::Vector2d(0.5, 0.5))};
            // Truncation is (0.05/18)⁴/30 of the fifth derivative on the scale of the sensor;
            // rounding, 1e-16 of an origin of 10 mm over the step.
            checkDerivatives(fitted.lens, s, a, 0.05, 1e-6, 1e-12);
        }
    }
    for (int i = 0; i < 40; ++i)
        checkDerivatives(fisheye().lens, random.onSensor(5.0, 5.0), {random.inUnitSquare()}, 0.01,
                         1e-6, 1e-12);
}

TEST_CASE("PolynomialLens: its footprint is the exact one within the fit's errors") {
    for (const FitForm form : bothForms) {
        const Fitted& fitted = doubleGaussIn(form);
        for (std::uint64_t i = 0; i < 200; ++i) {
            const FitQuery q = fitted.query(i);
            const auto ray = fitted.lens.trace(q.sensor, q.aperture, q.wavelengthNm);
            const auto exact = fitted.exact.trace(q.sensor, q.aperture, q.wavelengthNm);
            if (!ray || !exact) continue;
            const double off = (ray->directionBySensor - exact->directionBySensor).norm();
            // Of a polynomial of degree d on [-1, 1] the derivative is at most d² times the
            // largest value (Markov); here over a half diagonal of 21.6 mm.
            const double bound = 81.0 * 1e-3 * fitted.fit.errors.directionMrad.most / 21.6;
            CHECK(off <= bound);
            CHECK(std::abs(ray->throughput - exact->throughput) <= 0.01 * exact->throughput);
        }
    }
}

TEST_CASE("PolynomialLens: connect finds the film point that trace started from") {
    for (const FitForm form : bothForms)
        for (const double distance : {100.0, 1e3, 1e5, 1e9}) {
            const Fitted& fitted = doubleGaussIn(form);
            for (std::uint64_t i = 0; i < 300; ++i) {
                const FitQuery q = fitted.query(i);
                const auto ray = fitted.lens.trace(q.sensor, q.aperture, q.wavelengthNm);
                if (!ray) continue;
                const Connection found = fitted.lens.solve(ray->origin + distance * ray->direction,
                                                           q.aperture, q.wavelengthNm);
                REQUIRE(found.status == ConnectStatus::found);
                // Rounding: of a target 1e9 mm off, 1e-16 of an angle, times the focal length.
                CHECK((found.sensor->mm - q.sensor.mm).norm() <= 1e-9);
                // The first guess is off by micrometres, 1e-4 rad, which a step squares.
                CHECK(found.iterations <= 1);
            }
        }
}

TEST_CASE(
    "PolynomialLens: a sighting's ray meets the target, its weight is that of the ray there") {
    for (const Fitted* fitted : {&doubleGaussIn(FitForm::twoPoint), &fisheye()})
        for (const double distance : {300.0, 1e5}) {
            double offs = 0.0;
            int count = 0;
            for (std::uint64_t i = 0; i < 300; ++i) {
                const FitQuery q = fitted->query(i);
                const auto ray = fitted->lens.trace(q.sensor, q.aperture, q.wavelengthNm);
                if (!ray) continue;
                const Eigen::Vector3d target = ray->origin + distance * ray->direction;
                const auto weight = [&](const ExitRay& r) {
                    return r.throughput / determinantAcross(r.direction, footprint(r, distance));
                };
                // Alone, and after other wavelengths, of which the first has decided what is in
                // sight.
                const double wavelengthsNm[] = {700.0, 400.0, q.wavelengthNm};
                std::optional<Sighting> sightings[3];
                fitted->lens.seeEach(target, q.aperture, wavelengthsNm, sightings);
                for (const std::optional<Sighting>& seen :
                     {fitted->lens.see(target, q.aperture, q.wavelengthNm), sightings[2]}) {
                    REQUIRE(seen.has_value());
                    const Eigen::Vector3d toTarget = target - seen->ray.origin;
                    // The search may end 2e-5 rad off, and the last step squares that.
                    const double missed =
                        toTarget.cross(seen->ray.direction).norm() / toTarget.norm();
                    CHECK(missed <= 2.0 * 2e-5 * 2e-5);
                    CHECK(std::abs(seen->ray.direction.norm() - 1.0) <= 1e-14);
                    const double off = weight(seen->ray) / weight(*ray) - 1.0;
                    // Of 2e-5 rad; weights change by ten times themselves a radian near the rim.
                    CHECK(std::abs(off) <= 2e-4);
                    offs += off;
                    ++count;
                }
            }
            CHECK(std::abs(offs / count) <= 1e-5);  // and no bias to speak of
        }
}

TEST_CASE("PolynomialLens: what is said to be found again is what the search finds") {
    constexpr double toleranceMm = 1e-3;
    int found = 0;
    for (const Fitted* fitted :
         {&doubleGaussIn(FitForm::twoPoint), &doubleGaussIn(FitForm::sensorState), &fisheye()})
        for (const double distance : {1.0, 5.0, 20.0, 100.0, 1e3, 1e5, 1e12})
            for (std::uint64_t i = 0; i < 1000; ++i) {
                const FitQuery q = fitted->query(i);
                const auto ray = fitted->lens.trace(q.sensor, q.aperture, q.wavelengthNm);
                if (!ray) continue;
                const Eigen::Vector3d target = ray->origin + distance * ray->direction;
                const auto isFound = [&](SensorPoint at) {
                    return fitted->lens.finds(at, target, q.aperture, q.wavelengthNm, toleranceMm);
                };
                // Alone, and where another wavelength decides what is in sight.
                const double wavelengthsNm[] = {i % 2 == 0 ? 400.0 : 700.0, q.wavelengthNm};
                std::optional<Sighting> sightings[2];
                fitted->lens.seeEach(target, q.aperture, wavelengthsNm, sightings);
                for (const std::optional<Sighting>& seen :
                     {fitted->lens.see(target, q.aperture, q.wavelengthNm), sightings[1]}) {
                    const bool isSame = seen && (seen->sensor.mm - q.sensor.mm).norm() < 1e-6;
                    CHECK(isFound(q.sensor) == isSame);
                    found += isSame;
                }
                if (q.sensor.mm.norm() > 1.0) CHECK(!isFound({-q.sensor.mm}));
            }
    CHECK(found > 1000);
}

TEST_CASE("PolynomialLens: a fisheye's first guess takes in where the rays of a field leave") {
    // Its pupil wanders by 10 cm. Were all rays taken to come from one point, a target 30 cm off
    // would be missed by 20 degrees, and two steps or three be needed.
    const Fitted& fitted = fisheye();
    for (const double distance : {300.0, 2e3, 1e9}) {
        int rays = 0, steps = 0;
        for (std::uint64_t i = 0; i < 500; ++i) {
            const FitQuery q = fitted.query(i);
            const auto ray = fitted.lens.trace(q.sensor, q.aperture, q.wavelengthNm);
            if (!ray) continue;
            ++rays;
            const Connection found = fitted.lens.solve(ray->origin + distance * ray->direction,
                                                       q.aperture, q.wavelengthNm);
            REQUIRE(found.status == ConnectStatus::found);
            steps += found.iterations;
        }
        REQUIRE(rays > 100);
        CHECK(steps <= 1.25 * rays);
    }
}

TEST_CASE("PolynomialLens: where the published search ends, it ends at the same film point") {
    for (const FitForm form : bothForms) {
        const Fitted& fitted = doubleGaussIn(form);
        int found = 0, rays = 0;
        for (std::uint64_t i = 0; i < 300; ++i) {
            const FitQuery q = fitted.query(i);
            const auto ray = fitted.lens.trace(q.sensor, q.aperture, q.wavelengthNm);
            if (!ray) continue;
            ++rays;
            const Connection published =
                fitted.lens.solve(ray->origin + 1e5 * ray->direction, q.aperture, q.wavelengthNm,
                                  ConnectMethod::twoStep);
            if (!published.sensor) continue;
            ++found;
            CHECK((published.sensor->mm - q.sensor.mm).norm() <= 1e-6);
        }
        CHECK(found > rays * 9 / 10);
    }
}

TEST_CASE("PolynomialLens: outside its domain it says nothing, never a number") {
    const double nan = std::nan("");
    for (const FitForm form : bothForms) {
        const Fitted& fitted = doubleGaussIn(form);
        const PolynomialLens& lens = fitted.lens;
        const double r = fitted.fit.domain.apertureRadiusMm;
        const SensorPoint centre{{0.0, 0.0}};
        const AperturePoint open{{0.0, 0.0}};
        REQUIRE(lens.trace(centre, open, greenNm).has_value());
        for (const double x : {18.001, -19.0, 1e4, 1e300, infinity, nan}) {
            CHECK_FALSE(lens.trace({{x, 0.0}}, open, greenNm).has_value());
            CHECK_FALSE(lens.trace({{0.0, x}}, open, greenNm).has_value());
        }
        for (const double x : {1.001 * r, -2.0 * r, 1e300, infinity, nan}) {
            CHECK_FALSE(lens.trace(centre, {{0.0, x}}, greenNm).has_value());
            CHECK_FALSE(lens.connect({0.0, 0.0, 1e3}, {{x, 0.0}}, greenNm).has_value());
        }
        for (const double wavelength : {399.99, 700.01, 0.0, -550.0, infinity, nan}) {
            CHECK_FALSE(lens.trace(centre, open, wavelength).has_value());
            CHECK_FALSE(lens.connect({0.0, 0.0, 1e3}, open, wavelength).has_value());
        }
        for (const double wavelength : {400.0, 700.0}) {
            CHECK(lens.trace(centre, open, wavelength).has_value());
            CHECK(lens.connect({0.0, 0.0, 1e3}, open, wavelength).has_value());
        }
    }
}

TEST_CASE("PolynomialLens: a target that cannot be seen is told from one that is blocked") {
    const PolynomialLens& lens = doubleGaussIn(FitForm::twoPoint).lens;
    const AperturePoint centre{{0.0, 0.0}};
    const auto status = [&](const Eigen::Vector3d& target, AperturePoint a) {
        return lens.solve(target, a, greenNm).status;
    };
    CHECK(status({0.0, 0.0, 1e3}, centre) == ConnectStatus::found);
    CHECK(status({900.0, 0.0, 1e3}, centre) == ConnectStatus::outOfField);
    CHECK(status({0.0, 0.0, -1e4}, centre) == ConnectStatus::outOfField);
    CHECK(status({0.0, std::nan(""), 1e4}, centre) == ConnectStatus::outOfField);
    CHECK(status({0.0, 0.0, infinity}, centre) == ConnectStatus::outOfField);
    // At the edge of the field the front element cuts half of the aperture off: a point that is
    // seen through one side of it is not seen through the other.
    const TracedLens& exact = doubleGaussIn(FitForm::twoPoint).exact;
    const double r = 0.95 * exact.system().aperture.radiusMm();
    const SensorPoint corner{{17.5, 11.5}};
    const Eigen::Vector2d outward = corner.mm.normalized();
    const auto chief = exact.trace(corner, centre, greenNm);
    REQUIRE(chief.has_value());
    const Eigen::Vector3d target = chief->origin + 1e6 * chief->direction;
    const ConnectStatus sides[] = {status(target, {r * outward}), status(target, {-r * outward})};
    CHECK(std::ranges::count(sides, ConnectStatus::blocked) >= 1);
    CHECK(status(target, centre) == ConnectStatus::found);
}

TEST_CASE("PolynomialLens: a fisheye connects to what is behind it") {
    const Fitted& fitted = fisheye();
    int behind = 0;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        const FitQuery q = fitted.query(i);
        const auto ray = fitted.lens.trace(q.sensor, q.aperture, q.wavelengthNm);
        if (!ray || ray->direction.z() > -0.05) continue;
        ++behind;
        const auto found =
            fitted.lens.connect(ray->origin + 500.0 * ray->direction, q.aperture, q.wavelengthNm);
        REQUIRE(found.has_value());
        CHECK((found->mm - q.sensor.mm).norm() <= 1e-8);
    }
    CHECK(behind > 20);
}

TEST_CASE("PolynomialLens: one aperture point sees one target from one film point") {
    // Searches from all over the sensor end at one place, or nowhere.
    for (const Fitted* fitted : {&doubleGaussIn(FitForm::twoPoint), &fisheye()}) {
        const FittedMap map(fitted->prescription, fitted->fit);
        const Eigen::Vector2d half = fitted->fit.domain.sensorHalfSizeMm;
        for (std::uint64_t i = 0; i < 60; ++i) {
            const FitQuery q = fitted->query(i);
            const auto ray = fitted->lens.trace(q.sensor, q.aperture, q.wavelengthNm);
            if (!ray) continue;
            const Eigen::Vector3d target = ray->origin + 300.0 * ray->direction;
            const auto exit = [&](const Eigen::Vector2d& s, double) {
                return map.exitRay({s}, q.aperture, q.wavelengthNm);
            };
            TargetSolver solver(exit, 20.0);
            for (const double x : {-0.9, -0.3, 0.3, 0.9})
                for (const double y : {-0.9, -0.3, 0.3, 0.9}) {
                    const auto end =
                        solver.newton(target, half.cwiseProduct(Eigen::Vector2d(x, y)));
                    if (!end ||
                        !fitted->lens.trace({end->sensor}, q.aperture, q.wavelengthNm).has_value())
                        continue;
                    CHECK((end->sensor - q.sensor.mm).norm() <= 1e-7);
                }
        }
    }
}

TEST_CASE("PolynomialLens: where its map has turned over it says nothing, from either side") {
    const Fitted& fitted = doubleGaussIn(FitForm::twoPoint);
    LensFit fit = fitted.fit;
    // Seen from afar the lens is −s/f, s up to 21.6 mm of 100. With as much of ρ s added, ρ being 1
    // in the corners, directions turn back outward of 1/√3 of the way.
    TermGroup& group = fit.exit.groups.front();
    const Eigen::Index linear =
        std::ranges::find(group.terms, Exponents{1, 0, 0, 0, 0}) - group.terms.begin();
    REQUIRE(linear < group.coefficients.cols());
    group.coefficients(2, linear) += 0.216;
    const PolynomialLens lens(fitted.prescription, fit, fitted.stop);
    const FittedMap map(fitted.prescription, fit);
    const AperturePoint centre{{0.0, 0.0}};
    const SensorPoint inside{{9.0, 6.0}}, outside{{17.0, 11.0}};
    CHECK(lens.trace(inside, centre, greenNm).has_value());
    CHECK_FALSE(lens.trace(outside, centre, greenNm).has_value());
    const auto turned = map.exitRay(outside, centre, greenNm);
    REQUIRE(turned.has_value());
    const Eigen::Vector3d target = turned->origin + 1e4 * turned->direction;
    const auto found = lens.connect(target, centre, greenNm);
    // The same target is seen from within, too, where the map has not turned.
    REQUIRE(found.has_value());
    CHECK(found->mm.norm() < 0.75 * 21.6);
}

TEST_CASE("PolynomialLens: a pinhole of a stop, and a lens a thousand times smaller or larger") {
    const FitSettings settings = settingsOf(FitForm::twoPoint, 12, 5);
    for (const double size : {1e-3, 1.0, 1e3}) {
        FitDomain domain = doubleGaussDomain();
        domain.sensorHalfSizeMm *= size;
        domain.sensorDistanceMm *= size;
        domain.apertureRadiusMm *= size;
        const Fitted fitted(scaled(doubleGauss(), size), domain, settings, 1e-4);
        int rays = 0;
        for (std::uint64_t i = 0; i < 200; ++i) {
            const FitQuery q = fitted.query(i);
            const auto ray = fitted.lens.trace(q.sensor, q.aperture, q.wavelengthNm);
            if (!ray) continue;
            ++rays;
            const auto found = fitted.lens.connect(ray->origin + 1e3 * size * ray->direction,
                                                   q.aperture, q.wavelengthNm);
            REQUIRE(found.has_value());
            CHECK((found->mm - q.sensor.mm).norm() <= 1e-9 * size);
        }
        CHECK(rays > 150);
    }
}

/// Every ray that leaves is found again from targets near and far.
void checkEveryRoundTrip(const Fitted& fitted, const std::vector<double>& distances) {
    int rays = 0, lost = 0;
    for (std::uint64_t i = 0; i < 600; ++i) {
        const FitQuery q = fitted.query(i);
        const auto ray = fitted.lens.trace(q.sensor, q.aperture, q.wavelengthNm);
        if (!ray) continue;
        ++rays;
        const double distance = distances[i % distances.size()];
        const Eigen::Vector3d target = ray->origin + distance * ray->direction;
        const auto found = fitted.lens.connect(target, q.aperture, q.wavelengthNm);
        lost += !(found && (found->mm - q.sensor.mm).norm() < 1e-6);
    }
    CHECK(rays > 200);
    CHECK(lost == 0);
}

/// The sensor 50 mm behind the stop.
FitDomain behindStop() {
    FitDomain domain{};
    domain.sensorHalfSizeMm = {4.0, 3.0};
    domain.sensorDistanceMm = 50.0;
    domain.apertureRadiusMm = 2.0;
    return domain;
}

TEST_CASE("PolynomialLens: a lens telecentric at its objects connects as any other") {
    // The stop near the rear focus: the entrance pupil lies a metre before the lens, behind it, or
    // at infinity. As far away as that all sensor points see the same.
    Prescription lens = singlet(50.0, -50.0, 4.0, 1.5, 12.0);
    const double focus = paraxialData(OpticalSystem(lens)).y.backFocalDistanceMm;
    for (const double beyondFocus : {5.0, 2.0, 0.7, 0.0, -0.7}) {
        CAPTURE(beyondFocus);
        lens.surfaces[1].thicknessMm = focus + beyondFocus;
        const double pupil = paraxialData(OpticalSystem(lens)).y.entrancePupilZMm;
        CHECK(std::abs(pupil) > 900.0);
        checkEveryRoundTrip(Fitted(lens, behindStop(), settingsOf(FitForm::twoPoint)),
                            {10.0, 40.0, 100.0, 200.0});
    }
}

TEST_CASE("PolynomialLens: a lens that diverges connects as any other") {
    checkEveryRoundTrip(
        Fitted(singlet(-50.0, 50.0, 3.0, 1.5, 12.0), behindStop(), settingsOf(FitForm::twoPoint)),
        {10.0, 40.0, 100.0, 1e3, 1e9});
}

TEST_CASE("PolynomialLens: what does not belong together is refused") {
    const LensFit& fit = doubleGaussIn(FitForm::twoPoint).fit;
    const double r = fit.domain.apertureRadiusMm;
    CHECK_NOTHROW(PolynomialLens(doubleGauss(), fit, Aperture(r)));
    CHECK_THROWS_AS(PolynomialLens(doubleGauss(), fit, Aperture(1.001 * r)), std::invalid_argument);
    const Prescription other = loadPrescription(lensFile("tessar-100mm.toml"));
    CHECK_THROWS_AS(PolynomialLens(other, fit, Aperture(0.1 * r)), std::invalid_argument);
}

TEST_CASE("PolynomialLens: focused as near as may be, connect misses none of its rays" *
          doctest::test_suite("statistical")) {
    for (const char* file : {"double-gauss-50mm-f1.1.toml", "double-gauss-100mm.toml",
                             "tessar-100mm.toml", "fisheye-10mm.toml"})
        for (const FitForm form : bothForms) {
            CAPTURE(file);
            const Prescription table = loadPrescription(lensFile(file));
            const ParaxialData data = paraxialData(OpticalSystem(table));
            const double nearest = data.y.frontFocalDistanceMm - data.lastVertexZMm +
                                   data.y.backFocalDistanceMm + 2.0 * data.y.focalLengthMm;
            const FitDomain domain = fitDomain(table, {{24.0, 16.0}, 1.0001 * nearest});
            checkEveryRoundTrip(Fitted(table, domain, settingsOf(form)),
                                {5.0, 30.0, 0.3 * nearest, nearest, 1e3, 1e9});
        }
}

TEST_CASE("PolynomialLens: connect misses none of the rays of any lens" *
          doctest::test_suite("statistical")) {
    // From wide open to f/64 and beyond, from 5 mm to infinity. Of 10,000 rays and more for each
    // lens not one may be lost.
    for (const ShippedLens& shipped : shippedLenses())
        for (const FitForm form : bothForms) {
            CAPTURE(shipped.file);
            CAPTURE(static_cast<int>(form));
            FitSettings settings;
            settings.form = form;
            const Prescription table = load(shipped);
            if (isAnamorphic(table)) settings.basis = PolynomialBasis::twoPlane;
            const Fitted fitted(table, fitDomain(table, {}), settings);
            int rays = 0, lost = 0, elsewhere = 0;
            double farthestMm = 0.0;
            for (std::uint64_t i = 0; rays < 10'000 && i < 100'000; ++i) {
                FitQuery q = fitted.query(i);
                const double stops[] = {1.0, 0.3, 0.05, 1e-4};
                q.aperture.mm *= stops[i % 4];
                const auto ray = fitted.lens.trace(q.sensor, q.aperture, q.wavelengthNm);
                if (!ray) continue;
                ++rays;
                farthestMm = std::max(farthestMm, ray->origin.norm());
                const double distances[] = {5.0, 30.0, 100.0, 300.0, 1e3, 1e4, 1e9};
                const Eigen::Vector3d target = ray->origin + distances[i % 7] * ray->direction;
                const auto found = fitted.lens.connect(target, q.aperture, q.wavelengthNm);
                if (!found)
                    ++lost;
                else if ((found->mm - q.sensor.mm).norm() > 1e-6)
                    ++elsewhere;
            }
            CHECK(rays >= 10'000);
            CHECK(lost == 0);
            CHECK(farthestMm <= fitted.lens.reachMm());
            CHECK(elsewhere == 0);
        }
}

}  // namespace
}  // namespace etendue
