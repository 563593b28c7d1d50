// Rays that start at the stop, either way: what connect() searches. A ray is known by where it
// crosses the stop, a, and its slope there, p; with a fixed, p alone is sought, and only the
// elements in front of the stop decide where the ray goes in the scene.
#pragma once

#include "lens/phase_space.h"
#include "lens/sequential_trace.h"

namespace etendue {

template <class T>
LensRay<T> rayAtStop(const OpticalSystem& system, const PlaneState<T>& state) {
    return rayOf(state, system.surfaces[system.stop].vertexZMm);
}

/// Out into the scene, from the stop.
template <TraceMode mode, class T>
Passage leaveFront(const MonochromaticSystem& lens, LensRay<T>& ray) {
    return carryToScene<mode>(lens, 0, lens.system.stop, ray, [](auto...) {});
}

/// From the stop toward the sensor, as light would come from there; `ray`, whose direction points
/// to the scene, is carried behind the last surface, and turned.
template <TraceMode mode, class T>
Passage leaveRear(const MonochromaticSystem& lens, LensRay<T>& ray) {
    ray.direction = ray.direction * -1.0;
    return carryToSensor<mode>(lens, lens.system.stop + 1, lens.system.surfaces.size(), ray,
                               [](auto...) {});
}

}  // namespace etendue
