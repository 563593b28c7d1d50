#include "renderer/camera.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "lens/traced_lens.h"
#include "renderer/random.h"
#include "renderer/sampling.h"
#include "tests/lens/prescriptions.h"
#include "tests/renderer/camera_fixtures.h"

namespace etendue {
namespace {

const Wavelengths green;
constexpr double epsilon = 0x1p-24;  // a float's rounding, relative

TEST_CASE("Camera: right of the view axis is right in the picture, above it is above") {
    for (const LensPointer& lens :
         {LensPointer(makePinhole(50.0)), LensPointer(makeThinLens(50.0, 2000.0, 9.0))}) {
        const Camera camera(lens, settingsFor(720, 480, somewhere()));
        const Vec3 forward = camera.forward();
        const Vec3 up = toFloat(camera.settings().worldFromLens.y);
        const Vec3 right = cross(forward, up);  // of a viewer, in any right-handed space
        const Vec3 ahead = camera.position() + forward * 2.0f;
        const auto film = [&](Vec3 point) {
            const auto connection = camera.connect(point, {0.3f, 0.6f}, green);
            REQUIRE(connection.has_value());
            return connection->film;
        };
        CHECK(film(ahead + right * 0.2f).x > 370.0f);
        CHECK(film(ahead - right * 0.2f).x < 350.0f);
        CHECK(film(ahead + up * 0.2f).y < 230.0f);
        CHECK(film(ahead - up * 0.2f).y > 250.0f);
    }
}

TEST_CASE("Camera: the centre of the film looks forward from the lens") {
    const Camera camera(makePinhole(50.0), settingsFor(721, 480, somewhere()));
    const auto ray = camera.sampleRay({360.5f, 240.0f}, {0.5f, 0.5f}, green);
    REQUIRE(ray.has_value());
    CHECK(ray->origin == camera.position());
    CHECK(length(ray->direction - camera.forward()) <= 2 * epsilon);
}

TEST_CASE("Camera: pixels are square and the sensor is as wide as it says") {
    CameraSettings settings = settingsFor(720, 100);
    settings.sensorWidthMm = 24.0;
    const Camera camera(makePinhole(12.0), settings);
    // 45° at the middle of the left edge: half the width away from the axis, 12 mm behind the hole.
    const auto left = camera.sampleRay({0.0f, 50.0f}, {}, green);
    REQUIRE(left.has_value());
    CHECK(left->direction.x == doctest::Approx(std::sqrt(0.5)).epsilon(2 * epsilon));
    CHECK(left->direction.y == 0.0f);
    const auto above = camera.sampleRay({360.0f, 50.0f - 360.0f}, {}, green);
    REQUIRE(above.has_value());
    CHECK(above->direction.y == doctest::Approx(std::sqrt(0.5)).epsilon(2 * epsilon));
}

/// How far along the film, in pixels, the ray's point at `distance` may seem to move when the point
/// moves by `shift` metres: shift over the smaller singular value of F.
double pixelsPerShift(const CameraRay& ray, double distance, double shift) {
    const auto column = [&](std::size_t i) {
        return toDouble(ray.originByPixel[i]) + distance * toDouble(ray.directionByPixel[i]);
    };
    const double a = lengthSquared(column(0)), c = lengthSquared(column(1));
    const double b = dot(column(0), column(1));
    const double smaller = 0.5 * (a + c - std::sqrt((a - c) * (a - c) + 4.0 * b * b));
    return shift / std::sqrt(smaller);
}

TEST_CASE("Camera: connect finds the film point that sampleRay started from") {
    std::vector<LensPointer> lenses = {makePinhole(35.0)};
    for (const ThinLensSetup& setup : thinLenses()) {
        lenses.push_back(setup.make());
        lenses.push_back(std::make_shared<ForwardedLens>(setup.make(), 40.0));
    }
    RandomStream random(1, 0, 0, RandomDomain::test);
    for (const LensPointer& lens : lenses) {
        const Camera camera(lens, settingsFor(720, 480, somewhere()));
        for (int i = 0; i < 100; ++i) {
            const Vec2 u = random.next2(), p = random.next2();
            const Vec2 film{720.0f * p.x, 480.0f * p.y};
            const float distance = std::pow(10.0f, 4.0f * random.next() - 1.0f);
            const auto ray = camera.sampleRay(film, u, green);
            REQUIRE(ray.has_value());
            const Vec3 hit = ray->origin + ray->direction * distance;
            const auto connection = camera.connect(hit, u, green);
            REQUIRE(connection.has_value());
            // Origin, direction, their product and their sum are each rounded, on three axes.
            const double rounding =
                epsilon * std::sqrt(3.0) * (length(ray->origin) + 2.0 * distance + length(hit));
            const double tolerance = pixelsPerShift(*ray, distance, rounding) + 720.0 * epsilon;
            CHECK(length(Vec3{connection->film.x - film.x, connection->film.y - film.y, 0.0f}) <=
                  tolerance);
            CHECK(std::abs(connection->distance - distance) <= rounding + epsilon * distance);
        }
    }
}

TEST_CASE("Camera: a uniform field of one reads one on the axis") {
    for (const ThinLensSetup& setup : thinLenses()) {
        const Camera camera(setup.make(), settingsFor(720, 480));
        constexpr int side = 64;
        double sum = 0.0;
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) {
                const Vec2 u{(static_cast<float>(i) + 0.5f) / side,
                             (static_cast<float>(j) + 0.5f) / side};
                const auto ray = camera.sampleRay({360.0f, 240.0f}, u, green);
                REQUIRE(ray.has_value());
                sum += ray->weight;
            }
        // cos⁴ is 1 − 2 c² m and higher terms, c = R/v, m = max(x², y²) on the square [−1, 1]².
        // The midpoint rule takes the mean of m too small by h²/3 for its curvature and by 2 h²/3
        // for its kink along the diagonals, h = 1/side.
        const double c = setup.apertureRadiusMm() / setup.sensorDistanceMm();
        CHECK(std::abs(sum / (side * side) - 1.0) <=
              2.0 * c * c * (1.0 + c * c) / (side * side) + 1e-6);
    }
    const Camera pinhole(makePinhole(35.0), settingsFor(720, 480));
    const auto ray = pinhole.sampleRay({360.0f, 240.0f}, {}, green);
    REQUIRE(ray.has_value());
    CHECK(ray->weight == doctest::Approx(1.0).epsilon(epsilon));
}

TEST_CASE("Camera: a pinhole's picture darkens as the fourth power of the cosine") {
    const Camera camera(makePinhole(20.0), settingsFor(720, 480, somewhere()));
    for (float x = 0.0f; x <= 720.0f; x += 60.0f) {
        const auto ray = camera.sampleRay({x, 100.0f}, {0.1f, 0.9f}, green);
        REQUIRE(ray.has_value());
        const double cosine = dot(ray->direction, camera.forward());
        CHECK(ray->weight == doctest::Approx(std::pow(cosine, 4)).epsilon(12 * epsilon));
    }
}

TEST_CASE("Camera: exposure multiplies the weight by two for each stop") {
    const LensPointer lens = makeThinLens(50.0, 1000.0, 9.0);
    CameraSettings settings = settingsFor(720, 480);
    const Camera plain(lens, settings);
    for (const double stops : {-2.0, 0.5, 3.0}) {
        settings.exposureStops = stops;
        const Camera exposed(lens, settings);
        const auto a = plain.sampleRay({100.0f, 50.0f}, {0.2f, 0.7f}, green);
        const auto b = exposed.sampleRay({100.0f, 50.0f}, {0.2f, 0.7f}, green);
        REQUIRE(a.has_value());
        REQUIRE(b.has_value());
        CHECK(b->weight == doctest::Approx(a->weight * std::exp2(stops)).epsilon(2 * epsilon));
    }
}

TEST_CASE("Camera: what the lens blocks on the axis is made up for by the rest") {
    const LensPointer open = makeThinLens(50.0, 1000.0, 9.0);
    const Camera whole(open, settingsFor(720, 480));
    const Camera half(std::make_shared<HalfCoveredLens>(open), settingsFor(720, 480));
    const auto a = whole.sampleRay({400.0f, 200.0f}, {0.8f, 0.4f}, green);
    const auto b = half.sampleRay({400.0f, 200.0f}, {0.8f, 0.4f}, green);
    REQUIRE(a.has_value());
    REQUIRE(b.has_value());
    // The lattice's points fall into two halves of the aperture to within a few in 10946.
    CHECK(b->weight / a->weight == doctest::Approx(2.0).epsilon(5e-4));
    CHECK_FALSE(half.sampleRay({400.0f, 200.0f}, {0.1f, 0.4f}, green).has_value());
    CHECK_FALSE(half.connect({0.0f, 0.0f, 2.0f}, {0.1f, 0.4f}, green).has_value());
}

TEST_CASE("Camera: the first wavelength is the one traced, against a sensor set at 550 nm") {
    CameraSettings settings = settingsFor(720, 480);
    settings.isDispersive = true;
    const Camera camera(std::make_shared<TintedLens>(makePinhole(50.0)), settings);
    for (const float nm : {400.0f, 550.0f, 700.0f}) {
        Wavelengths wavelengths;
        wavelengths.nm = {nm, 450.0f, 1.0f, 1.0f};
        const auto ray = camera.sampleRay({360.0f, 240.0f}, {}, wavelengths);
        REQUIRE(ray.has_value());
        CHECK(ray->weight == doctest::Approx(nm / 550.0f).epsilon(2 * epsilon));
        const auto connection = camera.connect({0.0f, 0.0f, 3.0f}, {}, wavelengths);
        REQUIRE(connection.has_value());
        CHECK(connection->ray.weight == ray->weight);
        const CameraConnections each = camera.connectEach({0.0f, 0.0f, 3.0f}, {}, wavelengths);
        REQUIRE(each[0].has_value());
        CHECK(each[0]->ray.weight == ray->weight);
        REQUIRE(each[1].has_value());
        CHECK(each[1]->ray.weight == doctest::Approx(450.0 / 550.0).epsilon(2 * epsilon));
    }
}

TEST_CASE("Camera: without dispersion every wavelength goes the way of 550 nm") {
    const Camera camera(std::make_shared<TintedLens>(makePinhole(50.0)), settingsFor(720, 480));
    Wavelengths wavelengths;
    wavelengths.nm = {400.0f, 1.0f, 1.0f, 1.0f};
    const auto ray = camera.sampleRay({360.0f, 240.0f}, {}, wavelengths);
    REQUIRE(ray.has_value());
    CHECK(ray->weight == doctest::Approx(1.0).epsilon(2 * epsilon));
}

TEST_CASE("Camera: nothing connects behind the lens, in its plane, at its centre, or at no point") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    for (const LensPointer& lens :
         {LensPointer(makePinhole(50.0)), LensPointer(makeThinLens(50.0, 2000.0, 9.0))}) {
        const Camera camera(lens, settingsFor(720, 480));
        for (const Vec3 point :
             {Vec3{0, 0, -1}, Vec3{3, -2, -1e-6f}, Vec3{1, 2, 0}, Vec3{}, Vec3{nan, 0, 1},
              Vec3{0, 0, nan}, Vec3{infinity, 0, 1}, Vec3{0, 0, infinity}, Vec3{1, 0, 1e-44f},
              Vec3{1, 0, 1e-36f}, Vec3{3e38f, 3e38f, 3e38f}})
            CHECK_FALSE(camera.connect(point, {0.3f, 0.6f}, green).has_value());
    }
}

