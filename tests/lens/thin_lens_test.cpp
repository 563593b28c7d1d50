#include <doctest/doctest.h>

#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "lens/lens_model.h"
#include "statistics/statistics.h"
#include "tests/lens/lens_checks.h"

namespace etendue {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// One lens of each kind that photographers use, and some that they do not.
struct Setup {
    double focalLengthMm, focusMm, fNumber;
    double apertureRadiusMm() const { return 0.5 * focalLengthMm / fNumber; }
    double sensorDistanceMm() const { return 1.0 / (1.0 / focalLengthMm - 1.0 / focusMm); }
    std::unique_ptr<LensModel> make() const {
        return makeThinLens(focalLengthMm, focusMm, apertureRadiusMm());
    }
};

std::vector<Setup> setups() {
    std::vector<Setup> all;
    for (const double focusMm : {100.0, 1e3, 1e4, infinity})
        for (const double fNumber : {0.95, 2.8, 16.0}) all.push_back({50.0, focusMm, fNumber});
    all.push_back({50.0, 51.0, 2.8});  // macro, 50 : 1
    all.push_back({4.0, 500.0, 1.8});  // fields beyond 70°
    all.push_back({600.0, 5e4, 4.0});
    return all;
}

/// Where the line from the sensor point through the aperture point crosses the plane z.
Eigen::Vector2d insideAt(SensorPoint s, AperturePoint a, double sensorDistanceMm, double z) {
    return a.mm + (a.mm - s.mm) * (z / sensorDistanceMm);
}

TEST_CASE("ThinLens: connect finds the sensor point that trace started from") {
    LensRandom random(1);
    for (const Setup& setup : setups()) {
        const auto lens = setup.make();
        for (int i = 0; i < 100; ++i) {
            const SensorPoint s = random.onSensor(18.0, 12.0);
            const AperturePoint a = lens->sampleAperture(random.inUnitSquare());
            const double distance = std::pow(10.0, random.between(-1.0, 9.0));
            // Some twenty roundings of numbers no larger than |s| + v |a| (1/distance + 1/u),
            // which bounds what the target's coordinates contribute.
            const double scale = s.mm.norm() + setup.sensorDistanceMm() * a.mm.norm() *
                                                   (1.0 / distance + 1.0 / setup.focusMm);
            const double slope = s.mm.norm() / setup.sensorDistanceMm() + 1.0;
            checkRoundTrip(*lens, s, a, distance, 20 * 1.2e-16 * scale * slope);
        }
    }
}

TEST_CASE("ThinLens: the exit ray's derivatives agree with central differences") {
    LensRandom random(2);
    for (const Setup& setup : setups()) {
        const auto lens = setup.make();
        const double v = setup.sensorDistanceMm();
        for (int i = 0; i < 40; ++i) {
            const AperturePoint a = lens->sampleAperture(random.inUnitSquare());
            // As for the pinhole.
            checkDerivatives(*lens, random.onSensor(18.0, 12.0), a, v * 1e-3, 0.0, 1e-11 / v);
        }
    }
}

TEST_CASE("ThinLens: throughput is what sensor and aperture exchange") {
    LensRandom random(3);
    for (const Setup& setup : setups()) {
        const auto lens = setup.make();
        for (int i = 0; i < 40; ++i) {
            const SensorPoint s = random.onSensor(18.0, 12.0);
            const AperturePoint a = lens->sampleAperture(random.inUnitSquare());
            const auto ray = lens->trace(s, a, greenNm);
            REQUIRE(ray.has_value());
            // v is computed here by the lens equation, whose subtraction costs up to 50 ulps.
            CHECK(ray->throughput ==
                  doctest::Approx(exchangeFactor(s, a, setup.sensorDistanceMm())).epsilon(3e-14));
        }
    }
}

TEST_CASE("ThinLens: through its centre it is a pinhole") {
    LensRandom random(4);
    const AperturePoint center{{0.0, 0.0}};
    for (const Setup& setup : setups()) {
        const auto lens = setup.make();
        const auto pinhole = makePinhole(setup.sensorDistanceMm());
        for (int i = 0; i < 20; ++i) {
            const SensorPoint s = random.onSensor(18.0, 12.0);
            const auto thin = lens->trace(s, center, greenNm);
            const auto pin = pinhole->trace(s, center, greenNm);
            REQUIRE(thin.has_value());
            REQUIRE(pin.has_value());
            CHECK((thin->direction - pin->direction).norm() <= 1e-13);
            CHECK((thin->directionBySensor - pin->directionBySensor).norm() <=
                  1e-13 * pin->directionBySensor.norm());
            CHECK(thin->throughput == doctest::Approx(pin->throughput).scale(0.0).epsilon(1e-13));
        }
    }
}

TEST_CASE("ThinLens: all rays from a sensor point meet in the plane of focus") {
    LensRandom random(5);
    for (const Setup& setup : setups()) {
        const auto lens = setup.make();
        const SensorPoint s = random.onSensor(18.0, 12.0);
        // Magnification u/v, upside down. At infinity the rays are parallel instead.
        const Eigen::Vector2d slope = -s.mm / setup.sensorDistanceMm();
        for (int i = 0; i < 40; ++i) {
            const AperturePoint a = lens->sampleAperture(random.inUnitSquare());
            const auto ray = lens->trace(s, a, greenNm);
            REQUIRE(ray.has_value());
            const Eigen::Vector2d raySlope = ray->direction.head<2>() / ray->direction.z();
            if (setup.focusMm == infinity) {
                CHECK((raySlope - slope).norm() <= 1e-14 * (1.0 + slope.norm()));
                continue;
            }
            const Eigen::Vector2d met = ray->origin.head<2>() + setup.focusMm * raySlope;
            // 1e-14 of the largest term, and the 50 ulps of v.
            CHECK((met - setup.focusMm * slope).norm() <=
                  2e-14 * (setup.focusMm * slope.norm() + a.mm.norm()));
        }
    }
}

TEST_CASE("ThinLens: rays from any scene point obey the lens equation") {
    LensRandom random(6);
    for (const Setup& setup : setups()) {
        const auto lens = setup.make();
        for (int i = 0; i < 40; ++i) {
            const double z = setup.focalLengthMm * random.between(1.2, 40.0);
            const Eigen::Vector3d target(z * random.between(-0.3, 0.3),
                                         z * random.between(-0.3, 0.3), z);
            const double imageDistance = 1.0 / (1.0 / setup.focalLengthMm - 1.0 / z);
            const Eigen::Vector2d image = target.head<2>() * (-imageDistance / z);
            const AperturePoint a = lens->sampleAperture(random.inUnitSquare());
            const auto s = lens->connect(target, a, greenNm);
            REQUIRE(s.has_value());
            const Eigen::Vector2d crossing =
                insideAt(*s, a, setup.sensorDistanceMm(), -imageDistance);
            // The sensor point's error, 50 ulps of v and a few of the rest, grows by the ratio of
            // the two distances.
            const double ratio = 1.0 + imageDistance / setup.sensorDistanceMm();
            const double size = s->mm.norm() + a.mm.norm() + image.norm();
            CHECK((crossing - image).norm() <= 3e-14 * ratio * size);
        }
    }
}

TEST_CASE("ThinLens: a point out of focus becomes a disc of the size that geometry gives") {
    for (const Setup& setup : setups()) {
        const auto lens = setup.make();
        const double v = setup.sensorDistanceMm();
        for (const double factor : {1.3, 2.0, 7.0, 1000.0}) {
            const double z = setup.focalLengthMm * factor;
            const Eigen::Vector3d target(0.1 * z, -0.2 * z, z);
            // Similar triangles between aperture and image point.
            const double imageDistance = 1.0 / (1.0 / setup.focalLengthMm - 1.0 / z);
            const double discRadius =
                setup.apertureRadiusMm() * std::abs(imageDistance - v) / imageDistance;
            const auto middle = lens->connect(target, {{0.0, 0.0}}, greenNm);
            REQUIRE(middle.has_value());
            for (int i = 0; i < 8; ++i) {
                const double angle = 0.25 * std::numbers::pi * i;
                const AperturePoint rim{setup.apertureRadiusMm() *
                                        Eigen::Vector2d(std::cos(angle), std::sin(angle))};
                const auto s = lens->connect(target, rim, greenNm);
                REQUIRE(s.has_value());
                CHECK((s->mm - middle->mm).norm() ==
                      doctest::Approx(discRadius).epsilon(1e-13).scale(middle->mm.norm() + v));
            }
        }
    }
}

TEST_CASE("ThinLens: sampleAperture is uniform on the disc") {
    const auto lens = makeThinLens(50.0, infinity, 9.0);
    CHECK(lens->apertureAreaMm2() == doctest::Approx(81.0 * std::numbers::pi).epsilon(1e-15));
    constexpr std::size_t rings = 16, sectors = 16;
    constexpr int count = 400000;
    std::vector<double> observed(rings * sectors + 1, 0.0);
    std::vector<double> expected(rings * sectors + 1, 1.0 * count / (rings * sectors));
    expected.back() = 0.0;  // beyond the rim
    LensRandom random(7);
    for (int i = 0; i < count; ++i) {
        const Eigen::Vector2d a = lens->sampleAperture(random.inUnitSquare()).mm / 9.0;
        const double turn = std::atan2(a.y(), a.x()) / (2.0 * std::numbers::pi) + 0.5;
        // Rings of equal area. A point rounded onto the rim belongs to the last.
        const auto ring = std::min(static_cast<std::size_t>(a.squaredNorm() * rings), rings - 1);
        const auto sector = std::min(static_cast<std::size_t>(turn * sectors), sectors - 1);
        const bool beyond = a.norm() > 1.0 + 1e-15;
        ++observed[beyond ? rings * sectors : ring * sectors + sector];
    }
    const ChiSquareResult result = chiSquareTest(observed, expected);
    CHECK(result.countInEmptyCells == 0.0);
    CHECK(result.pValue > 1e-3);  // one test
}

TEST_CASE("ThinLens: random numbers at the edge of their range give open aperture points") {
    for (const double radius : {1e-3, 9.0, 1234.5}) {
        const auto lens = makeThinLens(5000.0, infinity, radius);
        for (const double x : {0.0, 0x1p-32, 0.25, 0.5, 0.75, 1.0 - 0x1p-24, 1.0 - 0x1p-53})
            for (const double y : {0.0, 0x1p-32, 0.3, 0.5, 0.75, 1.0 - 0x1p-24, 1.0 - 0x1p-53}) {
                const AperturePoint a = lens->sampleAperture({x, y});
                CHECK(a.mm.allFinite());
                CHECK(lens->trace({{1.0, 2.0}}, a, greenNm).has_value());
                CHECK(lens->connect({1.0, 2.0, 3.0}, a, greenNm).has_value());
            }
    }
}

TEST_CASE("ThinLens: light passes through the aperture alone") {
    const auto lens = makeThinLens(50.0, 1000.0, 9.0);
    const AperturePoint outside{{9.0001, 0.0}};
    CHECK_FALSE(lens->trace({{1.0, 2.0}}, outside, greenNm).has_value());
    CHECK_FALSE(lens->connect({1.0, 2.0, 300.0}, outside, greenNm).has_value());
}

TEST_CASE(
    "ThinLens: nothing is seen behind it, in its plane, at its centre, or at no point at all") {
    const auto lens = makeThinLens(50.0, 1000.0, 9.0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const AperturePoint a{{3.0, -2.0}};
    for (const Eigen::Vector3d& target :
         {Eigen::Vector3d(1, 2, -3), Eigen::Vector3d(1, 2, 0), Eigen::Vector3d(0, 0, 0),
          Eigen::Vector3d(3, -2, 0), Eigen::Vector3d(1, 2, 1e-320), Eigen::Vector3d(nan, 0, 1),
          Eigen::Vector3d(0, 0, nan), Eigen::Vector3d(infinity, 0, infinity)})
        CHECK_FALSE(lens->connect(target, a, greenNm).has_value());
}

TEST_CASE("ThinLens: a lens that cannot be is refused") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(makeThinLens(50.0, 50.0, 9.0), std::invalid_argument);
    CHECK_THROWS_AS(makeThinLens(50.0, 49.0, 9.0), std::invalid_argument);
    CHECK_THROWS_AS(makeThinLens(0.0, 49.0, 9.0), std::invalid_argument);
    CHECK_THROWS_AS(makeThinLens(-5.0, 49.0, 9.0), std::invalid_argument);
    CHECK_THROWS_AS(makeThinLens(nan, 49.0, 9.0), std::invalid_argument);
    CHECK_THROWS_AS(makeThinLens(50.0, nan, 9.0), std::invalid_argument);
    CHECK_THROWS_AS(makeThinLens(50.0, infinity, 0.0), std::invalid_argument);
    CHECK_THROWS_AS(makeThinLens(50.0, infinity, -1.0), std::invalid_argument);
    CHECK_THROWS_AS(makeThinLens(50.0, infinity, infinity), std::invalid_argument);
    CHECK_THROWS_AS(makeThinLens(50.0, infinity, nan), std::invalid_argument);
    const double large = 1e300;
    CHECK_THROWS_AS(makeThinLens(large, std::nextafter(large, infinity), 9.0),
                    std::invalid_argument);
}

}  // namespace
}  // namespace etendue
