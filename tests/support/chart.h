// A test chart at infinity, whose radiance is known with its derivative.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "renderer/camera.h"
#include "renderer/scene.h"
#include "tests/support/pixel_maps.h"

namespace etendue {

/// Radiance by direction: two crossed sine waves about 1, in Lambert's equal-area coordinates about
/// +z.
struct Chart {
    static constexpr double amplitude = 0.4;  // of each wave
    static constexpr double brightest = 1.0 + 2.0 * amplitude;
    double wavenumber = 0.0;    // per unit of the coordinates
    double leastCosine = -1.0;  // farther off the axis it is black

    double radiance(const Eigen::Vector3d& direction) const;
    Eigen::Vector3d gradient(const Eigen::Vector3d& direction) const;
    /// The most by which radiance(to) can differ from radiance(from) and its gradient, but for what
    /// is of third order.
    double mostSecondOrder(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
};

/// The chart alone.
std::unique_ptr<Scene> chartScene(const Chart& chart);

/// Renders with the seeds from `firstSeed` on; `kind`: the estimator.
std::vector<PixelMap> renderChart(const Scene& scene, const Camera& camera, const char* kind,
                                  std::uint32_t samples, std::uint64_t firstSeed, int seeds);

}  // namespace etendue
