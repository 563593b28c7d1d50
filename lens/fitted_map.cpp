#include "lens/fitted_map.h"

#include "lens/density.h"

namespace etendue {

namespace {

using PupilDerivatives = Eigen::Matrix<double, 4, 2>;

/// ∂(x, y, directionX, directionY) by the inputs `column` and `column + 1`, or the stop's x and y.
template <int Rows>
Eigen::Matrix<double, Rows, 2> block(const PolynomialResult<double>& result, std::size_t column) {
    Eigen::Matrix<double, Rows, 2> derivatives;
    for (std::size_t row = 0; row < Rows; ++row)
        derivatives.row(static_cast<Eigen::Index>(row)) << result.jacobian[row][column],
            result.jacobian[row][column + 1];
    return derivatives;
}

/// Of the values of the exit polynomials.
PupilState<double> pupilOf(const PolynomialValues<double>& values) {
    return {values[0], values[1], values[2], values[3]};
}

std::optional<ExitRay> exitRayOf(const PupilSphere& sphere, const PupilState<double>& pupil,
                                 const PupilDerivatives& bySensor, double throughput) {
    const auto ray = sphere.ray(pupil, bySensor);
    if (!ray) return {};
    return ExitRay{ray->origin, ray->direction, ray->originDerivatives, ray->directionDerivatives,
                   throughput};
}

}  // namespace

FittedMap::FittedMap(const Prescription& prescription, const LensFit& fit)
    : sphere_(OpticalSystem(prescription)), exit_(fit.exit) {
    const OpticalSystem system(prescription);
    paraxialStopMap_ = stopMap(system, fit.domain.sensorDistanceMm);
    stopRadiusMm_ = system.surfaces[system.stop].semiApertureMm;
    if (fit.settings.form == FitForm::sensorState) apertureMap_.emplace(fit.aperture);
}

std::optional<ExitRay> FittedMap::exitRay(SensorPoint sensor, AperturePoint aperture,
                                          double wavelengthNm) const {
    if (apertureMap_) {
        const std::optional<PupilRay> mapped = sensorStateRay(sensor, aperture, wavelengthNm);
        return mapped ? exitRay(*mapped) : std::nullopt;
    }
    std::optional<ExitRay> ray = twoPointRay({sensor.mm, aperture.mm, wavelengthNm});
    if (ray && !(ray->throughput > 0.0)) ray.reset();
    return ray;
}

std::optional<PupilRay> FittedMap::pupilRay(SensorPoint sensor, AperturePoint aperture,
                                            double wavelengthNm) const {
    if (apertureMap_) return sensorStateRay(sensor, aperture, wavelengthNm);
    const PolynomialResult<double> at = exit_.evaluate({sensor.mm, aperture.mm, wavelengthNm});
    PupilRay mapped{pupilOf(at.values), {}, at.values[4]};
    mapped.bySensorAndAperture << block<4>(at, 0), block<4>(at, 2);
    return mapped;
}

std::optional<PupilState<double>> FittedMap::pupilState(SensorPoint sensor, AperturePoint aperture,
                                                        double wavelengthNm) const {
    if (!apertureMap_) return pupilOf(exit_.values({sensor.mm, aperture.mm, wavelengthNm}));
    const std::optional<PupilRay> mapped = sensorStateRay(sensor, aperture, wavelengthNm);
    if (!mapped) return {};
    return mapped->pupil;
}

std::optional<ExitRay> FittedMap::exitRay(const PupilRay& mapped) const {
    if (!(mapped.throughput > 0.0)) return {};
    return exitRayOf(sphere_, mapped.pupil, mapped.bySensorAndAperture.leftCols<2>(),
                     mapped.throughput);
}

double FittedMap::etendue(const PupilRay& mapped) const {
    return etendueDeterminant(mapped.bySensorAndAperture, 1.0, mapped.pupil, sphere_);
}

std::optional<ExitRay> FittedMap::twoPointRay(const PolynomialInput& input) const {
    const PolynomialBySensor<double> at = exit_.evaluateBySensor(input);
    PupilDerivatives bySensor;
    for (std::size_t row = 0; row < 4; ++row)
        bySensor.row(static_cast<Eigen::Index>(row)) << at.bySensor[row][0], at.bySensor[row][1];
    return exitRayOf(sphere_, pupilOf(at.values), bySensor, at.values[4]);
}

std::optional<StateRay> FittedMap::stateRay(SensorPoint sensor, const Eigen::Vector2d& slope,
                                            double wavelengthNm) const {
    const PolynomialInput input{sensor.mm, slope, wavelengthNm};
    const PolynomialResult<double> stop = apertureMap_->evaluate(input), at = exit_.evaluate(input);
    const auto exit = exitRayOf(sphere_, pupilOf(at.values), block<4>(at, 0), at.values[4]);
    if (!exit) return {};
    return StateRay{{{stop.values[0], stop.values[1]}, block<2>(stop, 2)}, *exit};
}

std::optional<PupilRay> FittedMap::sensorStateRay(SensorPoint sensor, AperturePoint aperture,
                                                  double wavelengthNm) const {
    const auto hit = [&](const Eigen::Vector2d& slope) {
        const auto at = apertureMap_->evaluate({sensor.mm, slope, wavelengthNm});
        return std::optional(StopHit{{at.values[0], at.values[1]}, block<2>(at, 2)});
    };
    const auto slope =
        solveSlope(hit, paraxialSlope(paraxialStopMap_, sensor, aperture), aperture, stopRadiusMm_);
    if (!slope) return {};
    const PolynomialInput input{sensor.mm, *slope, wavelengthNm};
    const PolynomialResult<double> stop = apertureMap_->evaluate(input), at = exit_.evaluate(input);
    const Eigen::Matrix2d bySlope = block<2>(stop, 2);
    const Eigen::Vector2d& paraxial = paraxialStopMap_.bySlope;
    if (!(bySlope.determinant() * paraxial.x() * paraxial.y() > 0.0)) return {};
    const Eigen::Matrix2d k = slopeBySensor(bySlope, block<2>(stop, 0));
    PupilRay mapped{pupilOf(at.values), {}, exchangeJacobian(*slope, bySlope) * at.values[4]};
    mapped.bySensorAndAperture << block<4>(at, 0) + block<4>(at, 2) * k,
        block<4>(at, 2) * bySlope.inverse();
    return mapped;
}

}  // namespace etendue
