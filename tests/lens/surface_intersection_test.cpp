#include "lens/surface_intersection.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/lens/lens_checks.h"

namespace etendue {
namespace {

using Point = Vector3<double>;

SurfaceShape sphere(double radius) {  // centre at z = radius
    SurfaceShape shape;
    shape.curvature = 1.0 / radius;
    return shape;
}

SurfaceShape asphere() {
    SurfaceShape shape = sphere(-17.746);
    shape.asphere = {-0.00038524, 1.3527e-05, -2.3317e-07, 1.7242e-09};
    shape.isAsphere = true;
    return shape;
}

Point unit(double x, double y, double z) { return normalized(Point{x, y, z}); }

TEST_CASE("intersect: on the axis a surface is met at its vertex") {
    for (const SurfaceShape& shape : {SurfaceShape{}, sphere(5.0), sphere(-5.0), asphere()})
        for (const double from : {-3.0, 0.0, 2.0}) {
            const auto toScene = intersect(shape, 5.0, {0, 0, from}, {0, 0, 1}, Heading::toScene);
            REQUIRE(toScene.has_value());
            CHECK(*toScene == doctest::Approx(-from).epsilon(1e-15));
            const auto toSensor =
                intersect(shape, 5.0, {0, 0, from}, {0, 0, -1}, Heading::toSensor);
            REQUIRE(toSensor.has_value());
            CHECK(*toSensor == doctest::Approx(from).epsilon(1e-15));
        }
}

TEST_CASE("intersect: of a sphere's two points the heading chooses the one on the vertex's side") {
    // Centre (0, 0, −10): a front surface, convex toward the scene. The chord at height 6 meets it
    // 8 above and 8 below the centre.
    const auto leaving = intersect(sphere(-10.0), 9.9, {6, 0, -10}, {0, 0, 1}, Heading::toScene);
    REQUIRE(leaving.has_value());
    CHECK(*leaving == doctest::Approx(8.0).epsilon(1e-14));
    const auto entering = intersect(sphere(-10.0), 9.9, {6, 0, -10}, {0, 0, -1}, Heading::toSensor);
    REQUIRE(entering.has_value());
    CHECK(*entering == doctest::Approx(-8.0).epsilon(1e-14));
    // Against the heading it would cross the far hemisphere, which is no part of the lens.
    CHECK_FALSE(
        intersect(sphere(-10.0), 9.9, {6, 0, -10}, {0, 0, -1}, Heading::toScene).has_value());
}

TEST_CASE("intersect: a ray may leave through the front sphere backwards, beyond 90 degrees") {
    // Inside the sphere about (0, 0, −10), on its way down and outward.
    const Point origin{5, 0, -2}, direction = unit(1, 0, -0.3);
    const auto t = intersect(sphere(-10.0), 9.9, origin, direction, Heading::toScene);
    REQUIRE(t.has_value());
    CHECK(*t > 0.0);
    const Point p = origin + direction * *t;
    CHECK(std::hypot(p.x, p.z + 10.0) == doctest::Approx(10.0).epsilon(1e-14));
    CHECK(p.z > -10.0);
    // And back in by the same point, which is not the one where the line leaves the sphere again.
    const auto back =
        intersect(sphere(-10.0), 9.9, p + direction * 3.0, direction * -1.0, Heading::toSensor);
    REQUIRE(back.has_value());
    CHECK(*back == doctest::Approx(3.0).epsilon(1e-13));
}

TEST_CASE("intersect: points lie on the surface and are crossed in the heading") {
    SurfaceShape ellipsoid = sphere(30.0), hyperboloid = sphere(-30.0), cylinder = sphere(25.0);
    ellipsoid.conic = -0.5;
    hyperboloid.conic = -2.3;
    cylinder.curvedInY = false;
    LensRandom random(21);
    for (const SurfaceShape& shape :
         {sphere(30.0), sphere(-30.0), ellipsoid, hyperboloid, cylinder, asphere()})
        for (int i = 0; i < 200; ++i) {
            const double reach = shape.isAsphere ? 5.0 : 15.0;
            const Point through{random.between(-0.7, 0.7) * reach,
                                random.between(-0.7, 0.7) * reach, 0.0};
            const Point on{through.x, through.y,
                           sag(shape, heightSquared(shape, through.x, through.y))};
            const Point normal = gradient(shape, on);
            const Point direction = unit(random.between(-0.8, 0.8), random.between(-0.8, 0.8), 1.0);
            if (!(dot(normal, direction) > 0.05)) continue;
            const Point origin = on - direction * random.between(-4.0, 40.0);
            const auto t = intersect(shape, reach, origin, direction, Heading::toScene);
            REQUIRE(t.has_value());
            const Point found = origin + direction * *t;
            // Rounding of coordinates up to 100, over the cosine.
            CHECK(std::abs(levelSet(shape, found)) <= 1e-12);
            CHECK(dot(gradient(shape, found), direction) > 0.0);
            if (!shape.isAsphere)  // of which a line may cross the polynomial twice
                CHECK(std::hypot(found.x - on.x, found.y - on.y) <= 1e-11);
        }
}

TEST_CASE("intersect: an asphere's crossing is inside the rim wherever the line passes it there") {
    // Steep lines, of which Newton's method alone loses one in a hundred to the polynomial's far
    // sheets.
    LensRandom random(22);
    SurfaceShape shape = sphere(19.386);
    shape.asphere = {-9.4784e-05, 5.6706e-07, -3.1435e-09, 5.8172e-12};
    shape.isAsphere = true;
    constexpr double rim = 9.0;
    int steep = 0;
    for (int i = 0; i < 4000; ++i) {
        const double h = rim * std::sqrt(random.between(0.0, 0.98));
        const double turn = random.between(0.0, 2.0 * std::numbers::pi);
        const double x = h * std::cos(turn), y = h * std::sin(turn);
        const Point on{x, y, sag(shape, h * h)};
        const Point direction = unit(random.between(-9.0, 9.0), random.between(-9.0, 9.0), 1.0);
        const Point origin = on - direction * 30.0;
        const double a = direction.x * direction.x + direction.y * direction.y;
        const double b = origin.x * direction.x + origin.y * direction.y;
        const double c = origin.x * origin.x + origin.y * origin.y - rim * rim;
        const double root = std::sqrt(b * b - a * c);
        const bool passes = levelSet(shape, origin + direction * ((-b - root) / a)) < 0.0 &&
                            levelSet(shape, origin + direction * ((-b + root) / a)) > 0.0;
        if (!passes) continue;
        ++steep;
        const auto t = intersect(shape, rim, origin, direction, Heading::toScene);
        REQUIRE(t.has_value());
        const Point found = origin + direction * *t;
        CHECK(std::abs(levelSet(shape, found)) <= 1e-12);
        CHECK(std::hypot(found.x, found.y) <= rim * (1.0 + 1e-12));
    }
    CHECK(steep > 1500);
}

TEST_CASE("intersect: a line that passes a surface by does not meet it") {
    CHECK_FALSE(intersect(sphere(5.0), 5.0, {6, 0, -3}, {0, 0, 1}, Heading::toScene).has_value());
    CHECK_FALSE(intersect(SurfaceShape{}, 5.0, {0, 0, -3}, {1, 0, 0}, Heading::toScene));
    CHECK_FALSE(intersect(SurfaceShape{}, 5.0, {0, 0, -3}, {0, 0, -1}, Heading::toScene));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const SurfaceShape& shape : {SurfaceShape{}, sphere(5.0), asphere()}) {
        CHECK_FALSE(intersect(shape, 5.0, {nan, 0, -3}, {0, 0, 1}, Heading::toScene).has_value());
        CHECK_FALSE(intersect(shape, 5.0, {0, 0, -3}, {0, 0, nan}, Heading::toScene).has_value());
    }
}

TEST_CASE("gradient: it is the derivative of the level set, and of unit length on a sphere") {
    SurfaceShape ellipsoid = sphere(30.0), cylinder = sphere(25.0);
    ellipsoid.conic = -0.5;
    cylinder.curvedInX = false;
    for (const SurfaceShape& shape : {sphere(-20.0), ellipsoid, cylinder, asphere()}) {
        const Point p{1.2, -2.1, 0.3};
        const Point g = gradient(shape, p);
        using D = Dual<4>;
        const D level = levelSet(
            shape, Vector3<D>{D::variable(p.x, 0), D::variable(p.y, 1), D::variable(p.z, 2)});
        CHECK(g.x == doctest::Approx(level.partials[0]).epsilon(1e-13));
        CHECK(g.y == doctest::Approx(level.partials[1]).epsilon(1e-13));
        CHECK(g.z == doctest::Approx(level.partials[2]).epsilon(1e-13));
    }
    const Point on{3.0, 4.0, sag(sphere(20.0), 25.0)};
    const Point normal = gradient(sphere(20.0), on);
    CHECK(dot(normal, normal) == doctest::Approx(1.0).epsilon(1e-14));
}

}  // namespace
}  // namespace etendue
