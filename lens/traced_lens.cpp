#include "lens/traced_lens.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lens/axial_beam.h"

namespace etendue {

namespace {

OpticalSystem withAperture(const Prescription& prescription, const Aperture& aperture) {
    OpticalSystem system(prescription);
    constexpr double rounding = 1.0 + 1e-12;
    if (aperture.radiusMm() > system.surfaces[system.stop].semiApertureMm * rounding)
        throw std::invalid_argument("traced lens: the aperture is wider than the stop");
    system.aperture = aperture;
    return system;
}

/// The ray moved along itself to the point nearest the origin, lest a start far away cost digits.
LensRay<double> nearOrigin(const LensRay<double>& ray) {
    return {ray.origin - ray.direction * dot(ray.origin, ray.direction), ray.direction};
}

}  // namespace

TracedLens::TracedLens(const Prescription& prescription, const Aperture& aperture,
                       double sensorDistanceMm)
    : system_(withAperture(prescription, aperture)),
      sensorZMm_(system_.surfaces.back().vertexZMm - sensorDistanceMm),
      stopMap_(stopMap(system_, sensorDistanceMm)),
      stopSearch_(system_, sensorZMm_) {
    if (!(sensorDistanceMm > 0.0 && std::isfinite(sensorDistanceMm)))
        throw std::invalid_argument("traced lens: the sensor must be behind the last surface");
    const ParaxialData data = paraxialData(system_);
    focalLengthMm_ = 0.5 * (data.x.focalLengthMm + data.y.focalLengthMm);
}

std::optional<MonochromaticLens> TracedLens::at(double wavelengthNm) const {
    if (!isInRange(wavelengthNm)) return {};
    return MonochromaticLens(*this, wavelengthNm);
}

std::optional<ExitRay> TracedLens::trace(SensorPoint sensor, AperturePoint aperture,
                                         double wavelengthNm) const {
    if (!isInRange(wavelengthNm)) return {};
    return MonochromaticLens(*this, wavelengthNm).trace(sensor, aperture);
}

void TracedLens::traceEach(SensorPoint sensor, AperturePoint aperture,
                           std::span<const double> wavelengthsNm,
                           std::span<std::optional<RayOrigin>> origins) const {
    std::fill(origins.begin(), origins.end(), std::nullopt);
    const std::optional<ExitRay> hero = trace(sensor, aperture, wavelengthsNm.front());
    if (!hero) return;
    for (std::size_t i = 0; i < wavelengthsNm.size(); ++i)
        if (isInRange(wavelengthsNm[i]))
            origins[i] = MonochromaticLens(*this, wavelengthsNm[i]).originOf(*hero);
    // Traced back, a ray at a rim may be lost to rounding.
    if (!origins[0]) std::fill(origins.begin(), origins.end(), std::nullopt);
}

std::optional<SensorPoint> TracedLens::connect(const Eigen::Vector3d& targetMm,
                                               AperturePoint aperture, double wavelengthNm) const {
    return solve(targetMm, aperture, wavelengthNm).sensor;
}

AperturePoint TracedLens::sampleAperture(Eigen::Vector2d u) const {
    return {system_.aperture.sample(u)};
}

MonochromaticLens::MonochromaticLens(const TracedLens& lens, double wavelengthNm)
    : lens_(&lens),
      indices_(refractiveIndices(lens.system(), wavelengthNm)),
      wavelengthNm_(wavelengthNm) {
    if (!isInRange(wavelengthNm))
        throw std::invalid_argument("traced lens: the wavelength must be within 350–1100 nm");
}

TracedRay MonochromaticLens::traceToScene(const SensorState& sensor) const {
    TracedRay result{{}, rayOf(sensor, lens_->sensorZMm()), {}};
    const OpticalSystem& surfaces = lens_->system();
    const auto visit = [&](std::size_t index, const Vector3<double>& point) {
        if (index == surfaces.stop) result.aperture = planeState(result.ray, point.z);
    };
    result.passage =
        carryToScene<TraceMode::light>(system(), 0, surfaces.surfaces.size(), result.ray, visit);
    return result;
}

TracedRay MonochromaticLens::traceToSensor(const LensRay<double>& ray) const {
    TracedRay result{{}, nearOrigin(ray), {}};
    const OpticalSystem& surfaces = lens_->system();
    const auto visit = [&](std::size_t index, const Vector3<double>& point) {
        if (index == surfaces.stop) result.aperture = planeState(result.ray, point.z);
    };
    result.passage =
        carryToSensor<TraceMode::light>(system(), 0, surfaces.surfaces.size(), result.ray, visit);
    if (result.passage.status != TraceStatus::passed) return result;
    if (!(result.ray.direction.z < 0.0)) {  // turned away from the sensor
        result.passage.status = TraceStatus::missedSurface;
        return result;
    }
    const PlaneState<double> end = planeState(result.ray, lens_->sensorZMm());
    result.ray.origin = {end.x, end.y, lens_->sensorZMm()};
    return result;
}

std::optional<RayOrigin> MonochromaticLens::originOf(const ExitRay& leaving) const {
    const TracedRay arriving =
        traceToSensor({fromEigen(leaving.origin), fromEigen(leaving.direction) * -1.0});
    if (arriving.passage.status != TraceStatus::passed) return {};
    const SensorPoint sensor{{arriving.ray.origin.x, arriving.ray.origin.y}};
    const AperturePoint aperture{{arriving.aperture.x, arriving.aperture.y}};
    const std::optional<ExitRay> ray = trace(sensor, aperture);
    if (!ray) return {};
    // A lens conserves étendue: J of equation (1).
    return RayOrigin{sensor, aperture, *ray, ray->throughput / arriving.passage.transmittance};
}

std::unique_ptr<TracedLens> makeTracedLens(const Prescription& prescription,
                                           const LensSettings& settings) {
    const OpticalSystem system(prescription);
    const double radius = settings.fNumber ? stopRadiusForFNumber(system, *settings.fNumber)
                                           : system.aperture.radiusMm();
    const double sensorDistance = sensorDistanceMm(paraxialData(system), settings.focusDistanceMm);
    return std::make_unique<TracedLens>(prescription, Aperture(radius, settings.blades),
                                        sensorDistance);
}

}  // namespace etendue
