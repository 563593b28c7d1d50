#include "lens/sequential_trace.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/lens/lens_checks.h"
#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

using Point = Vector3<double>;
constexpr auto ignore = [](auto...) {};

Point unit(double x, double y, double z) { return normalized(Point{x, y, z}); }

struct Traced {
    Passage passage;
    LensRay<double> ray;
};

/// From the scene across the first `count` surfaces, by the d line.
Traced fromScene(const Prescription& prescription, const LensRay<double>& ray, std::size_t count) {
    const OpticalSystem system(prescription);
    const std::vector<double> indices = refractiveIndices(system, dLineNm);
    Traced traced{{}, ray};
    traced.passage =
        carryToSensor<TraceMode::light>({system, indices, dLineNm}, 0, count, traced.ray, ignore);
    return traced;
}

/// From the sensor's side across all surfaces.
Traced fromSensor(const Prescription& prescription, const LensRay<double>& ray) {
    const OpticalSystem system(prescription);
    const std::vector<double> indices = refractiveIndices(system, dLineNm);
    Traced traced{{}, ray};
    traced.passage = carryToScene<TraceMode::light>({system, indices, dLineNm}, 0,
                                                    system.surfaces.size(), traced.ray, ignore);
    return traced;
}

/// Surfaces as given, a plane 900 mm behind the last one's glass and a stop wide open.
Prescription closedByPlane(const Surface& surface) {
    Prescription prescription;
    prescription.surfaces = {
        surface, spherical(std::numeric_limits<double>::infinity(), 1.0, 400.0), stop(10.0, 400.0)};
    prescription.surfaces[0].thicknessMm = 900.0;
    return prescription;
}

TEST_CASE("crossSurface: a sphere bends meridional rays as the textbook's angles say") {
    // Object on the axis, L in front of the vertex, a ray at angle U to the axis:
    // sin I = (L + R)/R sin U, sin I′ = n/n′ sin I, U′ = I − I′ − U, crossing at R + R sin I′/sin
    // U′ (Kingslake, Lens Design Fundamentals, §2).
    const double radius = 60.0, n = 1.6, distance = 200.0;
    const Prescription prescription = closedByPlane(spherical(radius, 0.0, 50.0, plainGlass(n)));
    for (const double degrees : {0.5, 3.0, 8.0, 12.0}) {
        const double u = degrees * std::numbers::pi / 180.0;
        const double sinI = (distance + radius) / radius * std::sin(u);
        const double i = std::asin(sinI), iRefracted = std::asin(sinI / n);
        const double uRefracted = i - iRefracted - u;
        const double crossing = radius + radius * std::sin(iRefracted) / std::sin(uRefracted);
        const Traced traced =
            fromScene(prescription, {{0, 0, distance}, {0.0, std::sin(u), -std::cos(u)}}, 1);
        REQUIRE(traced.passage.status == TraceStatus::passed);
        const auto& [p, d] = traced.ray;
        CHECK(p.z - p.y * d.z / d.y == doctest::Approx(-crossing).epsilon(1e-12));
        CHECK(dot(d, d) == doctest::Approx(1.0).epsilon(1e-15));
    }
}

TEST_CASE("crossSurface: a parallel plate shifts a ray and does not turn it") {
    const double thickness = 7.0, n = 1.52;
    Prescription prescription;
    prescription.surfaces = {
        spherical(std::numeric_limits<double>::infinity(), thickness, 100.0, plainGlass(n)),
        spherical(std::numeric_limits<double>::infinity(), 1.0, 100.0), stop(10.0, 100.0)};
    for (const double degrees : {0.0, 10.0, 45.0, 80.0}) {
        const double angle = degrees * std::numbers::pi / 180.0;
        const Point direction{std::sin(angle), 0.0, -std::cos(angle)};
        const Traced traced = fromScene(prescription, {{0, 0, 1}, direction}, 2);
        REQUIRE(traced.passage.status == TraceStatus::passed);
        const Point turned = traced.ray.direction - direction;
        CHECK(std::sqrt(dot(turned, turned)) <= 1e-15);
        // Perpendicular distance between the lines before and behind.
        const Point across{std::cos(angle), 0.0, std::sin(angle)};
        const double shift = dot(traced.ray.origin - Point{0, 0, 1}, across);
        const double sine = std::sin(angle);
        CHECK(-shift == doctest::Approx(thickness * sine *
                                        (1.0 - std::cos(angle) / std::sqrt(n * n - sine * sine)))
                            .epsilon(1e-12));
        // Fresnel's law on both faces.
        const Refraction face{1.0, n, std::cos(angle), std::sqrt(1.0 - sine * sine / (n * n))};
        const double through = 1.0 - reflectance(face);
        CHECK(traced.passage.transmittance == doctest::Approx(through * through).epsilon(1e-12));
    }
}

