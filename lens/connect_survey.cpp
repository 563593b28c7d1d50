#include "lens/connect_survey.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {

namespace {

/// A search that ends farther than this from where the ray started has found another ray.
constexpr double sameMm = 1e-4;

void count(ConnectRing& ring, const Connection& connection, SensorPoint sensor) {
    ++ring.rays;
    ring.meanIterations += connection.iterations;  // their sum, for now
    ring.mostIterations = std::max(ring.mostIterations, connection.iterations);
    if (connection.status != ConnectStatus::found || !connection.sensor)
        ++ring.failures;
    else if ((connection.sensor->mm - sensor.mm).norm() > sameMm)
        ++ring.otherPoints;
}

}  // namespace

std::vector<ConnectRing> connectSurvey(const PolynomialLens& lens, ConnectMethod method,
                                       std::span<const double> distancesMm, int rings,
                                       int raysPerRing) {
    constexpr std::uint64_t seed = 5;
    constexpr int mostDrawn = 200;  // for each ray wanted: a ring may be dark
    const FitDomain& domain = lens.domain();
    const double highest = std::min(domain.sensorHalfSizeMm.norm(), domain.imageRadiusMm);
    std::vector<ConnectRing> result;
    for (int i = 0; i < rings; ++i)
        result.push_back({highest * i / rings, highest * (i + 1) / rings});
    const std::size_t enough =
        static_cast<std::size_t>(rings) * static_cast<std::size_t>(raysPerRing);
    std::size_t counted = 0;
    for (std::uint64_t index = 0; counted < enough && index < mostDrawn * enough; ++index) {
        const FitQuery query = drawQuery(domain, seed, index);
        const double height = query.sensor.mm.norm();
        const int number = std::min(static_cast<int>(height / highest * rings), rings - 1);
        ConnectRing& ring = result[static_cast<std::size_t>(number)];
        if (ring.rays >= raysPerRing) continue;
        const auto ray = lens.trace(query.sensor, query.aperture, query.wavelengthNm);
        if (!ray) continue;
        const double distance =
            distancesMm[static_cast<std::size_t>(ring.rays) % distancesMm.size()];
        const Eigen::Vector3d target = ray->origin + distance * ray->direction;
        const Eigen::Vector3d& d = ray->direction;
        ring.fieldDegrees += std::atan2(std::hypot(d.x(), d.y()), d.z());
        count(ring, lens.solve(target, query.aperture, query.wavelengthNm, method), query.sensor);
        ++counted;
    }
    for (ConnectRing& ring : result) {
        if (ring.rays == 0) continue;
        ring.fieldDegrees *= 180.0 / std::numbers::pi / ring.rays;
        ring.meanIterations /= ring.rays;
    }
    return result;
}

}  // namespace etendue
