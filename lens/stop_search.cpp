#include "lens/stop_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lens/stop_ray.h"

namespace etendue {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The farthest that a first guess is from where it should be, over the rays that just pass.
double worstGuess(const MonochromaticSystem& lens, const StopRegion& region, const StopStart& start,
                  double nearestMm) {
    double worst = 0.0;
    for (const StopRegion::EdgeRay& edge : region.edge()) {
        const Eigen::Vector2d &a = edge.aperture, &p = edge.slope;
        LensRay<double> ray = rayAtStop<double>(lens.system, {a.x(), a.y(), p.x(), p.y()});
        if (leaveFront<TraceMode::geometry>(lens, ray).status != TraceStatus::passed) continue;
        for (const double distance : {2.0 * nearestMm, 1e3 * nearestMm}) {
            const Eigen::Vector3d target = toEigen(ray.origin + ray.direction * distance);
            const double error = (start.slope(target, {a}) - p).norm();
            if (!(error <= worst)) worst = error;  // also when not a number
        }
    }
    return worst;
}

}  // namespace

StopSearch::StopSearch(const MonochromaticSystem& lens, double sensorZMm)
    : region_(lens, sensorZMm),
      start_(lens, region_.isAxial(), region_.steepest()),
      nearestMm_(4.0 * lens.system.surfaces.front().semiApertureMm),
      // What lies between the rays tried, and other wavelengths.
      reach_(2.0 * worstGuess(lens, region_, start_, nearestMm_) + 0.03 * region_.steepest()) {}

std::optional<StopSearch::Start> StopSearch::start(const Eigen::Vector3d& target,
                                                   AperturePoint aperture) const {
    const Eigen::Vector2d guess = start_.slope(target, aperture);
    const bool isFar = target.squaredNorm() >= nearestMm_ * nearestMm_;
    if (isFar && region_.distanceTo(aperture, guess) > reach_) return {};
    const Eigen::Vector2d inside = region_.nearest(aperture, guess);
    if (!inside.allFinite()) return Start{region_.centre(aperture.mm), infinity};
    return Start{inside, isFar ? reach_ + (inside - guess).norm() : infinity};
}

}  // namespace etendue
