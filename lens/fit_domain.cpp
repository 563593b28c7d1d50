#include "lens/fit_domain.h"

#include <algorithm>
#include <stdexcept>

#include "lens/field.h"

namespace etendue {

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
    const double reach = std::max(imageHeightMm(*lens, Eigen::Vector2d::UnitX(), darkest),
                                  imageHeightMm(*lens, Eigen::Vector2d::UnitY(), darkest));
    if (reach < domain.sensorHalfSizeMm.norm()) domain.imageRadiusMm = reach;
    return domain;
}

}  // namespace etendue