TEST_CASE(
    "Camera: of a lens behind a plane no ray is before it, and many that are behind are told") {
    RandomStream random(8, 0, 0, RandomDomain::test);
    for (const LensPointer& lens :
         {LensPointer(makePinhole(50.0)), LensPointer(makeThinLens(50.0, 2000.0, 40.0)),
          LensPointer(makeTracedLens(loadPrescription(lensFile("fisheye-220-6mm-f2.8.toml"))))}) {
        const Camera camera(lens, settingsFor(720, 480, somewhere()));
        int behind = 0, told = 0;
        for (int i = 0; i < 20000; ++i) {
            // From 3 cm to 10 m away.
            const float distance = 0.03f * std::pow(333.0f, random.next());
            const Vec3 point = camera.position() + sampleUnitSphere(random.next2()) * distance;
            const Vec3 normal = sampleUnitSphere(random.next2());
            const auto connection = camera.connect(point, random.next2(), green);
            if (!connection) continue;
            const bool isBehind = dot(-connection->ray.direction, normal) < 0.0f;
            behind += isBehind;
            if (!camera.isBehind(point, normal)) continue;
            ++told;
            CHECK(isBehind);
        }
        CHECK(behind > 1000);
        CHECK(told > 0.3 * behind);
    }
}

TEST_CASE("Camera: random numbers at the edge of their range give a finite ray") {
    const float edges[] = {0.0f, 0x1p-32f, 0.5f, 1.0f - 0x1p-24f};
    for (const LensPointer& lens :
         {LensPointer(makePinhole(50.0)), LensPointer(makeThinLens(50.0, 2000.0, 9.0))}) {
        const Camera camera(lens, settingsFor(720, 480, somewhere()));
        for (const float x : edges)
            for (const float y : edges) {
                const auto ray = camera.sampleRay({10.0f, 20.0f}, {x, y}, green);
                REQUIRE(ray.has_value());
                CHECK(isFinite(ray->origin));
                CHECK(std::abs(lengthSquared(ray->direction) - 1.0f) <= 8 * epsilon);
                CHECK(ray->weight > 0.0f);
                CHECK(std::isfinite(pdfSolidAngle(*ray)));
            }
    }
}

