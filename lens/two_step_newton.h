// The published search for the sensor point that sees a target through an aperture point (Schrade,
// Hanika and Dachsbacher 2016, "Sparse high-degree polynomials for wide-angle lenses"): aperture
// error → slope, error of the outgoing direction → sensor point, in turns, from the axis.
#pragma once

#include "lens/slope_solver.h"
#include "lens/target_solver.h"

namespace etendue {

/// Where the ray of a sensor state crosses the stop, and how it leaves.
struct StateRay {
    StopHit stop;
    ExitRay exit;  // derivatives at fixed slope; throughput is τ
};

struct TwoStepResult {
    std::optional<SensorPoint> sensor;
    int iterations = 0;
};

/// `stateRay` gives a StateRay for a sensor point and a slope, or nothing. Undamped; each step
/// takes the other variable for fixed, as published. Empty when 100 turns do not bring both errors
/// below 1e-9, of the stop's radius and in radians.
template <class StateRayOf>
TwoStepResult twoStepNewton(const StateRayOf& stateRay, const Eigen::Vector3d& target,
                            AperturePoint aperture, double stopRadiusMm) {
    constexpr int mostIterations = 100;
    constexpr double tolerance = 1e-9;
    SensorPoint sensor{{0.0, 0.0}};
    Eigen::Vector2d slope(0.0, 0.0);
    TwoStepResult result;
    while (result.iterations < mostIterations) {
        std::optional<StateRay> at = stateRay(sensor, slope);
        if (!at) return result;
        const Eigen::Vector2d apertureMiss = aperture.mm - at->stop.mm;
        slope += at->stop.bySlope.inverse() * apertureMiss;
        at = stateRay(sensor, slope);
        if (!at) return result;
        const Miss miss = missOf(at->exit, target);
        if (apertureMiss.norm() <= tolerance * stopRadiusMm &&
            miss.squared <= tolerance * tolerance) {
            result.sensor = sensor;
            return result;
        }
        sensor.mm += miss.sensorStep;
        if (!sensor.mm.allFinite() || !slope.allFinite()) return result;
        ++result.iterations;
    }
    return result;
}

}  // namespace etendue
