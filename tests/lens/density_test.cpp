#include "lens/density.h"

#include <doctest/doctest.h>

#include <cmath>

namespace etendue {
namespace {

TEST_CASE("exchangeJacobian: through empty space it is cos⁴ over the distance squared") {
    // A plane at 50 mm in front of the sensor, A = s + 50 q.
    const Eigen::Matrix2d apertureBySlope = 50.0 * Eigen::Matrix2d::Identity();
    for (const Eigen::Vector2d& q : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.7, -1.9)}) {
        const double cosine = 1.0 / std::sqrt(1.0 + q.squaredNorm());
        const double expected = std::pow(cosine, 4) / 2500.0;
        CHECK(std::abs(exchangeJacobian(q, apertureBySlope) - expected) <= 1e-15 * expected);
        // A lens that mirrors one axis passes as much.
        Eigen::Matrix2d mirrored = apertureBySlope;
        mirrored(0, 0) = -50.0;
        CHECK(exchangeJacobian(q, mirrored) == exchangeJacobian(q, apertureBySlope));
    }
}

TEST_CASE("slopeBySensor: moving along it leaves the aperture point where it is") {
    Eigen::Matrix2d bySlope, bySensor;
    bySlope << 40.0, 3.0, -2.0, 35.0;
    bySensor << 0.8, 0.1, -0.3, 0.9;
    const Eigen::Matrix2d k = slopeBySensor(bySlope, bySensor);
    const Eigen::Vector2d ds(0.3, -0.2);
    CHECK((bySensor * ds + bySlope * (k * ds)).norm() <= 1e-15);
}

TEST_CASE("footprint: a fan from one point covers the distance squared times its solid angle") {
    ExitRay ray;
    ray.direction = Eigen::Vector3d(0.2, -0.1, 1.0).normalized();
    ray.originBySensor.setZero();
    ray.directionBySensor.col(0) = 0.01 * ray.direction.unitOrthogonal();
    ray.directionBySensor.col(1) = 0.02 * ray.direction.cross(ray.direction.unitOrthogonal());
    CHECK(std::abs(turning(ray) - 2e-4) <= 1e-18);
    const double area = determinantAcross(ray.direction, footprint(ray, 300.0));
    CHECK(std::abs(area - 300.0 * 300.0 * 2e-4) <= 1e-13);
    ray.directionBySensor.col(0).swap(ray.directionBySensor.col(1));
    CHECK(turning(ray) < 0.0);
}

}  // namespace
}  // namespace etendue
