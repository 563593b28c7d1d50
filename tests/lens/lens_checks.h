// What every LensModel must satisfy, whatever it is made of.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "lens/lens_model.h"

namespace etendue {

/// Uniform numbers for lens tests, which know no renderer.
class LensRandom {
public:
    explicit LensRandom(std::uint64_t seed) : engine_(seed) {}
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    Eigen::Vector2d inUnitSquare() {
        const double x = between(0.0, 1.0);
        return {x, between(0.0, 1.0)};
    }
    SensorPoint onSensor(double halfWidthMm, double halfHeightMm) {
        const double x = between(-halfWidthMm, halfWidthMm);
        return {{x, between(-halfHeightMm, halfHeightMm)}};
    }

private:
    std::mt19937_64 engine_;
};

constexpr double greenNm = 550.0;

/// The sensor moved by ±h and ±2h along an axis: the five-point central difference, whose
/// truncation error is h⁴/30 of the fifth derivative.
template <class Quantity>
Eigen::Vector3d centralDifference(const LensModel& lens, SensorPoint s, AperturePoint a, int axis,
                                  double h, const Quantity& quantity) {
    const auto at = [&](double steps) -> Eigen::Vector3d {
        SensorPoint moved = s;
        moved.mm[axis] += steps * h;
        const std::optional<ExitRay> ray = lens.trace(moved, a, greenNm);
        REQUIRE(ray.has_value());
        return quantity(*ray);
    };
    const Eigen::Vector3d near = at(1.0) - at(-1.0), far = at(2.0) - at(-2.0);
    return (8.0 * near - far) / (12.0 * h);
}

/// The stated derivatives of the exit ray against central differences with step `stepMm`, to
/// `relative` of the derivative's own size plus `absolute` (mm/mm and 1/mm).
inline void checkDerivatives(const LensModel& lens, SensorPoint s, AperturePoint a, double stepMm,
                             double relative, double absolute) {
    const std::optional<ExitRay> ray = lens.trace(s, a, greenNm);
    REQUIRE(ray.has_value());
    CHECK(std::abs(ray->direction.norm() - 1.0) <= 1e-14);
    for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Vector3d origin =
            centralDifference(lens, s, a, axis, stepMm, [](const ExitRay& r) { return r.origin; });
        const Eigen::Vector3d direction = centralDifference(
            lens, s, a, axis, stepMm, [](const ExitRay& r) { return r.direction; });
        const Eigen::Vector3d statedOrigin = ray->originBySensor.col(axis);
        const Eigen::Vector3d statedDirection = ray->directionBySensor.col(axis);
        CHECK((statedOrigin - origin).norm() <= relative * origin.norm() + absolute);
        CHECK((statedDirection - direction).norm() <= relative * direction.norm() + absolute);
    }
}

/// connect() finds the sensor point that trace() started from, seen from `distanceMm` along the
/// exit ray; to `toleranceMm`.
inline void checkRoundTrip(const LensModel& lens, SensorPoint s, AperturePoint a, double distanceMm,
                           double toleranceMm) {
    const std::optional<ExitRay> ray = lens.trace(s, a, greenNm);
    REQUIRE(ray.has_value());
    const Eigen::Vector3d target = ray->origin + distanceMm * ray->direction;
    const std::optional<SensorPoint> found = lens.connect(target, a, greenNm);
    REQUIRE(found.has_value());
    CHECK((found->mm - s.mm).norm() <= toleranceMm);
}

/// J of equation (1) without the map's derivative: two surface elements a distance r apart exchange
/// cosθ cosθ′ / r² per mm² of each; sensor and aperture are parallel.
inline double exchangeFactor(SensorPoint s, AperturePoint a, double sensorDistanceMm) {
    const Eigen::Vector3d between(a.mm.x() - s.mm.x(), a.mm.y() - s.mm.y(), sensorDistanceMm);
    const double cosTheta = between.z() / between.norm();
    return cosTheta * cosTheta / between.squaredNorm();
}

}  // namespace etendue
