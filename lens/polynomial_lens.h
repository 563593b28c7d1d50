// PolynomialLens: a lens model made of fitted polynomials, in either form of FitForm. It is asked
// exactly what a TracedLens is, and answers within the fit's errors.
//
// Lens space: the origin at the vertex of the first surface (optical_system.h).
#pragma once

#include "lens/clear_core.h"
#include "lens/connection.h"
#include "lens/fitted_map.h"
#include "lens/polynomial_products.h"
#include "lens/target_solver.h"

namespace etendue {

class PolynomialLens final : public LensModel {
public:
    /// Throws std::invalid_argument when the fit is of another prescription, or the aperture wider
    /// than its domain.
    PolynomialLens(const Prescription& prescription, const LensFit& fit, const Aperture& aperture);

    /// Empty outside the fit's domain and outside the aperture, where a rim blocks the ray, where
    /// the polynomials give no ray or no light, and where the fitted map has turned over, as in
    /// TracedLens::trace.
    std::optional<ExitRay> trace(SensorPoint sensor, AperturePoint aperture,
                                 double wavelengthNm) const override;
    /// Newton's method on where the ray leaves and how, in sensor and aperture point at once, to
    /// sightToleranceRadians, of the direction and of the focal length. Étendue is that of the
    /// fitted map itself, which keeps it within the fit's errors.
    void traceEach(SensorPoint sensor, AperturePoint aperture,
                   std::span<const double> wavelengthsNm,
                   std::span<std::optional<RayOrigin>> origins) const override;
    /// By ConnectMethod::newton, from the fit's own first guess (sensor_fits.h).
    std::optional<SensorPoint> connect(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                       double wavelengthNm) const override;
    /// As fine as connect() where the ray goes; its derivatives and throughput are those of a ray
    /// that leaves within sightToleranceRadians of it. First guesses mostly do: one evaluation.
    std::optional<Sighting> see(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                double wavelengthNm) const override;
    /// The first wavelength's guess decides for all whether there is anything to see.
    void seeEach(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                 std::span<const double> wavelengthsNm,
                 std::span<std::optional<Sighting>> sightings) const override;
    bool finds(SensorPoint sensor, const Eigen::Vector3d& targetMm, AperturePoint aperture,
               double wavelengthNm, double toleranceMm) const override;
    AperturePoint sampleAperture(Eigen::Vector2d u) const override;
    double apertureAreaMm2() const override { return aperture_.areaMm2(); }
    double reachMm() const override { return reachMm_; }

    /// connect(), and how it went.
    Connection solve(const Eigen::Vector3d& targetMm, AperturePoint aperture, double wavelengthNm,
                     ConnectMethod method = ConnectMethod::newton) const;

    const FitDomain& domain() const { return domain_; }

private:
    struct Guess {
        /// Unless this is `found`, no sensor point sees the target, and a search would fail slowly.
        ConnectStatus status;
        Eigen::Vector2d sensorMm;  // on the sensor, where passesRims was asked
        bool passesRims;  // so clearly that a ray from near it does, too; false says nothing
        Eigen::Vector2d beginMm;  // where the search begins, of one wavelength
    };
    /// What the fit guesses without a search, be it on the sensor or not.
    Eigen::Vector2d sensorAt(const TargetSight& sight, AperturePoint aperture,
                             double wavelengthNm) const;
    bool isFarOff(const Eigen::Vector2d& guess) const;
    Eigen::Vector2d clampedToSensor(const Eigen::Vector2d& guess) const;
    /// Where a search begins that has such a guess: there, unless it is far off the sensor.
    Eigen::Vector2d beginAt(const Eigen::Vector2d& guess) const;
    Guess firstGuess(const TargetSight& sight, AperturePoint aperture, double wavelengthNm) const;
    /// The largest of the clip polynomials, or NaN if one is: unless it is at most 1 a rim blocks
    /// the ray.
    double highestSquare(SensorPoint sensor, AperturePoint aperture, double wavelengthNm) const;
    bool passesRims(SensorPoint sensor, AperturePoint aperture, double wavelengthNm) const {
        return clear_.contains(sensor, aperture) ||
               highestSquare(sensor, aperture, wavelengthNm) <= 1.0;
    }
    /// Rims apart.
    ConnectStatus statusOf(SensorPoint sensor, const ExitRay& ray, AperturePoint aperture,
                           double wavelengthNm) const;
    /// …and rims, too.
    bool passes(SensorPoint sensor, const ExitRay& ray, AperturePoint aperture,
                double wavelengthNm) const;
    /// A little beyond the domain, for searches to overshoot; far beyond it powers overflow.
    static constexpr double searchMargin = 1.2;
    bool isNearSensor(const Eigen::Vector2d& sensorMm) const;
    /// What trace() makes of it, unless rims or aperture block it.
    std::optional<RayOrigin> originOf(const PupilRay& mapped, SensorPoint sensor,
                                      AperturePoint aperture, double wavelengthNm) const;
    /// How a ray leaves, and how sensor and aperture point move with that at its own wavelength.
    struct Leaving {
        PupilState<double> pupil;
        Eigen::Matrix4d byPupil;
    };
    /// Where such a ray comes from at another wavelength, sought from the sensor and aperture point
    /// `at` on.
    std::optional<RayOrigin> originNear(Eigen::Vector4d at, const Leaving& leaving,
                                        double wavelengthNm) const;
    /// So near that a search from the guess ends there. Test: "PolynomialLens: what is said to be
    /// found again is what the search finds".
    bool isNear(const Eigen::Vector2d& guess, const Eigen::Vector2d& sensor) const;
    bool canSee(const Eigen::Vector3d& targetMm, AperturePoint aperture, double wavelengthNm) const;
    /// The end of our search from a guess, and how it went; the connection's own sensor point is
    /// not set.
    std::optional<Aimed> aim(const Eigen::Vector3d& target, AperturePoint aperture,
                             double wavelengthNm, const Guess& guess, double toleranceRadians,
                             Connection& connection) const;
    Connection solveByNewton(const Eigen::Vector3d& target, AperturePoint aperture,
                             double wavelengthNm) const;
    Connection solveByTwoSteps(const Eigen::Vector3d& target, AperturePoint aperture,
                               double wavelengthNm) const;

    FittedMap map_;
    FitDomain domain_;
    Aperture aperture_;
    ValueEvaluator clip_;
    std::size_t clipCount_;
    ClearCore clear_;
    EntrancePupil pupil_;
    ValueEvaluator start_;  // connectStart_.sensor
    ConnectStart connectStart_;
    double focalLengthMm_, reachMm_;
};

}  // namespace etendue
