// The beam that a lens takes in from infinity along its axis, by exact tracing at the d line: what
// its f-number is about.
#pragma once

#include <cstddef>

#include "lens/optical_system.h"

namespace etendue {

/// The widest beam that passes every rim.
struct AxialBeam {
    double radiusXMm = 0.0, radiusYMm = 0.0;  // in front of the lens
    std::size_t limitingSurface = 0;          // in y
};
AxialBeam widestAxialBeam(const OpticalSystem& system);

/// The stop radius that the rim of the axial beam of radius f/(2 fNumber) touches; the geometric
/// mean of x and y in an anamorphic lens. Equal to the paraxial one when small. A little more than
/// the stop's semi-aperture, by statedFNumberTolerance, counts as that. Throws
/// std::invalid_argument when the lens does not open so far.
double stopRadiusForFNumber(const OpticalSystem& system, double fNumber);

}  // namespace etendue
