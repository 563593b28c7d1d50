// ClearCore: the middle of a lens, where rays pass so far from all rims that none has to be asked.
#pragma once

#include <algorithm>
#include <array>

#include "lens/lens_clip.h"
#include "lens/polynomial_products.h"

namespace etendue {

/// For rings of the sensor about the axis the radius on the aperture up to which the clip
/// polynomials, looked at on a grid, stay below 1 by a margin: what they would let through, told by
/// one comparison.
class ClearCore {
public:
    ClearCore(const ClipFit& clip, const ValueEvaluator& squares, const FitDomain& domain);

    /// Of points in the domain.
    bool contains(SensorPoint sensor, AperturePoint aperture) const {
        const auto ring = static_cast<std::size_t>(sensor.mm.squaredNorm() * ringsPerSquaredMm_);
        return aperture.mm.squaredNorm() <= squaredRadiiMm2_[std::min(ring, rings - 1)];
    }

private:
    static constexpr std::size_t rings = 32;  // of equal areas
    double ringsPerSquaredMm_;
    std::array<double, rings> squaredRadiiMm2_;
};

}  // namespace etendue
