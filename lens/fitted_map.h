// FittedMap: the map E(s, a, λ) → exit ray of a fit, in either form of FitForm. It answers wherever
// its polynomials give a ray; domain and rims are for its user to mind.
#pragma once

#include "lens/lens_fit.h"
#include "lens/polynomial.h"
#include "lens/two_step_newton.h"

namespace etendue {

/// A ray where it leaves the lens, with all that the map says of it.
struct PupilRay {
    PupilState<double> pupil;
    Eigen::Matrix4d bySensorAndAperture;  // derivatives of (x, y, directionX, directionY)
    double throughput;
};

class FittedMap {
public:
    /// The fit is of that prescription.
    FittedMap(const Prescription& prescription, const LensFit& fit);

    /// Empty where the polynomials give no ray, no light, or no slope that leads to the aperture
    /// point; in the sensor-state form also where det ∂a/∂q has changed its sign.
    std::optional<ExitRay> exitRay(SensorPoint sensor, AperturePoint aperture,
                                   double wavelengthNm) const;

    /// The same on the pupil sphere, where nothing has been made of it yet.
    std::optional<PupilRay> pupilRay(SensorPoint sensor, AperturePoint aperture,
                                     double wavelengthNm) const;
    /// …its place and direction alone, at less than half the cost in the two-point form.
    std::optional<PupilState<double>> pupilState(SensorPoint sensor, AperturePoint aperture,
                                                 double wavelengthNm) const;
    std::optional<ExitRay> exitRay(const PupilRay& mapped) const;
    /// Of the rays that leave, per area of the sensor and of the aperture, 1/mm²: an exact lens has
    /// the J of equation (1).
    double etendue(const PupilRay& mapped) const;

    /// The sensor-state form's own question. Empty where the polynomials give no ray.
    std::optional<StateRay> stateRay(SensorPoint sensor, const Eigen::Vector2d& slope,
                                     double wavelengthNm) const;

    FitForm form() const { return apertureMap_ ? FitForm::sensorState : FitForm::twoPoint; }

private:
    std::optional<ExitRay> twoPointRay(const PolynomialInput& input) const;
    std::optional<PupilRay> sensorStateRay(SensorPoint sensor, AperturePoint aperture,
                                           double wavelengthNm) const;

    PupilSphere sphere_;
    PolynomialEvaluator<double> exit_;
    std::optional<PolynomialEvaluator<double>> apertureMap_;  // sensorState only
    StopMap paraxialStopMap_;
    double stopRadiusMm_;
};

}  // namespace etendue
