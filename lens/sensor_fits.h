// Small fits about the sensor that go with a lens fit: where connect() starts its search, and the
// slope at the sensor, by which a lens is refocused.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "lens/fit_rays.h"
#include "lens/polynomial_basis.h"

namespace etendue {

class FittedMap;

/// A direction as a point in the plane, by Lambert's equal-area projection about +z: at the radius
/// 2 sin(θ/2), smooth up to 180° off the axis.
inline Eigen::Vector2d fieldCoordinates(const Eigen::Vector3d& direction) {
    return direction.head<2>() * std::sqrt(2.0 / (1.0 + direction.z()));
}

/// How a target looks from a point of the entrance pupil.
struct TargetSight {
    Eigen::Vector2d field;  // coordinates of its direction
    double nearness;        // EntrancePupil's wander over its distance
};

/// The paraxial one, the mean of both planes; the first vertex instead where that lies in front of
/// the lens or very far behind.
class EntrancePupil {
public:
    explicit EntrancePupil(const OpticalSystem& system);

    /// Where the ray through `aperture` paraxially comes from, lens space, mm.
    Eigen::Vector3d point(AperturePoint aperture) const;
    TargetSight sight(const Eigen::Vector3d& targetMm, AperturePoint aperture) const;
    /// How far from there rays may leave.
    double wanderMm() const { return wanderMm_; }

private:
    Eigen::Vector2d perStop_;
    double zMm_, wanderMm_;
};

/// The sensor point from how the target looks (k its nearness) and from the aperture point:
///     s ≈ S + k' G,   k' = k + bend k²,   k at most 1
/// with G the derivative of s by k for the far targets that S is exact for. Rays that leave from
/// elsewhere than the pupil point see a near target in another direction.
struct ConnectStart {
    SparsePolynomial sensor;  // (field, a, λ) → S and G, mm
    double nearnessBend = 0.0;
    /// Up to this k no training ray's guess lies beyond farthestGuess, nor near it: a target whose
    /// guess does is out of the field. 0 where directions hardly tell sensor points apart, in
    /// lenses telecentric at their objects.
    double trustedNearness = 0.0;
    double widestField = 0.0;  // no |field| of a ray in the domain is larger
    double errorMm = 0.0;      // of S, rms over the training rays
};

/// In half sizes of the sensor.
constexpr double farthestGuess = 1.1;

/// `at`: start.sensor's values at the target's field, S and G.
template <class Values>
Eigen::Vector2d sensorGuess(const ConnectStart& start, const TargetSight& sight, const Values& at) {
    const double k = std::min(sight.nearness, 1.0), bent = k + start.nearnessBend * k * k;
    return {at[0] + bent * at[2], at[1] + bent * at[3]};
}

/// A start for searches on `map`, whose rays leave a little beside the traced ones. It has as few
/// terms as put nearly all guesses for far targets within sightToleranceRadians, where that is
/// possible. `isAxial`: whether the lens turns about its axis unchanged.
ConnectStart fitConnectStart(std::span<const FitRay> training, const FittedMap& map,
                             const OpticalSystem& system, bool isAxial);

/// Of far targets on the rays those whose guess meets them within sightToleranceRadians, so that
/// one evaluation of the map is all it takes to see them.
double shareInSight(const ConnectStart& start, const FittedMap& map, std::span<const FitRay> rays);

/// (s, a, λ) → slope at the sensor.
SparsePolynomial fitSensorSlope(std::span<const FitRay> training, bool isAxial);

}  // namespace etendue
