// The rays that a lens is fitted to: drawn in the fit's domain, traced exactly.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "lens/traced_lens.h"

namespace etendue {

/// Where a fit holds. Outside it there is no ray.
struct FitDomain {
    Eigen::Vector2d sensorHalfSizeMm;
    double imageRadiusMm = std::numeric_limits<double>::infinity();  // the sensor, cut to a disc
    double sensorDistanceMm;                                         // behind the last vertex
    double apertureRadiusMm;                                         // the widest
    double shortestWavelengthNm = 400.0, longestWavelengthNm = 700.0;
    double sensorTravelMm = 0.0;  // how much farther back it may be moved (refocused_lens.h)

    bool operator==(const FitDomain&) const = default;
    /// Its rims included.
    bool contains(SensorPoint sensor, AperturePoint aperture, double wavelengthNm) const {
        return std::abs(sensor.mm.x()) <= sensorHalfSizeMm.x() &&
               std::abs(sensor.mm.y()) <= sensorHalfSizeMm.y() &&
               sensor.mm.norm() <= imageRadiusMm && aperture.mm.norm() <= apertureRadiusMm &&
               wavelengthNm >= shortestWavelengthNm && wavelengthNm <= longestWavelengthNm;
    }
};

/// The lens with its stop and sensor as the domain has them.
TracedLens lensOf(const Prescription& prescription, const FitDomain& domain);

/// A question to the lens.
struct FitQuery {
    SensorPoint sensor;
    AperturePoint aperture;
    double wavelengthNm;
};

/// Number `index` of the queries uniform over sensor, aperture and wavelength. Different seeds give
/// independent ones.
FitQuery drawQuery(const FitDomain& domain, std::uint64_t seed, std::uint64_t index);

/// One ray that passes, at the sensor, the stop and the pupil sphere.
struct FitRay {
    FitQuery query;
    Eigen::Vector2d slope;          // at the sensor
    Eigen::Vector2d apertureSlope;  // at the stop
    PupilState<double> pupil;
    Eigen::Vector3d direction;                      // lens space
    Eigen::Matrix<double, 3, 2> directionBySensor;  // 1/mm, aperture point held fixed
    double transmittance = 0.0;                     // τ
    double throughput = 0.0;                        // J τ of equation (1), per mm²
};

/// What became of the rays drawn.
struct RayCounts {
    std::int64_t drawn = 0, passed = 0;
    std::int64_t blocked = 0;      // by a rim or by total reflection, or the line misses a surface
    std::int64_t folded = 0;       // the lens' map has turned over there, as in TracedLens::trace
    std::int64_t unsolved = 0;     // no slope is found that leads to the aperture point
    std::int64_t besidePupil = 0;  // leaves the lens, but passes the pupil sphere by
    double foldedLight = 0.0;      // share of τ of the rays that no rim blocks
};

struct FitRays {
    std::vector<FitRay> rays;
    RayCounts counts;
};

/// The first `count` queries of the seed whose rays pass; fewer when hardly one in 1000 does. The
/// same for any number of threads.
FitRays drawFitRays(const TracedLens& lens, const FitDomain& domain, std::size_t count,
                    std::uint64_t seed);

}  // namespace etendue
