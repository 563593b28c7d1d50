#include "lens/ideal_lens.h"

#include <cmath>

// Numbers in parentheses are the equations of docs/camera.md.

namespace etendue {

std::optional<ExitRay> IdealLens::trace(SensorPoint sensor, AperturePoint aperture) const {
    const double perMm = 1.0 / sensorDistanceMm;                  // 1 / v
    const Eigen::Vector2d q = (aperture.mm - sensor.mm) * perMm;  // (5)
    const double cosSquared = 1.0 / (1.0 + q.squaredNorm());
    const double throughput = cosSquared * cosSquared * (perMm * perMm);  // J of (5)
    if (!(throughput > 0.0)) return {};  // so oblique that it underflows

    const Eigen::Vector2d slope = -sensor.mm * perMm - aperture.mm * focusCurvaturePerMm;  // (6)
    const double inverseLength = 1.0 / std::sqrt(1.0 + slope.squaredNorm());

    ExitRay ray;
    ray.origin << aperture.mm, 0.0;
    ray.direction << slope * inverseLength, inverseLength;
    ray.originBySensor.setZero();
    // ∂slope/∂s = −1/v; normalising the direction takes away what would lengthen it.
    const double x = ray.direction.x(), y = ray.direction.y(), k = inverseLength * perMm;
    ray.directionBySensor << (x * x - 1.0) * k, x * y * k,  //
        x * y * k, (y * y - 1.0) * k,                       //
        x * k * inverseLength, y * k * inverseLength;
    ray.throughput = throughput;
    return ray;
}

std::optional<SensorPoint> IdealLens::connect(const Eigen::Vector3d& targetMm,
                                              AperturePoint aperture) const {
    if (!(targetMm.z() > 0.0)) return {};
    const Eigen::Vector2d slope = (targetMm.head<2>() - aperture.mm) / targetMm.z();
    const Eigen::Vector2d sensor = -sensorDistanceMm * (slope + aperture.mm * focusCurvaturePerMm);
    if (!sensor.allFinite()) return {};  // the target is all but in the lens's plane
    return SensorPoint{sensor};
}

}  // namespace etendue
