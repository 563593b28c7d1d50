// Why a picture darkens toward its edge.
#pragma once

#include <vector>

#include "lens/traced_lens.h"

namespace etendue {

/// Each relative to the axis; total = cosFourth × vignetting × rest.
struct Illumination {
    double heightMm;
    double total;       // as relativeIllumination (field.h)
    double cosFourth;   // of the chief ray's angle at the sensor; not a number without such a ray
    double vignetting;  // the share of the aperture's area through which light passes
    double rest;        // the exit pupil's apparent size, and the glass' transmittance
};

/// At `count` heights from the axis to `highestMm` along the unit vector `along`, at the d line, by
/// so many aperture points.
std::vector<Illumination> illuminationCurve(const TracedLens& lens, const Eigen::Vector2d& along,
                                            double highestMm, int count, int apertures = 1000);

}  // namespace etendue