TEST_CASE("crossSurface: an ellipsoid of eccentricity 1/n focuses parallel light exactly") {
    const double n = 1.5, radius = 40.0;
    Surface front = spherical(radius, 0.0, 50.0, plainGlass(n));
    front.kind = SurfaceKind::conic;
    front.conic = -1.0 / (n * n);
    const Prescription prescription = closedByPlane(front);
    const double focus = n * radius / (n - 1.0);
    for (const double height : {0.1, 10.0, 30.0, 45.0}) {
        const Traced traced = fromScene(prescription, {{height, 0, 5}, {0, 0, -1}}, 1);
        REQUIRE(traced.passage.status == TraceStatus::passed);
        const auto& [p, d] = traced.ray;
        CHECK(p.z - p.x * d.z / d.x == doctest::Approx(-focus).epsilon(1e-12));
    }
}

TEST_CASE("crossSurface: a hyperboloid of eccentricity n focuses parallel light from the glass") {
    // A plano-hyperbolic lens, plane toward the scene: focus R/(n − 1) behind the vertex.
    const double n = 1.5, radius = 40.0;
    Surface rear = spherical(-radius, 1.0, 60.0);
    rear.kind = SurfaceKind::conic;
    rear.conic = -n * n;
    Prescription prescription;
    prescription.surfaces = {
        spherical(std::numeric_limits<double>::infinity(), 100.0, 60.0, plainGlass(n)), rear,
        stop(50.0, 60.0)};
    for (const double height : {0.1, 10.0, 30.0, 55.0}) {
        const Traced traced = fromScene(prescription, {{0, height, 5}, {0, 0, -1}}, 2);
        REQUIRE(traced.passage.status == TraceStatus::passed);
        const auto& [p, d] = traced.ray;
        CHECK(p.z - p.y * d.z / d.y == doctest::Approx(-100.0 - radius / (n - 1.0)).epsilon(1e-12));
    }
}

TEST_CASE("crossSurface: an asphere that spells out a conic refracts as the conic") {
    // k = −1: the paraboloid c h²/2 is the sphere's sag plus a series of which the terms to h¹⁶
    // are −c³h⁴/8 − c⁵h⁶/16 − 5c⁷h⁸/128 − …; at c h = 0.1 the next is 1e-19 mm/c.
    const double radius = 50.0, c = 1.0 / radius;
    Surface conic = spherical(radius, 0.0, 6.0, plainGlass(1.6));
    conic.kind = SurfaceKind::conic;
    conic.conic = -1.0;
    Surface series = conic;
    series.kind = SurfaceKind::aspheric;
    series.conic = 0.0;
    double binomial = 0.5;  // of √(1 − x): coefficients of −xⁿ
    for (std::size_t i = 0; i < series.asphere.size(); ++i) {
        const double order = static_cast<double>(i) + 2.0;
        binomial *= (order - 1.5) / order;
        series.asphere[i] = -binomial * std::pow(c, 2.0 * order - 1.0);
    }
    for (const double height : {0.5, 2.0, 4.9}) {
        const LensRay<double> ray{{height, 0.3, 4}, unit(0.1, -0.05, -1)};
        const Traced exact = fromScene(closedByPlane(conic), ray, 1);
        const Traced found = fromScene(closedByPlane(series), ray, 1);
        const Point moved = exact.ray.origin - found.ray.origin;
        const Point turned = exact.ray.direction - found.ray.direction;
        CHECK(std::sqrt(dot(moved, moved)) <= 1e-13);
        CHECK(std::sqrt(dot(turned, turned)) <= 1e-14);
    }
}

