// IdealLens: the maps of first-order optics, exact for any angle, that pinhole and thin lens share.
#pragma once

#include <optional>

#include "lens/lens_model.h"

namespace etendue {

/// A lens in the plane z = 0 that images the sensor's plane z = −v sharply onto the plane z = u.
/// It is not stopped down: every aperture point passes.
struct IdealLens {
    double sensorDistanceMm;     // v
    double focusCurvaturePerMm;  // 1/u; 0 for focus at infinity. Without effect where a = 0

    /// As LensModel's.
    std::optional<ExitRay> trace(SensorPoint sensor, AperturePoint aperture) const;
    std::optional<SensorPoint> connect(const Eigen::Vector3d& targetMm,
                                       AperturePoint aperture) const;
};

}  // namespace etendue
