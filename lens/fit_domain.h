// What a scene asks of a lens, as the domain of a fit: no more than it needs.
#pragma once

#include "lens/fit_rays.h"

namespace etendue {

struct DomainRequest {
    Eigen::Vector2d sensorSizeMm = {36.0, 24.0};
    double focusDistanceMm = std::numeric_limits<double>::infinity();  // from the sensor; farthest
    std::optional<double> fNumber = {};  // the widest; empty: wide open
    double shortestWavelengthNm = 400.0, longestWavelengthNm = 700.0;
    std::optional<double> nearestFocusMm = {};  // for a lens that is to be refocused
};

/// Of a focus range the domain's sensor is that of the farthest focus, made larger by what the
/// cones of light of a sensor moved back spread over on it.
/// A sensor that reaches beyond the lens' picture is cut to the disc where there is a picture:
/// where the illumination, by 12 × 12 points of the aperture, is at least 1/1000 of that on the
/// axis. A beam narrower than the points are apart may fall between them. Throws
/// std::invalid_argument for a request that no lens can meet, or not this one.
FitDomain fitDomain(const Prescription& prescription, const DomainRequest& request);

}  // namespace etendue
