#include "lens/phase_space.h"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "tests/lens/lens_checks.h"
#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

using Point = Vector3<double>;

double distance(const Point& a, const Point& b) { return std::sqrt(dot(a - b, a - b)); }

/// The distance of a point from a ray's line.
double offLine(const LensRay<double>& ray, const Point& point) {
    const Point away = point - ray.origin;
    return distance(away, ray.direction * dot(away, ray.direction));
}

PupilSphere sphereWith(const Surface& first) {
    Prescription prescription = singlet(50.0, -50.0, 30.0, 1.5, 10.0);
    prescription.surfaces[0] = first;
    prescription.surfaces[0].thicknessMm = 100.0;
    prescription.surfaces[0].behind = plainGlass(1.5);
    return PupilSphere(OpticalSystem(prescription));
}

Surface cylinder(double radiusMm) {
    Surface surface = spherical(radiusMm, 1.0, 20.0);
    surface.kind = SurfaceKind::cylinderX;
    return surface;
}

TEST_CASE("PupilSphere: a ray survives the way to pupil coordinates and back") {
    LensRandom random(41);
    const double inf = std::numeric_limits<double>::infinity();
    for (const Surface& first :
         {spherical(143.0, 1.0, 106.0), spherical(25.0, 1.0, 24.0), spherical(-60.0, 1.0, 40.0),
          spherical(inf, 1.0, 20.0), cylinder(30.0)}) {
        const PupilSphere sphere = sphereWith(first);
        double farthest = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const double h = first.semiApertureMm * std::sqrt(random.between(0.0, 1.0));
            const double turn = random.between(0.0, 2.0 * std::numbers::pi);
            const double x = h * std::cos(turn), y = h * std::sin(turn);
            // Directions over the whole hemisphere about the normal, within 1 % of its edge.
            const double r = std::sqrt(random.between(0.0, 0.99));
            const double phi = random.between(0.0, 2.0 * std::numbers::pi);
            const PupilState<double> state{x, y, r * std::cos(phi), r * std::sin(phi)};
            const auto ray = sphere.ray(state);
            REQUIRE(ray.has_value());
            CHECK(dot(ray->direction, ray->direction) == doctest::Approx(1.0).epsilon(1e-14));
            farthest = std::max(farthest, std::acos(ray->direction.z));
            // From anywhere along the ray.
            const LensRay<double> moved{ray->origin + ray->direction * random.between(-30.0, 90.0),
                                        ray->direction};
            const auto again = sphere.state(moved);
            REQUIRE(again.has_value());
            // Rounding of coordinates of 200 mm, over the cosine to the normal, 0.1.
            CHECK(std::hypot(again->x - state.x, again->y - state.y) <= 1e-11);
            CHECK(std::hypot(again->directionX - state.directionX,
                             again->directionY - state.directionY) <= 1e-11);
            const auto ray2 = sphere.ray(*again);
            REQUIRE(ray2.has_value());
            CHECK(offLine(moved, ray2->origin) <= 1e-9);
            CHECK(distance(ray2->direction, moved.direction) <= 1e-9);
        }
        const bool isBowl = std::isfinite(first.radiusMm) && first.kind == SurfaceKind::spherical;
        if (isBowl) CHECK(farthest > 0.6 * std::numbers::pi);  // beyond 90°: 108° and more
    }
}

TEST_CASE("PupilSphere: on the axis its directions are the ray's own") {
    const PupilSphere sphere = sphereWith(spherical(40.0, 1.0, 30.0));
    const Point direction = normalized(Point{0.3, -0.2, 1.0});
    const auto state = sphere.state(LensRay<double>{{0, 0, 0}, direction});
    REQUIRE(state.has_value());
    CHECK(state->directionX == doctest::Approx(direction.x).epsilon(1e-15));
    CHECK(state->directionY == doctest::Approx(direction.y).epsilon(1e-15));
}

TEST_CASE("PupilSphere: a ray along the normal has no tangential direction") {
    const PupilSphere sphere = sphereWith(spherical(40.0, 1.0, 30.0));
    for (const double x : {0.0, 12.0, 29.0}) {
        const Point normal =
            normalized(Point{x, 7.0, 0.0} + Point{0, 0, std::sqrt(1600.0 - x * x - 49.0)});
        const auto state = sphere.state(LensRay<double>{Point{0, 0, -40}, normal});
        REQUIRE(state.has_value());
        CHECK(std::hypot(state->directionX, state->directionY) <= 1e-14);
        CHECK(state->x == doctest::Approx(x).epsilon(1e-13));
    }
}

