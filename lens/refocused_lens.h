// RefocusedLens: a fitted lens whose sensor has been moved back from where the fit has it, to focus
// nearer. The rays are the same; only where they meet the sensor changes.
#pragma once

#include "lens/polynomial_lens.h"

namespace etendue {

/// With q the slope at the sensor of the ray through s and a, the ray from the point s − δ q of a
/// sensor δ farther back is the ray from s. At a fixed aperture point that is a change of variables
/// in s, whose determinant goes into the throughput.
class RefocusedLens final : public LensModel {
public:
    /// Throws as PolynomialLens, and std::invalid_argument when the sensor's distance is outside
    /// the domain's focus range.
    RefocusedLens(const Prescription& prescription, const LensFit& fit, const Aperture& aperture,
                  double sensorDistanceMm);

    std::optional<ExitRay> trace(SensorPoint sensor, AperturePoint aperture,
                                 double wavelengthNm) const override;
    void traceEach(SensorPoint sensor, AperturePoint aperture,
                   std::span<const double> wavelengthsNm,
                   std::span<std::optional<RayOrigin>> origins) const override;
    std::optional<SensorPoint> connect(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                       double wavelengthNm) const override;
    AperturePoint sampleAperture(Eigen::Vector2d u) const override {
        return lens_.sampleAperture(u);
    }
    double apertureAreaMm2() const override { return lens_.apertureAreaMm2(); }
    double reachMm() const override { return lens_.reachMm(); }

private:
    /// The same ray on the moved sensor.
    struct Moved {
        Eigen::Vector2d mm;
        Eigen::Matrix2d byReference;  // derivative by the point on the fit's own sensor
    };
    Moved moved(const Eigen::Vector2d& reference, AperturePoint aperture,
                double wavelengthNm) const;
    /// A point on the fit's own sensor, and what it is on the moved one.
    struct Reference {
        SensorPoint sensor;
        Moved moved;
    };
    /// That of the ray from `sensor`.
    std::optional<Reference> referenceOf(SensorPoint sensor, AperturePoint aperture,
                                         double wavelengthNm) const;
    /// From the derivatives by the fit's own sensor to those by the moved one. Empty where rays
    /// have crossed.
    static std::optional<ExitRay> byMovedSensor(ExitRay ray, const Moved& at);

    PolynomialLens lens_;
    std::optional<PolynomialEvaluator<double>> slope_;
    double shiftMm_;
};

}  // namespace etendue
