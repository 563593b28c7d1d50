#include "lens/refocused_lens.h"

#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>

namespace etendue {

RefocusedLens::RefocusedLens(const Prescription& prescription, const LensFit& fit,
                             const Aperture& aperture, double sensorDistanceMm)
    : lens_(prescription, fit, aperture), shiftMm_(sensorDistanceMm - fit.domain.sensorDistanceMm) {
    const double rounding = 1e-12 * fit.domain.sensorDistanceMm;
    if (!(shiftMm_ >= -rounding && shiftMm_ <= fit.domain.sensorTravelMm + rounding))
        throw std::invalid_argument("refocused lens: outside the focus range of the fit");
    if (fit.domain.sensorTravelMm > 0.0) slope_.emplace(fit.slope);
}

RefocusedLens::Moved RefocusedLens::moved(const Eigen::Vector2d& reference, AperturePoint aperture,
                                          double wavelengthNm) const {
    if (!slope_) return {reference, Eigen::Matrix2d::Identity()};
    const auto q = slope_->evaluateBySensor({reference, aperture.mm, wavelengthNm});
    Eigen::Matrix2d bySensor;
    bySensor << q.bySensor[0][0], q.bySensor[0][1], q.bySensor[1][0], q.bySensor[1][1];
    return {reference - shiftMm_ * Eigen::Vector2d(q.values[0], q.values[1]),
            Eigen::Matrix2d::Identity() - shiftMm_ * bySensor};
}

std::optional<RefocusedLens::Reference> RefocusedLens::referenceOf(SensorPoint sensor,
                                                                   AperturePoint aperture,
                                                                   double wavelengthNm) const {
    // Newton's method. The slope is all but linear in the point: two or three steps.
    Eigen::Vector2d reference = sensor.mm;
    Moved at = moved(reference, aperture, wavelengthNm);
    constexpr int mostSteps = 10;
    for (int i = 0; (at.mm - sensor.mm).norm() > 1e-12 * lens_.domain().sensorHalfSizeMm.norm();
         ++i) {
        if (i == mostSteps || !at.mm.allFinite()) return {};
        reference -= at.byReference.inverse() * (at.mm - sensor.mm);
        at = moved(reference, aperture, wavelengthNm);
    }
    return Reference{{reference}, at};
}

std::optional<ExitRay> RefocusedLens::byMovedSensor(ExitRay ray, const Moved& at) {
    const Eigen::Matrix2d referenceBySensor = at.byReference.inverse();
    const double determinant = referenceBySensor.determinant();
    if (!(determinant > 0.0)) return {};
    ray.originBySensor *= referenceBySensor;
    ray.directionBySensor *= referenceBySensor;
    ray.throughput *= determinant;
    return ray;
}

std::optional<ExitRay> RefocusedLens::trace(SensorPoint sensor, AperturePoint aperture,
                                            double wavelengthNm) const {
    const auto reference = referenceOf(sensor, aperture, wavelengthNm);
    if (!reference) return {};
    const std::optional<ExitRay> ray = lens_.trace(reference->sensor, aperture, wavelengthNm);
    if (!ray) return {};
    return byMovedSensor(*ray, reference->moved);
}

void RefocusedLens::traceEach(SensorPoint sensor, AperturePoint aperture,
                              std::span<const double> wavelengthsNm,
                              std::span<std::optional<RayOrigin>> origins) const {
    std::fill(origins.begin(), origins.end(), std::nullopt);
    const auto reference = referenceOf(sensor, aperture, wavelengthsNm.front());
    if (!reference) return;
    lens_.traceEach(reference->sensor, aperture, wavelengthsNm, origins);
    for (std::size_t i = 0; i < origins.size(); ++i) {
        if (!origins[i]) continue;
        RayOrigin& origin = *origins[i];
        const Moved at = moved(origin.sensor.mm, origin.aperture, wavelengthsNm[i]);
        const auto ray = byMovedSensor(origin.ray, at);
        if (ray)
            origin = {
                {at.mm}, origin.aperture, *ray, origin.etendue / at.byReference.determinant()};
        else
            origins[i].reset();
    }
    if (!origins[0]) std::fill(origins.begin(), origins.end(), std::nullopt);
}

std::optional<SensorPoint> RefocusedLens::connect(const Eigen::Vector3d& targetMm,
                                                  AperturePoint aperture,
                                                  double wavelengthNm) const {
    const auto reference = lens_.connect(targetMm, aperture, wavelengthNm);
    if (!reference) return {};
    return SensorPoint{moved(reference->mm, aperture, wavelengthNm).mm};
}

}  // namespace etendue
