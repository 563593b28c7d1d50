// Equation (2) and its limit, against independent derivatives.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "renderer/camera.h"
#include "renderer/random.h"
#include "renderer/sampling.h"
#include "tests/renderer/camera_fixtures.h"

namespace etendue {
namespace {

const Wavelengths green;
constexpr double epsilon = 0x1p-24;  // a float's rounding, relative

/// A point, off the axis too, that the camera can see from every aperture point.
Vec3 pointBefore(const Camera& camera, RandomStream& random, double depth) {
    const Vec2 p = random.next2();
    return toFloat(
        camera.settings().worldFromLens.point({depth * (p.x - 0.5), depth * (p.y - 0.5), depth}));
}

/// Where on the film, in pixels, a thin lens images a point of lens space (mm): the sensor point
/// whose conjugate in the plane of focus lies on the line from the aperture point to the target.
Vec2T<double> thinLensFilm(const ThinLensSetup& setup, const CameraSettings& settings, Vec3d target,
                           AperturePoint a) {
    const double v = setup.sensorDistanceMm(), pixelMm = settings.sensorWidthMm / settings.width;
    const auto coordinate = [&](double x, double ax) {
        if (setup.focusMm == focusAtInfinity) return -v * (x - ax) / target.z;
        const double inFocus = ax + (x - ax) * setup.focusMm / target.z;
        return -inFocus * v / setup.focusMm;
    };
    return {coordinate(target.x, a.mm.x()) / pixelMm + 0.5 * settings.width,
            coordinate(target.y, a.mm.y()) / pixelMm + 0.5 * settings.height};
}

/// Pixels per m² of a surface through `point` (world): the film point's central differences along
/// two tangents.
double filmBySurface(const ThinLensSetup& setup, const CameraSettings& settings, Vec3 point,
                     Vec3 normal, AperturePoint a) {
    const Transform lensFromWorld = settings.worldFromLens.inverse();
    const Frame surface = Frame::fromZ(normalize(normal));
    const double depth = lensFromWorld.point(toDouble(point)).z;
    const double step = 1e-4 * depth;  // m
    const auto derivative = [&](Vec3 tangent) {
        const auto film = [&](double moved) {
            const Vec3d p = toDouble(point) + toDouble(tangent) * moved;
            return thinLensFilm(setup, settings, lensFromWorld.point(p) * 1e3, a);
        };
        const auto near = film(step) - film(-step), far = film(2.0 * step) - film(-2.0 * step);
        return (near * 8.0 - far) * (1.0 / (12.0 * step));
    };
    const auto x = derivative(surface.x), y = derivative(surface.y);
    return std::abs(x.x * y.y - x.y * y.x);
}

TEST_CASE("Camera: a connection's importance is equation (1) after the change of variables") {
    RandomStream random(2, 0, 0, RandomDomain::test);
    for (const ThinLensSetup& setup : thinLenses()) {
        const LensPointer lens = setup.make();
        for (const bool atOrigin : {true, false}) {
            const Camera camera(lens, settingsFor(720, 480, atOrigin ? Transform{} : somewhere()));
            for (int i = 0; i < 100; ++i) {
                // 1e-4 … 1e6 m; only near the world's origin are tenths of a millimetre floats.
                const double exponent = atOrigin ? 10.0 * random.next() - 4.0 : 3.0 * random.next();
                const Vec3 point = pointBefore(camera, random, std::pow(10.0, exponent));
                const Vec2 u = random.next2();
                const auto connection = camera.connect(point, u, green);
                REQUIRE(connection.has_value());
                const CameraRay& ray = connection->ray;
                const Vec3 normal = sampleUnitSphere(random.next2());
                const double cosine = absDot(toDouble(normal), toDouble(ray.direction));
                if (cosine < 0.05) continue;  // where float normals say little

                const AperturePoint a = lens->sampleAperture({u.x, u.y});
                const double density = filmBySurface(setup, camera.settings(), point, normal, a);
                // From v = 1/(1/f − 1/u): the mean of J over the disc is 1 / (v² + R²).
                const double v = setup.sensorDistanceMm(), r = setup.apertureRadiusMm();
                const double pixelMm = 36.0 / 720.0;
                const double sx = (connection->film.x - 360.0) * pixelMm;
                const double sy = (connection->film.y - 240.0) * pixelMm;
                const double cosSquared =
                    v * v / (v * v + std::pow(a.mm.x() - sx, 2) + std::pow(a.mm.y() - sy, 2));
                const double weight = cosSquared * cosSquared * (1.0 + r * r / (v * v));

                // A dozen float roundings; a direction's weighs as 1/cosine on the surface and as
                // 1/D.z in the footprint. The finite differences err by 1e-8 at the most.
                const double obliquity = std::abs(dot(ray.direction, camera.forward()));
                const double tolerance = 12.0 * epsilon * (1.0 / cosine + 1.0 / obliquity);
                // The film point itself is a float, on which the oracle's cosine rests.
                CHECK(std::abs(ray.weight / weight - 1.0) <= 1e-6 + tolerance);
                CHECK(std::abs(pdfArea(ray, connection->distance, normal) / density - 1.0) <=
                      tolerance);
                CHECK(std::abs(importance(ray, connection->distance, normal) / (weight * density) -
                               1.0) <= 1e-6 + 2.0 * tolerance);
            }
        }
    }
}

TEST_CASE("Camera: the density does not depend on where along the ray the lens lets it go") {
    RandomStream random(3, 0, 0, RandomDomain::test);
    for (const ThinLensSetup& setup : thinLenses()) {
        const Camera plain(setup.make(), settingsFor(720, 480, somewhere()));
        const Camera forwarded(std::make_shared<ForwardedLens>(setup.make(), 30.0),
                               settingsFor(720, 480, somewhere()));
        for (int i = 0; i < 50; ++i) {
            const Vec3 point = pointBefore(plain, random, 0.1 + 2.0 * random.next());
            const Vec2 u = random.next2();
            const Vec3 normal = sampleUnitSphere(random.next2());
            const auto a = plain.connect(point, u, green), b = forwarded.connect(point, u, green);
            REQUIRE(a.has_value());
            REQUIRE(b.has_value());
            CHECK(a->film == b->film);
            CHECK(a->ray.weight == b->ray.weight);
            CHECK(b->distance < a->distance);
            // Twenty roundings, in a triple product whose factors are at most 45° from square.
            CHECK(pdfArea(b->ray, b->distance, normal) ==
                  doctest::Approx(pdfArea(a->ray, a->distance, normal)).epsilon(40 * epsilon));
            CHECK(pdfSolidAngle(b->ray) ==
                  doctest::Approx(pdfSolidAngle(a->ray)).epsilon(40 * epsilon));
        }
    }
}

TEST_CASE("Camera: the density per solid angle is the limit of that per area") {
    const double v = 50.0, pixelMm = 36.0 / 720.0;
    const Camera camera(makePinhole(v), settingsFor(720, 480, somewhere()));
    for (const Vec2 film : {Vec2{360, 240}, Vec2{0, 0}, Vec2{700, 30}}) {
        const auto ray = camera.sampleRay(film, {}, green);
        REQUIRE(ray.has_value());
        // A sensor element ds is seen from the hole under ds cos³θ / v².
        const double cosine = dot(ray->direction, camera.forward());
        const double expected = v * v / (pixelMm * pixelMm * cosine * cosine * cosine);
        CHECK(pdfSolidAngle(*ray) == doctest::Approx(expected).epsilon(12 * epsilon));
        const float distance = 1e4f;
        CHECK(pdfArea(*ray, distance, ray->direction) * distance * distance ==
              doctest::Approx(expected).epsilon(12 * epsilon));
    }
}

TEST_CASE("Camera: densities are infinite where the footprint vanishes, and zero seen edge-on") {
    // All film points see the same point at distance 2: there X′ + 2 D′ = 0.
    CameraRay ray{{0, 0, 0}, {0, 0, 1}, 0.5f, {}, {}};
    ray.originByPixel = {Vec3{2, 0, 0}, Vec3{0, 2, 0}};
    ray.directionByPixel = {Vec3{-1, 0, 0}, Vec3{0, -1, 0}};
    const float infinity = std::numeric_limits<float>::infinity();
    CHECK(pdfArea(ray, 2.0f, {0, 0, 1}) == infinity);
    CHECK(importance(ray, 2.0f, {0, 0, 1}) == infinity);
    CHECK(pdfArea(ray, 2.0f, {0, 1, 0}) == 0.0f);
    CHECK(pdfArea(ray, 3.0f, {0, 1, 0}) == 0.0f);
    CHECK(pdfArea(ray, 3.0f, {0, 0, -1}) == 1.0f);
    CHECK(importance(ray, 3.0f, {0, 0, -1}) == 0.5f);
    CHECK(pdfSolidAngle(ray) == 1.0f);
    // A lens that collimates: all film points look the same way.
    ray.directionByPixel = {};
    CHECK(pdfSolidAngle(ray) == infinity);
    CHECK(pdfArea(ray, 1e30f, {0, 0, 1}) == 0.25f);
}

TEST_CASE("Camera: importance stays finite where the density alone leaves a float's range") {
    CameraRay ray{{0, 0, 0}, {0, 0, 1}, 1e-30f, {}, {}};
    ray.directionByPixel = {Vec3{1e-10f, 0, 0}, Vec3{0, 1e-10f, 0}};
    CHECK(std::isinf(pdfArea(ray, 1e-10f, {0, 0, 1})));
    CHECK(importance(ray, 1e-10f, {0, 0, 1}) == doctest::Approx(1e10).epsilon(8 * epsilon));
}

}  // namespace
}  // namespace etendue