TEST_CASE("PupilSphere: turning a ray about the axis turns its coordinates") {
    // What lets a fit use the lens's symmetry; a frame made by a cross product with a fixed axis
    // does not do it.
    const PupilSphere sphere = sphereWith(spherical(40.0, 1.0, 30.0));
    const LensRay<double> ray{{10, 14, -6}, normalized(Point{0.5, 0.9, 0.3})};
    const auto before = sphere.state(ray);
    REQUIRE(before.has_value());
    const double c = std::cos(1.1), s = std::sin(1.1);
    const auto turned = [&](double x, double y) {
        return Eigen::Vector2d(c * x - s * y, s * x + c * y);
    };
    const auto turnedPoint = [&](const Point& p) {
        const Eigen::Vector2d xy = turned(p.x, p.y);
        return Point{xy.x(), xy.y(), p.z};
    };
    const auto after =
        sphere.state(LensRay<double>{turnedPoint(ray.origin), turnedPoint(ray.direction)});
    REQUIRE(after.has_value());
    const Eigen::Vector2d position = turned(before->x, before->y);
    const Eigen::Vector2d direction = turned(before->directionX, before->directionY);
    CHECK(std::hypot(after->x - position.x(), after->y - position.y()) <= 1e-13);
    CHECK(std::hypot(after->directionX - direction.x(), after->directionY - direction.y()) <=
          1e-14);
}

TEST_CASE("PupilSphere: states that are no ray are nothing") {
    const PupilSphere sphere = sphereWith(spherical(40.0, 1.0, 30.0));
    CHECK_FALSE(sphere.ray({40.1, 0, 0, 0}).has_value());
    CHECK_FALSE(sphere.ray({0, 0, 0.8, 0.61}).has_value());
    CHECK_FALSE(sphere.ray({std::nan(""), 0, 0, 0}).has_value());
    CHECK_FALSE(sphere.state(LensRay<double>{{41, 0, 0}, {0, 0, 1}}).has_value());
    CHECK_FALSE(sphere.state(LensRay<double>{{0, 0, 0}, {0, 0, -1}}).has_value());
}

TEST_CASE("PlaneState: a ray survives the way to a plane's coordinates and back") {
    LensRandom random(42);
    for (int i = 0; i < 200; ++i) {
        const SensorState state{random.between(-20, 20), random.between(-20, 20),
                                random.between(-2, 2), random.between(-2, 2)};
        LensRay<double> ray = rayOf(state, -71.0);
        ray.origin = ray.origin + ray.direction * random.between(-50, 50);
        const SensorState again = planeState(ray, -71.0);
        // Rounding of coordinates up to 150.
        CHECK(std::hypot(again.x - state.x, again.y - state.y) <= 1e-12);
        CHECK(std::hypot(again.slopeX - state.slopeX, again.slopeY - state.slopeY) <= 1e-14);
    }
}

TEST_CASE("etendueDeterminant: empty space has 1") {
    // Rays from a plane at z = −50 straight to the sphere.
    const PupilSphere sphere = sphereWith(spherical(40.0, 1.0, 30.0));
    using D = Dual<4>;
    LensRandom random(43);
    for (int i = 0; i < 100; ++i) {
        const SensorState at{random.between(-10, 10), random.between(-10, 10),
                             random.between(-0.3, 0.3), random.between(-0.3, 0.3)};
        const PlaneState<D> seeded{D::variable(at.x, 0), D::variable(at.y, 1),
                                   D::variable(at.slopeX, 2), D::variable(at.slopeY, 3)};
        const auto pupil = sphere.state(rayOf(seeded, -50.0));
        REQUIRE(pupil.has_value());
        Eigen::Matrix4d jacobian;
        const D* rows[] = {&pupil->x, &pupil->y, &pupil->directionX, &pupil->directionY};
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                jacobian(row, column) = rows[row]->partials[static_cast<std::size_t>(column)];
        const PupilState<double> value{pupil->x.value, pupil->y.value, pupil->directionX.value,
                                       pupil->directionY.value};
        CHECK(etendueDeterminant(jacobian, at, value, sphere) ==
              doctest::Approx(1.0).epsilon(1e-12));
    }
}

}  // namespace
}  // namespace etendue
