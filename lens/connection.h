// Connection: how the search for the sensor point that sees a target ended, for every lens that
// searches.
#pragma once

#include <optional>

#include "lens/lens_model.h"

namespace etendue {

enum class ConnectMethod {
    newton,  // in s, at a fixed aperture point (target_solver.h)
    twoStep  // the published one (two_step_newton.h)
};

enum class ConnectStatus {
    found,
    outOfField,  // no sensor point of the domain sees the target
    blocked,     // one does, but no light passes there, or the lens' map has turned over
    unsolved     // the search ended nowhere
};

struct Connection {
    ConnectStatus status = ConnectStatus::unsolved;
    std::optional<SensorPoint> sensor;  // when found
    int iterations = 0;                 // steps of Newton's method, those in vain included
};

}  // namespace etendue
