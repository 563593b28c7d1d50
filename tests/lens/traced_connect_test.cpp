// TracedLens::connect and see against searches that know nothing of how they search.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "lens/target_solver.h"
#include "lens/traced_lens.h"
#include "tests/lens/lens_checks.h"
#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::unique_ptr<TracedLens> lensAt(const ShippedLens& shipped, double stopped) {
    const Prescription prescription = load(shipped);
    return makeTracedLens(prescription, {stopped * prescription.stated.fNumber, {}, infinity});
}

/// Newton's method on trace() itself, from everywhere on the sensor.
bool isSeenFromSomewhere(const TracedLens& lens, double imageHeightMm,
                         const Eigen::Vector3d& target, AperturePoint aperture,
                         double wavelengthNm) {
    const auto exit = [&](const Eigen::Vector2d& s, double) {
        return lens.trace({s}, aperture, wavelengthNm);
    };
    constexpr int rings = 4, directions = 8;
    for (int i = 0; i <= rings; ++i)
        for (int k = 0; k < (i == 0 ? 1 : directions); ++k) {
            const double radius = 1.3 * imageHeightMm * i / rings;
            const double turn = 2.0 * std::numbers::pi * k / directions;
            TargetSolver solver(exit, std::abs(lens.focalLengthMm()));
            const auto end =
                solver.newton(target, radius * Eigen::Vector2d(std::cos(turn), std::sin(turn)));
            if (end && lens.trace({end->sensor}, aperture, wavelengthNm)) return true;
        }
    return false;
}

struct Tally {
    int found = 0, nothing = 0, lost = 0;
};

/// Of targets anywhere about the lens and about its field.
Tally tallyOf(const ShippedLens& shipped, double stopped, int targets, LensRandom& random) {
    const auto lens = lensAt(shipped, stopped);
    const auto edge = lens->at(greenNm)->chiefRay({{shipped.imageHeightMm, 0.0}});
    REQUIRE(edge.has_value());
    const double field = std::acos(edge->direction.z());
    Tally tally;
    for (int i = 0; i < targets; ++i) {
        const AperturePoint a = lens->sampleAperture(random.inUnitSquare());
        const double off =
            i % 3 == 0 ? std::acos(random.between(-1.0, 1.0)) : random.between(0.0, 1.2 * field);
        const double turn = random.between(0.0, 2.0 * std::numbers::pi);
        const double distance = std::pow(10.0, random.between(1.7, 6.0));
        const double wavelength = random.between(350.0, 1100.0);
        const Eigen::Vector3d target =
            distance * Eigen::Vector3d(std::sin(off) * std::cos(turn),
                                       std::sin(off) * std::sin(turn), std::cos(off));
        const Connection connection = lens->solve(target, a, wavelength);
        if (connection.sensor) {
            ++tally.found;
            continue;
        }
        ++tally.nothing;
        tally.lost += isSeenFromSomewhere(*lens, shipped.imageHeightMm, target, a, wavelength);
    }
    return tally;
}

void checkNothingIsLost(int targets, std::uint64_t seed) {
    LensRandom random(seed);
    for (const ShippedLens& shipped : shippedLenses())
        for (const double stopped : {1.0, 4.0}) {
            CAPTURE(shipped.file);
            CAPTURE(stopped);
            const Tally tally = tallyOf(shipped, stopped, targets, random);
            CHECK(tally.lost == 0);
            CHECK(tally.found > 0);
            CHECK(tally.nothing > 0);
        }
}

TEST_CASE("TracedLens: a target that connect gives up is seen from nowhere on the sensor") {
    checkNothingIsLost(30, 71);
}

TEST_CASE("TracedLens: of 48000 targets that connect gives up none is seen from the sensor" *
          doctest::test_suite("statistical")) {
    checkNothingIsLost(2000, 72);
}

