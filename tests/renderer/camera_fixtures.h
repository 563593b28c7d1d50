// Cameras to test with, and lenses that exist only to be tested with.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "lens/lens_model.h"
#include "renderer/camera.h"

namespace etendue {

using LensPointer = std::shared_ptr<const LensModel>;

struct ThinLensSetup {
    double focalLengthMm, focusMm, fNumber;
    double apertureRadiusMm() const { return 0.5 * focalLengthMm / fNumber; }
    double sensorDistanceMm() const { return 1.0 / (1.0 / focalLengthMm - 1.0 / focusMm); }
    LensPointer make() const { return makeThinLens(focalLengthMm, focusMm, apertureRadiusMm()); }
};

constexpr double focusAtInfinity = std::numeric_limits<double>::infinity();

inline std::vector<ThinLensSetup> thinLenses() {
    std::vector<ThinLensSetup> all;
    for (const double focusMm : {100.0, 1e3, 1e4, focusAtInfinity})
        for (const double fNumber : {0.95, 2.8, 16.0}) all.push_back({50.0, focusMm, fNumber});
    return all;
}

/// A camera that stands somewhere and looks somewhere, with no axis along the world's.
inline Transform somewhere() {
    return Transform::translate({0.7, -1.3, 2.1}) *
           Transform::rotate(normalize(Vec3d{1.0, 2.0, -3.0}), 143.0);
}

inline CameraSettings settingsFor(int width, int height, const Transform& worldFromLens = {}) {
    CameraSettings settings;
    settings.width = width;
    settings.height = height;
    settings.worldFromLens = worldFromLens;
    return settings;
}

/// Another lens, in part.
class LensAround : public LensModel {
public:
    explicit LensAround(LensPointer lens) : lens_(std::move(lens)) {}
    std::optional<ExitRay> trace(SensorPoint s, AperturePoint a, double nm) const override {
        return lens_->trace(s, a, nm);
    }
    std::optional<SensorPoint> connect(const Eigen::Vector3d& target, AperturePoint a,
                                       double nm) const override {
        return lens_->connect(target, a, nm);
    }
    AperturePoint sampleAperture(Eigen::Vector2d u) const override {
        return lens_->sampleAperture(u);
    }
    double apertureAreaMm2() const override { return lens_->apertureAreaMm2(); }

private:
    LensPointer lens_;
};

/// The same rays, which start further out as they do on the front element of a real lens: in the
/// plane z = `forwardMm`.
class ForwardedLens final : public LensAround {
public:
    ForwardedLens(LensPointer lens, double forwardMm)
        : LensAround(std::move(lens)), forwardMm_(forwardMm) {}
    std::optional<ExitRay> trace(SensorPoint s, AperturePoint a, double nm) const override {
        std::optional<ExitRay> ray = LensAround::trace(s, a, nm);
        if (!ray) return {};
        // X + k D stays in the plane: k = (forward − X.z) / D.z.
        const double k = (forwardMm_ - ray->origin.z()) / ray->direction.z();
        const Eigen::RowVector2d kBySensor =
            -(ray->originBySensor.row(2) + k * ray->directionBySensor.row(2)) / ray->direction.z();
        ray->origin += k * ray->direction;
        ray->originBySensor += k * ray->directionBySensor + ray->direction * kBySensor;
        return ray;
    }

private:
    double forwardMm_;
};

/// A knife edge over half the aperture.
class HalfCoveredLens final : public LensAround {
public:
    using LensAround::LensAround;
    std::optional<ExitRay> trace(SensorPoint s, AperturePoint a, double nm) const override {
        if (a.mm.x() < 0.0) return {};
        return LensAround::trace(s, a, nm);
    }
};

/// A filter over the lens, whose transmittance is the wavelength in micrometres.
class TintedLens final : public LensAround {
public:
    using LensAround::LensAround;
    std::optional<ExitRay> trace(SensorPoint s, AperturePoint a, double nm) const override {
        std::optional<ExitRay> ray = LensAround::trace(s, a, nm);
        if (ray) ray->throughput *= nm * 1e-3;
        return ray;
    }
};

/// The cap is on.
class CappedLens final : public LensAround {
public:
    using LensAround::LensAround;
    std::optional<ExitRay> trace(SensorPoint, AperturePoint, double) const override { return {}; }
};

}  // namespace etendue
