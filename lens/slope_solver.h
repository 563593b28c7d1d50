// SlopeSolver: the slope q at which a ray must leave the sensor point s to cross the stop at a.
#pragma once

#include <Eigen/LU>
#include <optional>

#include "lens/lens_model.h"
#include "lens/paraxial.h"
#include "lens/phase_space.h"
#include "lens/sequential_trace.h"

namespace etendue {

/// A(s, q) = a by Newton's method on the exact trace, rims ignored, from the paraxial guess. It
/// finds every ray that passes a lens we know; what it does not find, the rear elements lead
/// elsewhere.
class SlopeSolver {
public:
    /// `paraxial` for the sensor's plane.
    SlopeSolver(const MonochromaticSystem& lens, const StopMap& paraxial, double sensorZMm)
        : lens_(lens),
          paraxial_(paraxial),
          sensorZMm_(sensorZMm),
          scaleMm_(lens.system.surfaces[lens.system.stop].semiApertureMm) {}

    /// Steps are halved until the miss shrinks.
    std::optional<Eigen::Vector2d> solve(SensorPoint sensor, AperturePoint aperture) const {
        Eigen::Vector2d q = guess(sensor, aperture);
        std::optional<StopHit> at = hit(sensor, q);
        constexpr int mostSteps = 12, mostHalvings = 4;
        for (int i = 0; at && i < mostSteps; ++i) {
            const Eigen::Vector2d miss = at->mm - aperture.mm;
            const Eigen::Vector2d step = at->bySlope.inverse() * miss;
            if (!step.allFinite()) return {};
            // One more step squares what is missing: far below rounding.
            if (miss.norm() <= 1e-8 * scaleMm_) return q - step;
            std::optional<StopHit> next;
            double share = 1.0;
            for (int halving = 0; halving < mostHalvings; ++halving, share *= 0.5) {
                next = hit(sensor, q - share * step);
                if (next && (next->mm - aperture.mm).norm() < miss.norm()) break;
                next.reset();
            }
            q -= share * step;
            at = next;
        }
        return {};
    }

private:
    /// Where a ray crosses the stop, and how that moves with its slope at the sensor.
    struct StopHit {
        Eigen::Vector2d mm;
        Eigen::Matrix2d bySlope;
    };

    Eigen::Vector2d guess(SensorPoint sensor, AperturePoint aperture) const {
        return (aperture.mm - paraxial_.bySensor.cwiseProduct(sensor.mm))
            .cwiseQuotient(paraxial_.bySlope);
    }

    std::optional<StopHit> hit(SensorPoint sensor, const Eigen::Vector2d& q) const {
        using D = Dual<2>;
        const PlaneState<D> state{D(sensor.mm.x()), D(sensor.mm.y()), D::variable(q.x(), 0),
                                  D::variable(q.y(), 1)};
        LensRay<D> ray = rayOf(state, sensorZMm_);
        const std::size_t stop = lens_.system.stop, end = lens_.system.surfaces.size();
        const Passage passage =
            carryToScene<TraceMode::geometry>(lens_, stop, end, ray, [](auto...) {});
        if (passage.status != TraceStatus::passed) return {};
        StopHit result;
        const auto& [x, y, z] = ray.origin;
        result.mm << x.value, y.value;
        result.bySlope << x.partials[0], x.partials[1], y.partials[0], y.partials[1];
        return result;
    }

    const MonochromaticSystem& lens_;
    const StopMap& paraxial_;
    double sensorZMm_;
    double scaleMm_;
};

}  // namespace etendue
