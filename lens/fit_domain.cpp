#include "lens/fit_domain.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lens/field.h"

namespace etendue {

namespace {

/// Room for the rays of a sensor that is moved back to focus as near as `nearestFocusMm`: those
/// from a corner to the exit pupil's edges.
void extendToNear(FitDomain& domain, const TracedLens& lens, double nearestFocusMm) {
    const ParaxialData data = paraxialData(lens.system());
    const double travel = sensorDistanceMm(data, nearestFocusMm) - domain.sensorDistanceMm;
    if (!(travel >= 0.0))
        throw std::invalid_argument("lens fit: the nearest focus is beyond the farthest");
    domain.sensorTravelMm = travel;
    // The slopes of a cone: also of one whose exit pupil is infinitely far and large.
    const Eigen::Vector2d slopes =
        domain.apertureRadiusMm * lens.paraxialStopMap().bySlope.cwiseAbs().cwiseInverse();
    domain.sensorHalfSizeMm += travel * slopes;
}

}  // namespace

FitDomain fitDomain(const Prescription& prescription, const DomainRequest& request) {
    constexpr double darkest = 1e-3;  // share of the illumination on the axis
    const auto demand = [](bool fulfilled, const char* what) {
        if (!fulfilled) throw std::invalid_argument(what);
    };
    demand(request.sensorSizeMm.allFinite() && request.sensorSizeMm.minCoeff() > 0.0,
           "lens fit: the sensor must have a positive size");
    demand(request.shortestWavelengthNm <= request.longestWavelengthNm &&
               request.shortestWavelengthNm >= shortestWavelengthNm &&
               request.longestWavelengthNm <= longestWavelengthNm,
           "lens fit: wavelengths must be within 350–1100 nm, the shortest first");
    const auto lens = makeTracedLens(prescription, {request.fNumber, {}, request.focusDistanceMm});
    FitDomain domain{};
    domain.sensorHalfSizeMm = 0.5 * request.sensorSizeMm;
    domain.sensorDistanceMm = -lens->sensorZMm() - lengthMm(prescription);
    domain.apertureRadiusMm = lens->system().aperture.radiusMm();
    domain.shortestWavelengthNm = request.shortestWavelengthNm;
    domain.longestWavelengthNm = request.longestWavelengthNm;
    if (request.nearestFocusMm) extendToNear(domain, *lens, *request.nearestFocusMm);
    const double reach = std::max(imageHeightMm(*lens, Eigen::Vector2d::UnitX(), darkest),
                                  imageHeightMm(*lens, Eigen::Vector2d::UnitY(), darkest));
    demand(reach > 0.0,
           "lens fit: no light reaches the axis through the aperture, sampled 12 × 12");
    if (reach < domain.sensorHalfSizeMm.norm()) domain.imageRadiusMm = reach;
    return domain;
}

}  // namespace etendue
