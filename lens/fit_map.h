// Where in field and aperture a fitted lens departs from the exact one.
#pragma once

#include <vector>

#include "lens/lens_model.h"

namespace etendue {

/// A grid of field heights (columns) and aperture points (rows), both along the same line.
struct FitMap {
    int fields = 0, apertures = 0;
    std::vector<double> heightsMm, aperturesMm;  // centres of columns and rows
    std::vector<double> directionMrad;           // row by row; of the outgoing ray in space
    // Where only one of the lenses lets the ray pass, the error is not a number, as it is where
    // neither does:
    std::vector<bool> isWronglyAccepted, isWronglyBlocked;

    std::size_t index(int aperture, int field) const {
        return static_cast<std::size_t>(aperture * fields + field);
    }
};

/// Heights from 0 to `highestMm`, aperture points from −`apertureRadiusMm` to it.
FitMap fitMap(const LensModel& exact, const LensModel& fitted, const Eigen::Vector2d& along,
              double highestMm, double apertureRadiusMm, double wavelengthNm, int fields,
              int apertures);

}  // namespace etendue
