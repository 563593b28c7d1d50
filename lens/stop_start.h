// StopStart: a first guess of the slope at the stop with which a ray through an aperture point
// meets a target, for the search to start from. The same for every wavelength.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lens/lens_model.h"
#include "lens/sequential_trace.h"

namespace etendue {

/// Of a lens of revolution: from traced rays through the stop's centre, over the field, and from
/// how those of the same direction through points beside it differ to first order. Of any other
/// lens: paraxial.
class StopStart {
public:
    /// `lens` at the d line. `steepest`: the largest slope at the stop worth a row.
    StopStart(const MonochromaticSystem& lens, bool isAxial, double steepest);

    struct Guess {
        Eigen::Vector2d slope;  // huge or not a number far out of the field
        double beyond;          // radians, about: past the widest of the rays traced
    };
    Guess guess(const Eigen::Vector3d& targetMm, AperturePoint aperture) const;

private:
    /// About the rays of one direction. In the plane of axis and direction it is (sine, cosine);
    /// lengths are measured across it, first in that plane toward larger fields, then sideways.
    struct Row {
        double sine, cosine;
        double asideMm;  // of the ray through the stop's centre from the first vertex, in the plane
        double slope;    // of that ray at the stop, toward larger fields
        Eigen::Vector2d slopePerMm, asidePerMm;  // of the aperture point
    };
    static std::optional<Row> traced(const MonochromaticSystem& lens, double slope);
    /// The rows beside the ray through the stop's centre that meets a target `farMm` from the axis
    /// at z, and where between them that is; beyond the last row, more than 1.
    struct Place {
        const Row &low, &high;
        double share;
    };
    Place placeOf(double farMm, double zMm) const;

    std::vector<Row> rows_;       // over fields at about even distances; empty: paraxial
    double lastRowsApart_ = 0.0;  // radians
    // Of the ray's position at z = 0 and of its slope in the scene, by a and by p; x and y.
    Eigen::Vector2d positionByAperture_{0.0, 0.0}, positionBySlope_{0.0, 0.0};
    Eigen::Vector2d slopeByAperture_{0.0, 0.0}, slopeBySlope_{0.0, 0.0};
};

}  // namespace etendue
