// Camera: one class for every lens; pixels ↔ mm ↔ metres, and the densities of docs/camera.md.
// Everything about densities is written here once and used by every estimator.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "lens/lens_model.h"
#include "renderer/spectrum.h"
#include "renderer/surface_point.h"
#include "renderer/transform.h"
#include "renderer/vec.h"
#include "renderer/wavelengths.h"

namespace etendue {

class OuterPupil;

/// A ray from the lens into the scene, in world space.
struct CameraRay {
    Vec3 origin;
    Vec3 direction;  // unit, to float precision
    float weight;    // J τ |A| / N of equation (1), times the exposure: radiance → pixel value
    // The footprint's two parts: how the ray moves with the film point, aperture point held fixed.
    std::array<Vec3, 2> originByPixel;     // m per pixel
    std::array<Vec3, 2> directionByPixel;  // 1 per pixel
};

/// Where a camera ray comes from, at one wavelength.
struct CameraRayOrigin {
    Vec2 film;       // pixels, from the top left of the full frame; may lie outside it
    CameraRay ray;   // with weight and footprint of that wavelength
    double etendue;  // of the rays that leave, per area of sensor and aperture, 1/mm²; positive
    AperturePoint aperture;
};

/// At the wavelength of each lane, of one ray.
using CameraRayOrigins = std::array<std::optional<CameraRayOrigin>, Spectrum::lanes>;

/// A scene point seen through one aperture point.
struct CameraConnection {
    Vec2 film;       // pixels, from the top left of the full frame; may lie outside it
    CameraRay ray;   // the ray that trace would have made there
    float distance;  // m, from ray.origin to the scene point
};

/// At the wavelength of each lane.
using CameraConnections = std::array<std::optional<CameraConnection>, Spectrum::lanes>;

/// Film x, to the right, is the sensor's +x and film y, down, its +y: the lens turns the picture by
/// 180°, and so does a lens space of +y up, +z forward, whose +x is at the viewer's left.
struct CameraSettings {
    int width = 0, height = 0;                    // pixels of the full frame
    double sensorWidthMm = 36.0;                  // pixels are square
    Eigen::Vector2d sensorOffsetMm = {0.0, 0.0};  // of the frame's centre from the lens' axis
    Transform worldFromLens;                      // rotation and translation; lens axes in metres
    double exposureStops = 0.0;                   // the picture times 2^stops
    /// The lens is asked at each wavelength; else at Wavelengths::rgbWavelengthNm alone.
    bool isDispersive = false;
    /// Connections are drawn on the lens' outermost surface, in place of its aperture: for
    /// comparison. Their densities are then not those of sampleRay.
    std::shared_ptr<const OuterPupil> outerPupil = {};
};

/// Where `film` (pixels, full frame) lies on the sensor, from the lens' axis.
Eigen::Vector2d sensorPointMm(const CameraSettings& settings, Vec2 film);

class Camera {
public:
    /// Throws std::invalid_argument for settings that make no picture, and for a lens that lets no
    /// light through to the sensor's centre, by which brightness is normalised.
    Camera(std::shared_ptr<const LensModel> lens, const CameraSettings& settings);

    /// The ray from film point `film` (pixels, full frame; need not lie inside it) through the
    /// aperture point that `apertureUniform` draws, at the hero wavelength: a dispersive lens sends
    /// the others elsewhere. Empty when the lens blocks it.
    std::optional<CameraRay> sampleRay(Vec2 film, Vec2 apertureUniform,
                                       const Wavelengths& wavelengths) const;

    /// The same ray, the first lane's, and where it comes from at every other wavelength. All empty
    /// when the lens blocks it.
    CameraRayOrigins sampleRayOfEach(Vec2 film, Vec2 apertureUniform,
                                     const Wavelengths& wavelengths) const;

