// The slope q at which a ray must leave a sensor point to cross the stop at an aperture point.
#pragma once

#include <Eigen/LU>
#include <optional>

#include "lens/lens_model.h"
#include "lens/paraxial.h"

namespace etendue {

/// Where a ray of slope q from the sensor crosses the stop, and how that moves with q.
struct StopHit {
    Eigen::Vector2d mm;
    Eigen::Matrix2d bySlope;
};

/// In the paraxial limit.
inline Eigen::Vector2d paraxialSlope(const StopMap& paraxial, SensorPoint sensor,
                                     AperturePoint aperture) {
    return (aperture.mm - paraxial.bySensor.cwiseProduct(sensor.mm))
        .cwiseQuotient(paraxial.bySlope);
}

/// A(s, q) = a by Newton's method from the slope `q`; steps are halved until the miss shrinks.
/// `hit` gives a StopHit for a slope, rims ignored, or nothing. It finds every ray that passes a
/// lens we know from the paraxial slope; what it does not find, the rear elements lead elsewhere.
template <class Hit>
std::optional<Eigen::Vector2d> solveSlope(const Hit& hit, Eigen::Vector2d q, AperturePoint aperture,
                                          double stopRadiusMm) {
    std::optional<StopHit> at = hit(q);
    constexpr int mostSteps = 12, mostHalvings = 4;
    for (int i = 0; at && i < mostSteps; ++i) {
        const Eigen::Vector2d miss = at->mm - aperture.mm;
        const Eigen::Vector2d step = at->bySlope.inverse() * miss;
        if (!step.allFinite()) return {};
        // One more step squares what is missing: far below rounding.
        if (miss.norm() <= 1e-8 * stopRadiusMm) return q - step;
        std::optional<StopHit> next;
        double share = 1.0;
        for (int halving = 0; halving < mostHalvings; ++halving, share *= 0.5) {
            next = hit(q - share * step);
            if (next && (next->mm - aperture.mm).norm() < miss.norm()) break;
            next.reset();
        }
        q -= share * step;
        at = next;
    }
    return {};
}

}  // namespace etendue
