// Where a ray comes from at another wavelength, held against traces and finite differences.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "lens/fit_domain.h"
#include "lens/polynomial_lens.h"
#include "lens/refocused_lens.h"
#include "tests/lens/fitted_lenses.h"
#include "tests/lens/lens_checks.h"

namespace etendue {
namespace {

constexpr std::array<double, 4> wavelengthsNm = {475.0, 550.0, 625.0, 400.0};
using Origins = std::array<std::optional<RayOrigin>, wavelengthsNm.size()>;

Origins originsFrom(const LensModel& lens, SensorPoint s, AperturePoint a,
                    const std::array<double, 4>& nm = wavelengthsNm) {
    Origins origins;
    lens.traceEach(s, a, nm, origins);
    return origins;
}

struct Contender {
    const char* name;
    std::unique_ptr<LensModel> lens;
    double toleranceRadians;
    Eigen::Vector2d fieldMm;
};

std::vector<Contender> makeContenders() {
    std::vector<Contender> result;
    const Prescription gauss = doubleGauss(),
                       petzval = loadPrescription(lensFile("petzval-50mm.toml"));
    const Aperture aperture(doubleGaussDomain().apertureRadiusMm);
    const Eigen::Vector2d field(15.0, 10.0);
    result.push_back({"traced", makeTracedLens(gauss), 1e-9, field});
    // Searches end with an unchecked step from within 2e-5.
    constexpr double searched = 1e-7;
    for (const FitForm form : {FitForm::twoPoint, FitForm::sensorState}) {
        FitSettings settings = smallSettings();
        settings.form = form;
        const LensFit fit = fitLens(gauss, doubleGaussDomain(), settings);
        result.push_back({form == FitForm::twoPoint ? "two points" : "sensor state",
                          std::make_unique<PolynomialLens>(gauss, fit, aperture), searched, field});
    }
    DomainRequest request;
    request.nearestFocusMm = 1000.0;
    request.shortestWavelengthNm = 400.0;
    request.longestWavelengthNm = 700.0;
    const FitDomain domain = fitDomain(petzval, request);
    const LensFit fit = fitLens(petzval, domain, smallSettings());
    result.push_back({"refocused",
                      std::make_unique<RefocusedLens>(
                          petzval, fit, Aperture(domain.apertureRadiusMm),
                          sensorDistanceMm(paraxialData(OpticalSystem(petzval)), 1200.0)),
                      searched, Eigen::Vector2d(7.0, 5.0)});
    return result;
}

const std::vector<Contender>& contenders() {
    static const std::vector<Contender> all = makeContenders();
    return all;
}

/// Of two rays as lines.
double angleBetween(const ExitRay& a, const ExitRay& b) {
    return (a.direction - b.direction).norm();
}
double distanceBetween(const ExitRay& a, const ExitRay& b) {
    return (a.origin - b.origin).cross(b.direction).norm();
}

TEST_CASE("Ray origins: a ray traced from where it comes from leaves as the hero's does") {
    for (const Contender& c : contenders()) {
        CAPTURE(std::string(c.name));
        LensRandom random(91);
        int found = 0, missing = 0, moved = 0, refused = 0;
        for (int i = 0; i < 200; ++i) {
            const SensorPoint s = random.onSensor(c.fieldMm.x(), c.fieldMm.y());
            const AperturePoint a = c.lens->sampleAperture(random.inUnitSquare());
            const Origins origins = originsFrom(*c.lens, s, a);
            const auto hero = c.lens->trace(s, a, wavelengthsNm[0]);
            REQUIRE(hero.has_value() == origins[0].has_value());
            if (!hero) continue;
            CHECK((origins[0]->sensor.mm - s.mm).norm() <= 1e-9);
            for (std::size_t k = 0; k < origins.size(); ++k) {
                if (!origins[k]) {
                    ++missing;
                    continue;
                }
                const RayOrigin& origin = *origins[k];
                const auto ray = c.lens->trace(origin.sensor, origin.aperture, wavelengthsNm[k]);
                ++found;
                if (!ray) {  // a rim, to the tolerance
                    ++refused;
                    continue;
                }
                moved += (origin.sensor.mm - s.mm).norm() > 1e-3;
                CHECK(angleBetween(*ray, *hero) <= c.toleranceRadians);
                CHECK(distanceBetween(*ray, *hero) <= 100.0 * c.toleranceRadians);
                // Within the tolerance of the search, whose last evaluation they are.
                CHECK(std::abs(ray->throughput - origin.ray.throughput) <= 1e-3 * ray->throughput);
                CHECK((ray->directionBySensor - origin.ray.directionBySensor).norm() <=
                      1e-3 * ray->directionBySensor.norm());
            }
        }
        CHECK(found > 200);
        CHECK(moved > 100);  // the lens has colours to part
        CHECK(missing < found / 10);
        CHECK(refused < found / 100);
    }
}

TEST_CASE("Ray origins: from any of them one finds the others") {
    for (const Contender& c : contenders()) {
        CAPTURE(std::string(c.name));
        LensRandom random(92);
        int same = 0, different = 0;
        for (int i = 0; i < 100; ++i) {
            const SensorPoint s = random.onSensor(c.fieldMm.x(), c.fieldMm.y());
            const Origins origins =
                originsFrom(*c.lens, s, c.lens->sampleAperture(random.inUnitSquare()));
            for (std::size_t k = 1; k < origins.size(); ++k) {
                if (!origins[k]) continue;
                std::array<double, 4> rotated;
                for (std::size_t j = 0; j < rotated.size(); ++j)
                    rotated[j] = wavelengthsNm[(k + j) % rotated.size()];
                const Origins again =
                    originsFrom(*c.lens, origins[k]->sensor, origins[k]->aperture, rotated);
                for (std::size_t j = 0; j < again.size(); ++j) {
                    const auto &one = again[j], &other = origins[(k + j) % again.size()];
                    const bool isSame =
                        one.has_value() == other.has_value() &&
                        (!one || (std::abs(one->etendue / other->etendue - 1.0) <= 1e-3 &&
                                  (one->sensor.mm - other->sensor.mm).norm() <= 1e-5));
                    (isSame ? same : different) += 1;
                }
            }
        }
        CHECK(same > 500);
        CHECK(different == 0);
    }
}

TEST_CASE("Ray origins: étendue is what finite differences say") {
    for (const Contender& c : contenders()) {
        CAPTURE(std::string(c.name));
        LensRandom random(93);
        int checked = 0;
        for (int i = 0; i < 40; ++i) {
            const SensorPoint s = random.onSensor(0.8 * c.fieldMm.x(), 0.8 * c.fieldMm.y());
            const AperturePoint a{0.7 * c.lens->sampleAperture(random.inUnitSquare()).mm};
            const Origins origins = originsFrom(*c.lens, s, a);
            for (std::size_t k = 0; k < origins.size(); ++k) {
                if (!origins[k]) continue;
                const RayOrigin& at = *origins[k];
                // Across the ray: two of its place, two of its direction.
                const Eigen::Vector3d d = at.ray.direction, u = d.unitOrthogonal(), v = d.cross(u);
                const auto coordinates = [&](int axis,
                                             double step) -> std::optional<Eigen::Vector4d> {
                    SensorPoint sensor = at.sensor;
                    AperturePoint aperture = at.aperture;
                    (axis < 2 ? sensor.mm : aperture.mm)[axis % 2] += step;
                    const auto ray = c.lens->trace(sensor, aperture, wavelengthsNm[k]);
                    if (!ray) return {};
                    return Eigen::Vector4d(ray->origin.dot(u), ray->origin.dot(v),
                                           ray->direction.dot(u), ray->direction.dot(v));
                };
                constexpr double step = 1e-3;
                Eigen::Matrix4d moves;
                bool isWhole = true;
                for (int axis = 0; axis < 4; ++axis) {
                    const auto there = coordinates(axis, step), back = coordinates(axis, -step);
                    isWhole = isWhole && there && back;
                    if (isWhole) moves.col(axis) = (*there - *back) / (2.0 * step);
                }
                if (!isWhole) continue;
                ++checked;
                CHECK(at.etendue == doctest::Approx(std::abs(moves.determinant())).epsilon(2e-3));
            }
        }
        CHECK(checked > 60);
    }
}

TEST_CASE("Ray origins: a lens that parts no colours has one for all") {
    const auto lens = makeThinLens(50.0, 2000.0, 10.0);
    const Origins origins = originsFrom(*lens, {{3.0, -4.0}}, {{5.0, 2.0}});
    for (const auto& origin : origins) {
        REQUIRE(origin.has_value());
        CHECK(origin->sensor.mm == Eigen::Vector2d(3.0, -4.0));
        CHECK(origin->aperture.mm == Eigen::Vector2d(5.0, 2.0));
        CHECK(origin->etendue > 0.0);
    }
    for (const auto& origin : originsFrom(*lens, {{3.0, -4.0}}, {{20.0, 0.0}}))
        CHECK(!origin.has_value());
}

}  // namespace
}  // namespace etendue
