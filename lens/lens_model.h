// LensModel: one question, "given a sensor point, an aperture point and a wavelength, where does
// the ray leave the lens, and how does it move when the sensor point moves?", and its inverse.
// Every camera of the renderer asks it and nothing else.
//
// Lens space: millimetres, +z toward the scene, the sensor parallel to the xy plane at negative z.
// The origin is the pinhole or the centre of the thin lens; a prescription's lens names its own.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <span>

namespace etendue {

struct SensorPoint {
    Eigen::Vector2d mm;
};

struct AperturePoint {
    Eigen::Vector2d mm;
};

/// A ray that leaves the lens toward the scene.
struct ExitRay {
    Eigen::Vector3d origin;                         // mm
    Eigen::Vector3d direction;                      // unit
    Eigen::Matrix<double, 3, 2> originBySensor;     // mm per mm, aperture point held fixed
    Eigen::Matrix<double, 3, 2> directionBySensor;  // 1/mm, aperture point held fixed
    double throughput;                              // J τ of equation (1), per mm² of aperture
};

/// The sensor point that sees a target, and the ray from it.
struct Sighting {
    SensorPoint sensor;
    ExitRay ray;
};

/// Where a ray that leaves the lens comes from, at one wavelength.
struct RayOrigin {
    SensorPoint sensor;
    AperturePoint aperture;
    ExitRay ray;     // at that wavelength
    double etendue;  // of the rays that leave, per area of the sensor and of the aperture, 1/mm²
};

class LensModel {
public:
    virtual ~LensModel() = default;

    /// Empty when no light passes the lens from `sensor` through `aperture`.
    virtual std::optional<ExitRay> trace(SensorPoint sensor, AperturePoint aperture,
                                         double wavelengthNm) const = 0;

    /// trace() at the first of `wavelengthsNm`; at each other one, where the ray comes from that
    /// leaves the lens the same way. As many `origins`; all empty when the first is, and others
    /// where a ray on that way would be blocked. By default the lens parts no colours and loses no
    /// light.
    virtual void traceEach(SensorPoint sensor, AperturePoint aperture,
                           std::span<const double> wavelengthsNm,
                           std::span<std::optional<RayOrigin>> origins) const {
        const std::optional<ExitRay> ray = trace(sensor, aperture, wavelengthsNm.front());
        for (std::optional<RayOrigin>& origin : origins)
            origin = ray ? std::optional(RayOrigin{sensor, aperture, *ray, ray->throughput})
                         : std::nullopt;
    }

    /// The sensor point from which the ray through `aperture` meets `targetMm` (lens space). Empty
    /// when there is none.
    virtual std::optional<SensorPoint> connect(const Eigen::Vector3d& targetMm,
                                               AperturePoint aperture,
                                               double wavelengthNm) const = 0;

    /// connect(), with the ray that trace() makes there; a lens that has searched may give that of
    /// a sensor point nearer than its search's tolerance.
    virtual std::optional<Sighting> see(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                        double wavelengthNm) const {
        const std::optional<SensorPoint> sensor = connect(targetMm, aperture, wavelengthNm);
        if (!sensor) return {};
        const std::optional<ExitRay> ray = trace(*sensor, aperture, wavelengthNm);
        if (!ray) return {};
        return Sighting{*sensor, *ray};
    }
    /// see() at each of `wavelengthsNm`, into as many `sightings`. A lens may decide by the first
    /// whether the target is in sight.
    virtual void seeEach(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                         std::span<const double> wavelengthsNm,
                         std::span<std::optional<Sighting>> sightings) const {
        for (std::size_t i = 0; i < wavelengthsNm.size(); ++i)
            sightings[i] = see(targetMm, aperture, wavelengthsNm[i]);
    }
    /// Whether see() finds the sensor point, give or take `toleranceMm`, from which trace() is
    /// known to meet `targetMm`. A lens that searches may know that without a search.
    virtual bool finds(SensorPoint sensor, const Eigen::Vector3d& targetMm, AperturePoint aperture,
                       double wavelengthNm, double toleranceMm) const {
        const std::optional<Sighting> sighting = see(targetMm, aperture, wavelengthNm);
        return sighting &&
               ((sighting->sensor.mm - sensor.mm).cwiseAbs().array() < toleranceMm).all();
    }

    /// Uniform over the aperture's area. `u` in [0, 1)².
    virtual AperturePoint sampleAperture(Eigen::Vector2d u) const = 0;
    /// mm². A pinhole's aperture is a point; its area counts as 1.
    virtual double apertureAreaMm2() const = 0;
    /// No ray leaves farther from the origin of lens space; infinite where that is not known.
    virtual double reachMm() const { return std::numeric_limits<double>::infinity(); }
};

/// Perspective through a point, the sensor at `sensorDistanceMm` behind it.
std::unique_ptr<LensModel> makePinhole(double sensorDistanceMm);

/// The ideal lens of focal length f, focused at the distance u in front of the lens (infinity
/// allowed): the sensor is at v = 1/(1/f − 1/u) behind it. The aperture is a disc of
/// `apertureRadiusMm` in the lens plane. Throws std::invalid_argument unless u > f > 0 and the
/// radius is positive.
std::unique_ptr<LensModel> makeThinLens(double focalLengthMm, double focusDistanceMm,
                                        double apertureRadiusMm);

}  // namespace etendue
