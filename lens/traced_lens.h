// TracedLens: a lens model that traces its prescription exactly. The ground truth of every fit, and
// a camera in its own right.
//
// Lens space: the origin at the vertex of the first surface (optical_system.h).
#pragma once

#include <limits>

#include "lens/connection.h"
#include "lens/paraxial.h"
#include "lens/phase_space.h"
#include "lens/sequential_trace.h"
#include "lens/stop_search.h"

namespace etendue {

/// What a photographer sets.
struct LensSettings {
    /// As stopRadiusForFNumber; empty: wide open, the stop's whole semi-aperture.
    std::optional<double> fNumber = {};
    Blades blades = {};
    /// From the sensor to the plane that is sharp at the d line in the paraxial limit.
    double focusDistanceMm = std::numeric_limits<double>::infinity();
};

/// What became of one ray.
struct TracedRay {
    Passage passage;
    LensRay<double> ray;       // after the last surface it met
    ApertureState aperture{};  // where it crossed the stop, if it came so far, as it left it
};

/// A TracedLens at one wavelength in 350–1100 nm. It refers to the lens, which must outlive it, and
/// saves looking up the indices for each of many rays.
class MonochromaticLens;

/// Wavelengths at which there is light.
inline bool isInRange(double wavelengthNm) {
    return wavelengthNm >= shortestWavelengthNm && wavelengthNm <= longestWavelengthNm;
}

class TracedLens final : public LensModel {
public:
    /// Throws InputError for a prescription with a fault, std::invalid_argument when the aperture
    /// is wider than the stop or the sensor not behind the last vertex.
    TracedLens(const Prescription& prescription, const Aperture& aperture, double sensorDistanceMm);

    /// Empty for a wavelength beyond 350–1100 nm, an aperture point outside the aperture, a ray
    /// that does not pass, and a folded one: where det ∂a/∂q or det ∂(exit direction)/∂s has turned
    /// negative. There one aperture point sees one direction in two sensor points, of which
    /// connect() could not give both; without folds there is one.
    std::optional<ExitRay> trace(SensorPoint sensor, AperturePoint aperture,
                                 double wavelengthNm) const override;
    void traceEach(SensorPoint sensor, AperturePoint aperture,
                   std::span<const double> wavelengthsNm,
                   std::span<std::optional<RayOrigin>> origins) const override;
    std::optional<SensorPoint> connect(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                       double wavelengthNm) const override;
    /// The derivatives are those of a ray that leaves within the search's tolerance of it.
    std::optional<Sighting> see(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                double wavelengthNm) const override;
    /// connect(), and how it went. outOfField says that the wavelength, the aperture point or the
    /// target is none for this lens, or that no ray that passes its rims comes near the target.
    Connection solve(const Eigen::Vector3d& targetMm, AperturePoint aperture, double wavelengthNm,
                     ConnectMethod method = ConnectMethod::newton) const;
    AperturePoint sampleAperture(Eigen::Vector2d u) const override;
    double apertureAreaMm2() const override { return system_.aperture.areaMm2(); }
    double reachMm() const override { return etendue::reachMm(system_); }

    /// Empty beyond 350–1100 nm.
    std::optional<MonochromaticLens> at(double wavelengthNm) const;

    const OpticalSystem& system() const { return system_; }
    double sensorZMm() const { return sensorZMm_; }
    /// At the d line.
    const StopMap& paraxialStopMap() const { return stopMap_; }
    /// The mean of x and y at the d line; negative for a lens that diverges.
    double focalLengthMm() const { return focalLengthMm_; }

private:
    friend class MonochromaticLens;

    /// Of connect(); empty for an aperture point or a target that is none, too.
    std::optional<StopSearch::Start> startOf(const Eigen::Vector3d& target,
                                             AperturePoint aperture) const;

    OpticalSystem system_;
    double sensorZMm_;
    StopMap stopMap_;
    double focalLengthMm_;  // the mean of x and y
    StopSearch stopSearch_;
};

class MonochromaticLens {
public:
    /// Throws std::invalid_argument beyond 350–1100 nm.
    MonochromaticLens(const TracedLens& lens, double wavelengthNm);

    /// From the sensor into the scene and from anywhere in front of the lens to the sensor, whose
    /// plane `ray` then ends on. Rims, stop and total reflection end a ray.
    TracedRay traceToScene(const SensorState& sensor) const;
    TracedRay traceToSensor(const LensRay<double>& ray) const;

    /// As TracedLens'.
    std::optional<ExitRay> trace(SensorPoint sensor, AperturePoint aperture) const;
    /// Of the ray that leaves as `leaving` does; empty when it is blocked, or folded.
    std::optional<RayOrigin> originOf(const ExitRay& leaving) const;
    std::optional<SensorPoint> connect(const Eigen::Vector3d& targetMm,
                                       AperturePoint aperture) const {
        return solve(targetMm, aperture).sensor;
    }
    Connection solve(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                     ConnectMethod method = ConnectMethod::newton) const;

    /// The ray through the centre of the stop, rims ignored.
    std::optional<ExitRay> chiefRay(SensorPoint sensor) const;

    /// The slope at which a ray must leave the sensor to cross the stop at `aperture`, rims
    /// ignored.
    std::optional<Eigen::Vector2d> slopeThrough(SensorPoint sensor, AperturePoint aperture) const;

    MonochromaticSystem system() const { return {lens_->system(), indices_, wavelengthNm_}; }

private:
    template <TraceMode mode>
    std::optional<ExitRay> exitRay(SensorPoint sensor, AperturePoint aperture) const;
    friend class TracedLens;

    Connection solveFrom(const StopSearch::Start& start, const Eigen::Vector3d& target,
                         AperturePoint aperture) const;
    /// Our search, and how it went; the connection's sensor point is not set.
    std::optional<Sighting> aim(const StopSearch::Start& start, const Eigen::Vector3d& target,
                                AperturePoint aperture, Connection& connection) const;
    Connection solveByTwoSteps(const Eigen::Vector3d& target, AperturePoint aperture) const;

    const TracedLens* lens_;
    std::vector<double> indices_;
    double wavelengthNm_;
};

/// Throws as the constructor does, and std::invalid_argument for an f-number or focus distance that
/// the lens cannot be set to.
std::unique_ptr<TracedLens> makeTracedLens(const Prescription& prescription,
                                           const LensSettings& settings = {});

}  // namespace etendue
