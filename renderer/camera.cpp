#include "renderer/camera.h"

#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "lens/outer_pupil.h"
#include "renderer/frame.h"

namespace etendue {

namespace {

// Numbers in parentheses are the equations of docs/camera.md.

constexpr double metresPerMm = 1e-3;

Eigen::Vector2d toEigen(Vec2 v) { return {v.x, v.y}; }
Vec3d toVec(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Vector2d filmCenter(const CameraSettings& settings) {
    return {0.5 * settings.width, 0.5 * settings.height};
}

/// N / |A| of (1): the mean of J τ over the aperture, seen from the centre of the sensor.
/// Blocked rays count as zero.
double meanThroughputOnAxis(const LensModel& lens) {
    // A Fibonacci lattice (Sloan and Joe 1994): it errs by about one in its number of points, even
    // where an edge blocks part of the aperture.
    constexpr int count = 10946, generator = 6765;
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        const Eigen::Vector2d u((i + 0.5) / count,
                                static_cast<double>(std::int64_t{i} * generator % count) / count);
        const std::optional<ExitRay> ray = lens.trace(
            {Eigen::Vector2d::Zero()}, lens.sampleAperture(u), Wavelengths::rgbWavelengthNm);
        if (ray) sum += ray->throughput;
    }
    return sum / count;
}

bool isRigid(const Transform& t) {
    constexpr double tolerance = 1e-6;
    const auto isOne = [](double value) { return std::abs(value - 1.0) <= tolerance; };
    const auto isZero = [](double value) { return std::abs(value) <= tolerance; };
    return isFinite(t.translation) && isOne(lengthSquared(t.x)) && isOne(lengthSquared(t.y)) &&
           isOne(lengthSquared(t.z)) && isZero(dot(t.x, t.y)) && isZero(dot(t.y, t.z)) &&
           isZero(dot(t.z, t.x)) && t.determinant() > 0.0;
}

/// The area that the parallelogram of `a` and `b` covers across the unit direction `d`.
double areaAcross(Vec3d a, Vec3d b, Vec3d d) { return absDot(cross(a, b), d); }

/// |det F| of (2): what one pixel covers across the ray at `distance`, m².
double footprintArea(const CameraRay& ray, double distance) {
    assert(std::isfinite(distance));
    const auto column = [&](std::size_t i) {
        return toDouble(ray.originByPixel[i]) + distance * toDouble(ray.directionByPixel[i]);
    };
    return areaAcross(column(0), column(1), toDouble(ray.direction));
}

/// Whether `distance`, which may be infinite, is off the images of the aperture point.
bool hasFootprint(const CameraRay& ray, float distance) {
    return std::isinf(distance) ? !std::isinf(pdfSolidAngle(ray))
                                : footprintArea(ray, distance) != 0.0;
}

/// numerator / area, with no NaN where both vanish: a numerator of zero stays zero.
float perArea(double numerator, double area) {
    return numerator == 0.0 ? 0.0f : static_cast<float>(numerator / area);
}

}  // namespace

Eigen::Vector2d sensorPointMm(const CameraSettings& settings, Vec2 film) {  // (3)
    return (toEigen(film) - filmCenter(settings)) * (settings.sensorWidthMm / settings.width) +
           settings.sensorOffsetMm;
}

Camera::Camera(std::shared_ptr<const LensModel> lens, const CameraSettings& settings)
    : lens_(std::move(lens)),
      settings_(settings),
      lensFromWorld_(settings.worldFromLens.inverse()),
      pixelMm_(settings.sensorWidthMm / settings.width) {
    if (settings.width <= 0 || settings.height <= 0)
        throw std::invalid_argument("camera: width and height must be positive");
    if (!(settings.sensorWidthMm > 0.0 && std::isfinite(settings.sensorWidthMm)))
        throw std::invalid_argument("camera: the sensor's width must be positive");
    if (!settings.sensorOffsetMm.allFinite())
        throw std::invalid_argument("camera: the sensor's offset must be finite");
    if (!isRigid(settings.worldFromLens))
        throw std::invalid_argument("camera: worldFromLens may only rotate and translate");
    const double mean = meanThroughputOnAxis(*lens_);
    if (!(mean > 0.0 && std::isfinite(mean)))
        throw std::invalid_argument("camera: no light reaches the centre of the sensor");
    weightScale_ = std::exp2(settings.exposureStops) / mean;
    if (!(weightScale_ > 0.0 && std::isfinite(weightScale_)))
        throw std::invalid_argument("camera: exposure out of range");
}

std::optional<CameraRay> Camera::sampleRay(Vec2 film, Vec2 apertureUniform,
                                           const Wavelengths& wavelengths) const {
    const SensorPoint sensor{sensorPointMm(settings_, film)};
    const AperturePoint aperture = lens_->sampleAperture(toEigen(apertureUniform));
    const std::optional<ExitRay> exit =
        lens_->trace(sensor, aperture, wavelengthNm(wavelengths, 0));
    if (!exit) return {};
    return worldRay(*exit);
}

CameraRayOrigins Camera::sampleRayOfEach(Vec2 film, Vec2 apertureUniform,
                                         const Wavelengths& wavelengths) const {
    const SensorPoint sensor{sensorPointMm(settings_, film)};
    const AperturePoint aperture = lens_->sampleAperture(toEigen(apertureUniform));
    std::array<std::optional<RayOrigin>, Spectrum::lanes> origins;
    lens_->traceEach(sensor, aperture, wavelengthsNm(wavelengths), origins);
    CameraRayOrigins result;
    if (!origins[0]) return result;
    const CameraRay hero = worldRay(origins[0]->ray);
    for (std::size_t lane = 0; lane < origins.size(); ++lane) {
        if (!origins[lane] || !(origins[lane]->etendue > 0.0)) continue;
        CameraRayOrigin origin{lane == 0 ? film : filmPoint(origins[lane]->sensor.mm),
                               worldRay(origins[lane]->ray), origins[lane]->etendue,
                               origins[lane]->aperture};
        // But for the search's tolerance it is the same ray.
        origin.ray.origin = hero.origin;
        origin.ray.direction = hero.direction;
        if (std::isfinite(origin.film.x) && std::isfinite(origin.film.y)) result[lane] = origin;
    }
    return result;
}

std::optional<CameraConnection> Camera::connect(Vec3 scenePoint, Vec2 apertureUniform,
                                                const Wavelengths& wavelengths) const {
    std::optional<CameraConnection> connection;
    connectTo(targetAt(scenePoint), apertureUniform, wavelengths, {&connection, 1});
    return connection;
}

CameraConnections Camera::connectEach(Vec3 scenePoint, Vec2 apertureUniform,
                                      const Wavelengths& wavelengths) const {
    CameraConnections connections;
    connectTo(targetAt(scenePoint), apertureUniform, wavelengths, connections);
    return connections;
}

std::optional<CameraConnection> Camera::connectToInfinity(Vec3 direction, Vec2 apertureUniform,
                                                          const Wavelengths& wavelengths) const {
    std::optional<CameraConnection> connection;
    connectTo(targetToward(direction), apertureUniform, wavelengths, {&connection, 1});
    return connection;
}

CameraConnections Camera::connectEachToInfinity(Vec3 direction, Vec2 apertureUniform,
                                                const Wavelengths& wavelengths) const {
    CameraConnections connections;
    connectTo(targetToward(direction), apertureUniform, wavelengths, connections);
    return connections;
}

Camera::Target Camera::targetAt(Vec3 scenePoint) const {
    const Vec3d target = lensFromWorld_.point(toDouble(scenePoint)) / metresPerMm;
    return {{target.x, target.y, target.z}, false};
}

Camera::Target Camera::targetToward(Vec3 direction) const {
    // So far away that a lens's size is an angle below a float's rounding.
    constexpr double farMm = 1e12;
    const Vec3d target = lensFromWorld_.vector(toDouble(direction)) * farMm;
    return {{target.x, target.y, target.z}, true};
}

void Camera::connectTo(const Target& target, Vec2 apertureUniform, const Wavelengths& wavelengths,
                       std::span<std::optional<CameraConnection>> connections) const {
    const std::array<double, Spectrum::lanes> nm = wavelengthsNm(wavelengths);
    if (settings_.outerPupil) {
        for (std::size_t lane = 0; lane < connections.size(); ++lane)
            connections[lane] = connectAtOuterPupil(target, apertureUniform, nm[lane]);
        return;
    }
    connectThrough(lens_->sampleAperture(toEigen(apertureUniform)), target,
                   std::span(nm).first(connections.size()), connections);
}

void Camera::connectThrough(AperturePoint aperture, const Target& target,
                            std::span<const double> nm,
                            std::span<std::optional<CameraConnection>> connections) const {
    // The rays that sampleRay would make, so that both directions share one weight and one
    // footprint.
    std::array<std::optional<Sighting>, Spectrum::lanes> sightings;
    lens_->seeEach(target.mm, aperture, nm, std::span(sightings).first(nm.size()));
    for (std::size_t i = 0; i < nm.size(); ++i)
        if (sightings[i]) connections[i] = connectionOf(*sightings[i], target);
}

bool Camera::findsAgain(const CameraRayOrigin& origin, float distance,
                        const Wavelengths& wavelengths, std::size_t lane) const {
    const CameraRay& ray = origin.ray;
    const bool isInfinite = std::isinf(distance);
    const Target target =
        isInfinite ? targetToward(ray.direction) : targetAt(ray.origin + ray.direction * distance);
    return hasFootprint(ray, distance) &&
           lens_->finds({sensorPointMm(settings_, origin.film)}, target.mm, origin.aperture,
                        wavelengthNm(wavelengths, lane), sameFilmTolerance * pixelMm_);
}

std::optional<CameraConnection> Camera::connectionOf(const Sighting& sighting,
                                                     const Target& target) const {
    const Vec2 film = filmPoint(sighting.sensor.mm);
    if (!std::isfinite(film.x) || !std::isfinite(film.y)) return {};
    const CameraRay ray = worldRay(sighting.ray);
    const auto distance =
        target.isAtInfinity
            ? std::numeric_limits<float>::infinity()
            : static_cast<float>((target.mm - sighting.ray.origin).norm() * metresPerMm);
    if (!target.isAtInfinity && !std::isfinite(distance)) return {};
    if (!hasFootprint(ray, distance)) return {};
    return CameraConnection{film, ray, distance};
}

Vec2 Camera::filmPoint(const Eigen::Vector2d& sensorMm) const {  // (3)
    const Eigen::Vector2d film =
        (sensorMm - settings_.sensorOffsetMm) / pixelMm_ + filmCenter(settings_);
    return {static_cast<float>(film.x()), static_cast<float>(film.y())};
}

std::optional<CameraConnection> Camera::connectAtOuterPupil(const Target& target, Vec2 uniform,
                                                            double nm) const {
    const auto arrival =
        settings_.outerPupil->arrive(target.mm, target.isAtInfinity, toEigen(uniform), nm);
    if (!arrival) return {};
    const Transform& world = settings_.worldFromLens;
    CameraConnection connection{};
    connection.film = filmPoint(arrival->sensorMm);
    CameraRay& ray = connection.ray;
    ray.origin = toFloat(world.point(toVec(arrival->entranceMm) * metresPerMm));
    ray.direction = toFloat(world.vector(toVec(arrival->direction)));
    // Equation (1) with ds da J = ds dω cosθ, the étendue that the lens conserves, at the sensor
    // and at the entrance: what comes through the point is drawn there by its area, so that of the
    // footprint only the distance squared is left.
    const double pixels = lens_->apertureAreaMm2() * pixelMm_ * pixelMm_;
    ray.weight = static_cast<float>(arrival->etenduePerSolidAngle * weightScale_ / pixels);
    const Frame across = Frame::fromZ(ray.direction);
    ray.directionByPixel = {across.x, across.y};
    connection.distance =
        target.isAtInfinity
            ? std::numeric_limits<float>::infinity()
            : static_cast<float>((target.mm - arrival->entranceMm).norm() * metresPerMm);
    return connection;
}

double Camera::wavelengthNm(const Wavelengths& wavelengths, std::size_t lane) const {
    return settings_.isDispersive ? wavelengths.nm[lane] : Wavelengths::rgbWavelengthNm;
}

std::array<double, Spectrum::lanes> Camera::wavelengthsNm(const Wavelengths& wavelengths) const {
    std::array<double, Spectrum::lanes> nm;
    for (std::size_t lane = 0; lane < nm.size(); ++lane) nm[lane] = wavelengthNm(wavelengths, lane);
    return nm;
}

CameraRay Camera::worldRay(const ExitRay& exit) const {
    const Transform& world = settings_.worldFromLens;
    const auto byPixel = [&](const Eigen::Vector3d& bySensor, double unit) {
        return toFloat(world.vector(toVec(bySensor) * (pixelMm_ * unit)));
    };
    return CameraRay{
        .origin = toFloat(world.point(toVec(exit.origin) * metresPerMm)),
        .direction = toFloat(world.vector(toVec(exit.direction))),
        .weight = static_cast<float>(exit.throughput * weightScale_),  // (4)
        .originByPixel = {byPixel(exit.originBySensor.col(0), metresPerMm),
                          byPixel(exit.originBySensor.col(1), metresPerMm)},
        .directionByPixel = {byPixel(exit.directionBySensor.col(0), 1.0),
                             byPixel(exit.directionBySensor.col(1), 1.0)},
    };
}

bool Camera::isBehind(Vec3 point, Vec3 normal) const {
    const Vec3d toLens = settings_.worldFromLens.translation - toDouble(point);
    const double rounding = 1e-4 * length(toLens);  // of floats, ample
    return dot(toLens, toDouble(normal)) < -(lens_->reachMm() * metresPerMm + rounding);
}

Vec3 Camera::position() const { return toFloat(settings_.worldFromLens.translation); }
Vec3 Camera::forward() const { return toFloat(settings_.worldFromLens.z); }

float pdfArea(const CameraRay& ray, float distance, Vec3 normal) {
    return perArea(absDot(toDouble(normal), toDouble(ray.direction)), footprintArea(ray, distance));
}

float importance(const CameraRay& ray, float distance, Vec3 normal) {
    const double cosine = absDot(toDouble(normal), toDouble(ray.direction));
    return perArea(ray.weight * cosine, footprintArea(ray, distance));
}

float pdfSolidAngle(const CameraRay& ray) {
    return perArea(1.0, areaAcross(toDouble(ray.directionByPixel[0]),
                                   toDouble(ray.directionByPixel[1]), toDouble(ray.direction)));
}

}  // namespace etendue
