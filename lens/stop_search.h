// StopSearch: where at the stop a search for the ray to a target starts, and where it need not go.
#pragma once

#include "lens/stop_region.h"
#include "lens/stop_start.h"

namespace etendue {

class StopSearch {
public:
    /// Traces some thousand rays.
    StopSearch(const OpticalSystem& system, double sensorZMm);

    /// The slope to start from, and how far from there the ray can be.
    struct Start {
        Eigen::Vector2d slope;
        double reach;  // infinite for near targets, whose first guess may be anything
    };
    /// Empty when no ray that passes the rims meets the target.
    std::optional<Start> start(const Eigen::Vector3d& targetMm, AperturePoint aperture) const;

    /// False: a ray of this slope ends at a rim.
    bool mayPass(AperturePoint aperture, const Eigen::Vector2d& slope) const {
        return region_.distanceTo(aperture, slope) <= 0.0;
    }

private:
    StopRegion region_;
    StopStart start_;
    double nearestMm_;       // of targets far enough for first guesses to be trusted
    double reach_, beyond_;  // where the rays to those are: of StopStart::Guess
};

}  // namespace etendue
