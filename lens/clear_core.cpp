#include "lens/clear_core.h"

#include <cmath>
#include <numbers>

namespace etendue {

namespace {

/// Squared heights bend little from one point of the grid to the next.
constexpr double highest = 0.95;
constexpr int radii = 16, angles = 16;  // of the grid on the aperture
constexpr double turn = 2.0 * std::numbers::pi / angles;

Eigen::Vector2d polar(double radius, double angle) {
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace

ClearCore::ClearCore(const ClipFit& clip, const ValueEvaluator& squares, const FitDomain& domain) {
    const double reachMm = std::min(domain.sensorHalfSizeMm.norm(), domain.imageRadiusMm);
    ringsPerSquaredMm_ = static_cast<double>(rings) / (reachMm * reachMm);
    // Round an axis the sensor point may be turned about it together with the aperture point;
    // between mirror planes all quarters of the sensor are alike.
    const PolynomialBasis basis = clip.squares.basis;
    const int directions = basis == PolynomialBasis::axial      ? 1
                           : basis == PolynomialBasis::twoPlane ? 5
                                                                : 16;
    const auto isClear = [&](double sensorRadiusMm, double apertureRadiusMm) {
        for (int i = 0; i < directions; ++i)
            for (int j = 0; j < angles; ++j)
                for (const double share : {0.0, 0.5, 1.0}) {
                    const PolynomialValues<double> at = squares.values(
                        {polar(sensorRadiusMm, turn * i), polar(apertureRadiusMm, turn * j),
                         std::lerp(domain.shortestWavelengthNm, domain.longestWavelengthNm,
                                   share)});
                    if (!(highestSquare({at.data(), clip.count()}) <= highest)) return false;
                }
        return true;
    };
    // The largest radius on the aperture up to which all are clear, or −1.
    const auto clearRadiusMm = [&](double sensorRadiusMm) {
        double clearMm = -1.0;
        for (int i = 0; i <= radii; ++i) {
            const double radiusMm = domain.apertureRadiusMm * i / radii;
            if (!isClear(sensorRadiusMm, radiusMm)) break;
            clearMm = radiusMm;
        }
        return clearMm;
    };
    double innerMm = clearRadiusMm(0.0);
    for (std::size_t ring = 0; ring < rings; ++ring) {
        const double outerMm =
            clearRadiusMm(std::sqrt(static_cast<double>(ring + 1) / ringsPerSquaredMm_));
        const double clearMm = std::min(innerMm, outerMm);
        squaredRadiiMm2_[ring] = clearMm < 0.0 ? -1.0 : clearMm * clearMm;
        innerMm = outerMm;
    }
}

}  // namespace etendue
