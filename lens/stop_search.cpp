#include "lens/stop_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lens/stop_ray.h"

namespace etendue {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The farthest that first guesses are from where they should be, and that targets are beyond the
/// field of the rays that guesses are made from, over the rays that just pass.
struct Worst {
    double error = 0.0, beyond = 0.0;
};

void tryEdge(const MonochromaticSystem& lens, const StopRegion& region, const StopStart& start,
             double nearestMm, Worst& worst) {
    const auto raise = [](double& most, double value) {
        if (!(value <= most)) most = value;  // also when not a number
    };
    for (const StopRegion::EdgeRay& edge : region.edge()) {
        const Eigen::Vector2d &a = edge.aperture, &p = edge.slope;
        LensRay<double> ray = rayAtStop<double>(lens.system, {a.x(), a.y(), p.x(), p.y()});
        if (leaveFront<TraceMode::geometry>(lens, ray).status != TraceStatus::passed) continue;
        for (const double distance : {nearestMm, 1e3 * nearestMm}) {
            const StopStart::Guess guess =
                start.guess(toEigen(ray.origin + ray.direction * distance), {a});
            raise(worst.error, (guess.slope - p).norm());
            raise(worst.beyond, guess.beyond);
        }
    }
}

/// Of targets that first guesses are good for, in semi-apertures of the first surface, and of those
/// that they are tried on, which lie nearer by what the surface is wide.
constexpr double nearestShare = 3.0, nearestTried = 2.0;

}  // namespace

StopSearch::StopSearch(const OpticalSystem& system, double sensorZMm)
    : region_(system, sensorZMm),
      start_({system, refractiveIndices(system, dLineNm), dLineNm}, region_.isAxial(),
             region_.steepest()),
      nearestMm_(nearestShare * system.surfaces.front().semiApertureMm) {
    Worst worst;
    for (const double nm : {shortestWavelengthNm, dLineNm, longestWavelengthNm})
        tryEdge({system, refractiveIndices(system, nm), nm}, region_, start_,
                nearestTried * system.surfaces.front().semiApertureMm, worst);
    // The rays tried are not all.
    constexpr double share = 2.0, slopeShare = 0.03, beyondRadians = 0.02;
    reach_ = share * worst.error + slopeShare * region_.steepest();
    beyond_ = share * worst.beyond + beyondRadians;
}

std::optional<StopSearch::Start> StopSearch::start(const Eigen::Vector3d& target,
                                                   AperturePoint aperture) const {
    const auto [guess, beyond] = start_.guess(target, aperture);
    const bool isFar = target.squaredNorm() >= nearestMm_ * nearestMm_;
    const Eigen::Vector2d inside = region_.nearest(aperture, guess);
    if (!inside.allFinite()) return Start{region_.centre(aperture.mm), infinity};
    if (!isFar) return Start{inside, infinity};
    const double moved = (inside - guess).norm();
    if (moved > reach_ || beyond > beyond_) return {};
    return Start{inside, reach_ + moved};
}

}  // namespace etendue