/// That see() gives the ray that trace() makes where it says, for targets before the lens; how many
/// of them are seen.
int checkSightings(const TracedLens& lens, int targets, LensRandom& random) {
    int seen = 0;
    for (int i = 0; i < targets; ++i) {
        const AperturePoint a = lens.sampleAperture(random.inUnitSquare());
        const double wavelength = random.between(350.0, 1100.0);
        const double distance = std::pow(10.0, random.between(1.7, 6.0));
        const Eigen::Vector3d target =
            distance * Eigen::Vector3d(random.between(-0.3, 0.3), random.between(-0.3, 0.3), 1.0);
        const auto sighting = lens.see(target, a, wavelength);
        const auto sensor = lens.connect(target, a, wavelength);
        REQUIRE(sighting.has_value() == sensor.has_value());
        if (!sighting) continue;
        ++seen;
        CHECK(sighting->sensor.mm == sensor->mm);
        const auto ray = lens.trace(*sensor, a, wavelength);
        REQUIRE(ray.has_value());
        // Toward the target, and from where trace's leaves, as far as either solves.
        CHECK(missOf(*ray, target).squared <= 1e-20);
        CHECK(missOf(sighting->ray, target).squared <= 1e-24);  // the search's own end
        CHECK((ray->origin - sighting->ray.origin).norm() <= 1e-8);
        CHECK((ray->direction - sighting->ray.direction).norm() <= 1e-10);
        // J from the stop's end is that from the sensor's.
        CHECK(sighting->ray.throughput ==
              doctest::Approx(ray->throughput).scale(0.0).epsilon(1e-8));
        // Derivatives are those of a ray within 1.5e-6 rad, of the tenths of a radian on which
        // they change.
        constexpr double near = 1e-4;
        const double byDirection = ray->directionBySensor.norm();
        CHECK((ray->directionBySensor - sighting->ray.directionBySensor).norm() <=
              near * byDirection);
        CHECK((ray->originBySensor - sighting->ray.originBySensor).norm() <=
              near * (ray->originBySensor.norm() +
                      byDirection * lens.system().surfaces.front().semiApertureMm));
    }
    return seen;
}

TEST_CASE("TracedLens: what connect finds trace makes, and see gives the same ray") {
    LensRandom random(73);
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        CHECK(checkSightings(*lensAt(shipped, 1.0), 300, random) > 30);
    }
}

TEST_CASE("TracedLens: a stop within glass connects as any other") {
    Prescription ball = singlet(20.0, -40.0, 6.0, 1.6, 8.0);
    ball.surfaces = {spherical(20.0, 4.0, 8.0, plainGlass(1.6)), stop(4.0, 4.0),
                     spherical(-40.0, 30.0, 8.0)};
    ball.surfaces[1].behind = plainGlass(1.6);
    const TracedLens lens(ball, Aperture(3.0), 25.0);
    LensRandom random(74);
    CHECK(checkSightings(lens, 300, random) > 30);
}

TEST_CASE("TracedLens: connect finds rays beside those that fold") {
    // Wide open, where the search from a first guess comes to a fold for one ray in a thousand.
    LensRandom random(75);
    const ShippedLens shipped{"fisheye-220-6mm.toml", 11.0};
    const auto lens = makeTracedLens(load(shipped));
    int passed = 0, lost = 0;
    for (int i = 0; i < 20000; ++i) {
        const SensorPoint s = random.onSensor(shipped.imageHeightMm, shipped.imageHeightMm);
        const AperturePoint a = lens->sampleAperture(random.inUnitSquare());
        const auto ray = lens->trace(s, a, greenNm);
        if (!ray) continue;
        ++passed;
        const auto found = lens->connect(ray->origin + 1e3 * ray->direction, a, greenNm);
        lost += !(found && (found->mm - s.mm).norm() <= 1e-9);
    }
    CHECK(passed > 5000);
    CHECK(lost == 0);
}

}  // namespace
}  // namespace etendue
