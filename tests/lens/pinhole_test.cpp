#include <doctest/doctest.h>

#include <limits>
#include <stdexcept>

#include "lens/lens_model.h"
#include "tests/lens/lens_checks.h"

namespace etendue {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const AperturePoint hole{{0.0, 0.0}};

TEST_CASE("Pinhole: connect finds the sensor point that trace started from") {
    LensRandom random(1);
    for (const double v : {5.0, 50.0, 500.0}) {
        const auto lens = makePinhole(v);
        for (int i = 0; i < 200; ++i) {
            const SensorPoint s = random.onSensor(18.0, 12.0);
            const double distance = std::pow(10.0, random.between(-2.0, 9.0));
            // A dozen operations, each rounding by 1.1e-16 of a number no larger than |s|.
            checkRoundTrip(*lens, s, hole, distance, 12 * 1.2e-16 * s.mm.norm());
        }
    }
}

TEST_CASE("Pinhole: the exit ray's derivatives agree with central differences") {
    LensRandom random(2);
    for (const double v : {5.0, 50.0, 500.0}) {
        const auto lens = makePinhole(v);
        for (int i = 0; i < 100; ++i) {
            // With step h = v/1000, truncation is h⁴/30 times a fifth derivative of about 24/v⁵,
            // 1e-12/v; rounding, 1.1e-16/h times a few, 1e-12/v.
            checkDerivatives(*lens, random.onSensor(18.0, 12.0), hole, v * 1e-3, 0.0, 1e-11 / v);
        }
    }
}

TEST_CASE("Pinhole: throughput is what sensor and hole exchange, the fourth power of the cosine") {
    LensRandom random(3);
    for (const double v : {5.0, 50.0, 500.0}) {
        const auto lens = makePinhole(v);
        for (int i = 0; i < 100; ++i) {
            const SensorPoint s = random.onSensor(18.0, 12.0);
            const auto ray = lens->trace(s, hole, greenNm);
            REQUIRE(ray.has_value());
            // Relative rounding of about ten operations.
            CHECK(ray->throughput == doctest::Approx(exchangeFactor(s, hole, v)).epsilon(4e-15));
            const double cosine = ray->direction.z();  // the same on both sides of a hole
            CHECK(ray->throughput == doctest::Approx(std::pow(cosine, 4) / (v * v)).epsilon(4e-15));
        }
    }
}

TEST_CASE("Pinhole: the image is upside down on the sensor") {
    const auto lens = makePinhole(40.0);
    // +y up, +z forward: the viewer's right is −x.
    const auto right = lens->connect({-100.0, 0.0, 1000.0}, hole, greenNm);
    REQUIRE(right.has_value());
    CHECK(right->mm.x() == doctest::Approx(4.0).epsilon(1e-14));
    CHECK(right->mm.y() == 0.0);
    const auto up = lens->connect({0.0, 100.0, 1000.0}, hole, greenNm);
    REQUIRE(up.has_value());
    CHECK(up->mm.x() == 0.0);
    CHECK(up->mm.y() == doctest::Approx(-4.0).epsilon(1e-14));
}

TEST_CASE("Pinhole: nothing is seen behind it, in its plane, at the hole, or at no point at all") {
    const auto lens = makePinhole(50.0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Eigen::Vector3d& target :
         {Eigen::Vector3d(1, 2, -3), Eigen::Vector3d(1, 2, 0), Eigen::Vector3d(0, 0, 0),
          Eigen::Vector3d(1, 2, 1e-320), Eigen::Vector3d(nan, 0, 1), Eigen::Vector3d(0, 0, nan),
          Eigen::Vector3d(infinity, 0, 1), Eigen::Vector3d(infinity, 0, infinity)})
        CHECK_FALSE(lens->connect(target, hole, greenNm).has_value());
}

TEST_CASE("Pinhole: light passes through the hole alone") {
    const auto lens = makePinhole(50.0);
    CHECK(lens->apertureAreaMm2() == 1.0);
    CHECK(lens->sampleAperture({0.3, 0.9}).mm == hole.mm);
    const AperturePoint beside{{1e-9, 0.0}};
    CHECK_FALSE(lens->trace({{1.0, 2.0}}, beside, greenNm).has_value());
    CHECK_FALSE(lens->connect({1.0, 2.0, 3.0}, beside, greenNm).has_value());
}

TEST_CASE("Pinhole: a ray too oblique for its light to be a number is blocked") {
    const auto lens = makePinhole(50.0);
    CHECK_FALSE(lens->trace({{1e100, 0.0}}, hole, greenNm).has_value());
    CHECK_FALSE(lens->trace({{infinity, 0.0}}, hole, greenNm).has_value());
    CHECK_FALSE(
        lens->trace({{std::numeric_limits<double>::quiet_NaN(), 0.0}}, hole, greenNm).has_value());
}

TEST_CASE("Pinhole: a sensor that is not behind it is refused") {
    for (const double v : {0.0, -1.0, infinity, std::numeric_limits<double>::quiet_NaN()})
        CHECK_THROWS_AS(makePinhole(v), std::invalid_argument);
}

}  // namespace
}  // namespace etendue
