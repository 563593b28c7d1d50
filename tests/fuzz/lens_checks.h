// What a lens model must answer, whatever lens it is.
#pragma once

#include <cmath>

#include "lens/lens_model.h"
#include "tests/fuzz/fuzz_support.h"

namespace etendue {

inline void checkRay(const ExitRay& ray) {
    require(ray.origin.allFinite(), "a traced ray starts nowhere");
    require(std::abs(ray.direction.norm() - 1.0) < 1e-6, "a traced ray's direction is no unit");
    require(ray.originBySensor.allFinite() && ray.directionBySensor.allFinite(),
            "a traced ray's derivatives are not finite");
    require(std::isfinite(ray.throughput) && ray.throughput >= 0.0,
            "a traced ray's throughput is negative or not finite");
}

/// 100 rays from sensor points up to `halfSizeMm` from the axis: each is either none or finite, as
/// is what connect() says of a target on it.
inline void checkRays(const LensModel& lens, const Eigen::Vector2d& halfSizeMm, double shortestNm,
                      double longestNm) {
    for (int i = 0; i < 100; ++i) {
        const SensorPoint sensor{{halfSizeMm.x() * (2.0 * evenly(i, 0) - 1.0),
                                  halfSizeMm.y() * (2.0 * evenly(i, 1) - 1.0)}};
        const AperturePoint aperture = lens.sampleAperture({evenly(i, 2), evenly(i, 3)});
        require(aperture.mm.allFinite(), "a point of the aperture is not finite");
        const double nm = shortestNm + (longestNm - shortestNm) * evenly(i, 4);
        const auto ray = lens.trace(sensor, aperture, nm);
        if (!ray) continue;
        checkRay(*ray);
        const double distanceMm = 10.0 + 1e4 * evenly(i, 4);
        const auto sight = lens.see(ray->origin + distanceMm * ray->direction, aperture, nm);
        if (!sight) continue;
        require(sight->sensor.mm.allFinite(), "a connection's sensor point is not finite");
        checkRay(sight->ray);
    }
}

}  // namespace etendue
