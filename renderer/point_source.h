// What point and spot lights share: all light comes from one position.
#pragma once

#include <optional>

#include "renderer/light.h"

namespace etendue {

/// Light of `intensity` (W/sr) from `position`. Empty where its irradiance exceeds a float: at the
/// source itself.
inline std::optional<LightSample> sampleFromPoint(Vec3 position, Spectrum intensity,
                                                  Vec3 receiver) {
    const Vec3d toLight = toDouble(position) - toDouble(receiver);
    const double distance = length(toLight);
    LightSample result{};
    result.radiance = intensity * static_cast<float>(1.0 / (distance * distance));
    if (!isFinite(result.radiance)) return {};
    result.direction = toFloat(toLight / distance);
    result.distance = static_cast<float>(distance);
    result.position = position;
    result.normal = -result.direction;
    result.pdfSolidAngle = 1.0f;
    result.isDirac = true;
    return result;
}

}  // namespace etendue