TEST_CASE("Camera: settings without a picture and lenses without light are refused") {
    const LensPointer lens = makePinhole(50.0);
    const auto refuses = [&](auto change) {
        CameraSettings settings = settingsFor(720, 480);
        change(settings);
        CHECK_THROWS_AS(Camera(lens, settings), std::invalid_argument);
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refuses([](CameraSettings& s) { s.width = 0; });
    refuses([](CameraSettings& s) { s.height = -1; });
    refuses([](CameraSettings& s) { s.sensorWidthMm = 0.0; });
    refuses([&](CameraSettings& s) { s.sensorWidthMm = nan; });
    refuses([&](CameraSettings& s) { s.exposureStops = nan; });
    refuses([&](CameraSettings& s) { s.exposureStops = 1e6; });
    refuses([](CameraSettings& s) { s.worldFromLens = Transform::scale({2, 2, 2}); });
    refuses([](CameraSettings& s) { s.worldFromLens = Transform::scale({1, 1, -1}); });
    refuses([](CameraSettings& s) { s.worldFromLens.x = {1, 0.1, 0}; });
    refuses([&](CameraSettings& s) { s.worldFromLens.translation.y = nan; });
    CHECK_THROWS_AS(Camera(std::make_shared<CappedLens>(lens), settingsFor(720, 480)),
                    std::invalid_argument);
}

}  // namespace
}  // namespace etendue
