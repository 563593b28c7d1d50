// Aperture: the opening of the stop, a circle or n blades.
#pragma once

#include <Eigen/Core>

namespace etendue {

/// How blades shape an opening; without them it is a circle.
struct Blades {
    int count = 0;                 // or at least 3
    double rotationDegrees = 0.0;  // one corner points along +x turned by this toward +y
    double roundness = 0.0;        // 0: straight edges … 1: a circle
};

/// In the plane of the stop, centred on the axis. Without blades the opening is the disc of
/// radius R. n blades open the regular polygon inscribed in that circle; in polar form their edge
/// is p(φ) = R cos(π/n)/cos(φ − φₖ), φₖ being the middle of the nearest edge. Roundness w bends the
/// edges outward:
///     r(φ)² = (1 − w) p(φ)² + w R²                                                          (A1)
/// so that w = 1 is the circle again, and areas are linear in w.
class Aperture {
public:
    /// Throws std::invalid_argument.
    explicit Aperture(double radiusMm, const Blades& blades = {});

    double radiusMm() const { return radiusMm_; }  // of the circle through the corners
    double areaMm2() const;
    /// Its rim included, a few ulps wide.
    bool contains(const Eigen::Vector2d& pointMm) const;
    /// Uniform over the area. `u` in [0, 1)².
    Eigen::Vector2d sample(Eigen::Vector2d u) const;

private:
    double edgeSquared(double cosFromMiddle) const;  // r(φ)² of equation (A1)

    double radiusMm_;
    int blades_;  // 0 for a circle, also one made of blades
    double rotationRadians_;
    double roundness_;
    double halfSector_;    // π/n
    double inradiusMm_;    // R cos(π/n)
    double roundedShare_;  // of the area: what the circle of equation (A1) contributes
};

}  // namespace etendue