    /// The film point from which the ray through that same aperture point meets `scenePoint`, at
    /// the hero wavelength. Empty when there is none, and on an image of the aperture point, where
    /// every film point would do.
    /// The importance of the connection is ray.weight · pdfArea(ray, …), exactly equation (1) after
    /// the change of variables from film to scene.
    std::optional<CameraConnection> connect(Vec3 scenePoint, Vec2 apertureUniform,
                                            const Wavelengths& wavelengths) const;
    /// The same at every wavelength, through one aperture point.
    CameraConnections connectEach(Vec3 scenePoint, Vec2 apertureUniform,
                                  const Wavelengths& wavelengths) const;

    /// The same for a point at infinity in the unit `direction`; the connection's distance is
    /// infinite, its importance ray.weight · pdfSolidAngle(ray).
    std::optional<CameraConnection> connectToInfinity(Vec3 direction, Vec2 apertureUniform,
                                                      const Wavelengths& wavelengths) const;
    CameraConnections connectEachToInfinity(Vec3 direction, Vec2 apertureUniform,
                                            const Wavelengths& wavelengths) const;

    /// Whether connecting what the ray of `origin` meets at `distance`, m, which may be infinite,
    /// finds the film point of `origin`, through its aperture point and at that lane's wavelength.
    bool findsAgain(const CameraRayOrigin& origin, float distance, const Wavelengths& wavelengths,
                    std::size_t lane) const;
    /// How near another film point counts as the same, pixels: far below the distance of two
    /// roots, far above the rounding of a scene point.
    static constexpr double sameFilmTolerance = 0.1;

    /// Whether all rays leave the lens behind the plane through `point`, which faces `normal`
    /// (unit).
    bool isBehind(Vec3 point, Vec3 normal) const;

    const CameraSettings& settings() const { return settings_; }
    Vec3 position() const;  // of the lens origin, world
    Vec3 forward() const;

private:
    struct Target {
        Eigen::Vector3d mm;  // lens space
        bool isAtInfinity;   // and so far away there
    };
    Target targetAt(Vec3 scenePoint) const;
    Target targetToward(Vec3 direction) const;
    /// At the first wavelengths, as many as there are `connections`.
    void connectTo(const Target& target, Vec2 apertureUniform, const Wavelengths& wavelengths,
                   std::span<std::optional<CameraConnection>> connections) const;
    /// At as many wavelengths as there are `connections`.
    void connectThrough(AperturePoint aperture, const Target& target, std::span<const double> nm,
                        std::span<std::optional<CameraConnection>> connections) const;
    std::optional<CameraConnection> connectionOf(const Sighting& sighting,
                                                 const Target& target) const;
    std::optional<CameraConnection> connectAtOuterPupil(const Target& target, Vec2 uniform,
                                                        double nm) const;
    double wavelengthNm(const Wavelengths& wavelengths, std::size_t lane) const;
    std::array<double, Spectrum::lanes> wavelengthsNm(const Wavelengths& wavelengths) const;
    Vec2 filmPoint(const Eigen::Vector2d& sensorMm) const;
    CameraRay worldRay(const ExitRay& exit) const;

    std::shared_ptr<const LensModel> lens_;
    CameraSettings settings_;
    Transform lensFromWorld_;
    double pixelMm_ = 0.0;
    double weightScale_ = 0.0;  // |A| / N of equation (1) times 2^exposureStops, mm²
};

/// Equation (2): density per camera sample of one pixel, 1/m², at the point where `ray` meets a
/// surface at the finite `distance` with unit normal `normal`. Zero on a surface seen edge-on;
/// else infinite where the footprint vanishes, on an image of the aperture point.
float pdfArea(const CameraRay& ray, float distance, Vec3 normal);
/// Its limit at infinity, 1/sr. Infinite where the lens collimates.
float pdfSolidAngle(const CameraRay& ray);
/// ray.weight · pdfArea(ray, distance, normal), rounded once: finite even where the density alone
/// would leave a float's range.
float importance(const CameraRay& ray, float distance, Vec3 normal);

}  // namespace etendue
