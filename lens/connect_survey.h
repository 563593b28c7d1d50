// How well connect() finds what trace() has produced, over the field.
#pragma once

#include <span>
#include <vector>

#include "lens/polynomial_lens.h"

namespace etendue {

/// Of all rays that start at one distance from the middle of the sensor.
struct ConnectRing {
    double lowMm, highMm;       // of the distance
    double fieldDegrees = 0.0;  // mean angle of the rays in the scene from the axis
    int rays = 0;
    int failures = 0;     // nothing was found, though the ray exists
    int otherPoints = 0;  // a sensor point was found from which a ray meets the target, not this
    double meanIterations = 0.0;
    int mostIterations = 0;
};

/// `raysPerRing` rays of the fitted lens itself in each of `rings` rings of equal width: sensor,
/// aperture and wavelength uniform over the fit's domain, the targets at each of `distancesMm`
/// along the ray in turn. Deterministic.
std::vector<ConnectRing> connectSurvey(const PolynomialLens& lens, ConnectMethod method,
                                       std::span<const double> distancesMm, int rings,
                                       int raysPerRing);

}  // namespace etendue