TEST_CASE("crossSurface: a cylinder curved in x does not bend in y") {
    Surface front = spherical(30.0, 0.0, 20.0, plainGlass(1.6));
    front.kind = SurfaceKind::cylinderX;
    LensRandom random(31);
    for (int i = 0; i < 100; ++i) {
        const Point direction = unit(random.between(-0.4, 0.4), random.between(-0.4, 0.4), -1.0);
        const Point origin{random.between(-10, 10), random.between(-10, 10), 3.0};
        const Traced traced = fromScene(closedByPlane(front), {origin, direction}, 1);
        REQUIRE(traced.passage.status == TraceStatus::passed);
        // The normal has no y: that component of n d is conserved.
        CHECK(1.6 * traced.ray.direction.y == doctest::Approx(direction.y).epsilon(1e-14));
        // In the plane x = 0 the surface is the plane z = 0.
        const LensRay<double> meridional{{0.0, origin.y, 3.0}, unit(0.0, direction.y, -1.0)};
        const Traced flat = fromScene(closedByPlane(front), meridional, 1);
        CHECK(std::abs(flat.ray.origin.z) <= 2e-15);  // from z = 3
        CHECK(flat.ray.direction.x == 0.0);
    }
    Surface other = front;
    other.kind = SurfaceKind::cylinderY;
    const Traced inX = fromScene(closedByPlane(front), {{5, 2, 3}, {0, 0, -1}}, 1);
    const Traced inY = fromScene(closedByPlane(other), {{2, 5, 3}, {0, 0, -1}}, 1);
    CHECK(inX.ray.direction.x == inY.ray.direction.y);
    CHECK(inX.ray.direction.x < 0.0);
}

TEST_CASE("crossSurface: missed, blocked, stopped and totally reflected rays are told apart") {
    // Plano-convex, convex side to the scene: from behind, a ray at height h meets the sphere at
    // the angle asin(h/R) to its normal, beyond the critical angle where h > R/n = 20.
    const double radius = 30.0, n = 1.5;
    Prescription prescription;
    prescription.surfaces = {spherical(radius, 40.0, 28.0, plainGlass(n)),
                             spherical(std::numeric_limits<double>::infinity(), 1.0, 50.0),
                             stop(50.0, 40.0)};
    const auto from = [&](double height) {
        return fromSensor(prescription, {{0, height, -60}, {0, 0, 1}}).passage;
    };
    CHECK(from(19.9).status == TraceStatus::passed);
    CHECK(from(20.1).status == TraceStatus::totalInternalReflection);
    CHECK(from(20.1).surface == 0);
    CHECK(from(28.1).status == TraceStatus::blockedBySurface);
    CHECK(from(28.1).surface == 0);
    CHECK(from(30.1).status == TraceStatus::missedSurface);
    CHECK(from(30.1).surface == 0);
    CHECK(from(40.1).status == TraceStatus::blockedByStop);
    CHECK(from(40.1).surface == 2);
    prescription.surfaces[2].semiApertureMm = 60.0;
    CHECK(from(50.1).status == TraceStatus::blockedBySurface);
    CHECK(from(50.1).surface == 1);
    // Just short of total reflection next to nothing passes.
    CHECK(from(20.0 - 1e-9).transmittance < 1e-3);
    CHECK(from(20.0 - 1e-9).transmittance > 0.0);
}

TEST_CASE("crossSurface: a coating lets more light through at its wavelength") {
    Prescription bare = singlet(60.0, -60.0, 6.0, 1.6, 10.0);
    Prescription coated = bare;
    for (std::size_t i : {0u, 1u}) coated.surfaces[i].coating = Coating{1.38, dLineNm, 0.25};
    const LensRay<double> ray{{0, 1, 3}, {0, 0, -1}};
    const double before = fromScene(bare, ray, 3).passage.transmittance;
    const double after = fromScene(coated, ray, 3).passage.transmittance;
    CHECK(before == doctest::Approx(std::pow(1.0 - std::pow(0.6 / 2.6, 2), 2)).epsilon(1e-4));
    const double film = (1.6 - 1.38 * 1.38) / (1.6 + 1.38 * 1.38);
    CHECK(after == doctest::Approx(std::pow(1.0 - film * film, 2)).epsilon(1e-4));
    CHECK(after > before);
}

}  // namespace
}  // namespace etendue
