// Estimator: an unbiased estimate of the measurement of equation (1), one camera sample at a time.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/camera.h"
#include "renderer/random.h"
#include "renderer/scene.h"
#include "renderer/spectrum.h"

namespace etendue {

/// Depth counts the edges of the whole path from lens to light, for every estimator alike: 1 is
/// light seen directly, 2 is direct lighting.
struct EstimatorSettings {
    std::string kind = "pt";
    int maxDepth = 12;
    int russianRouletteDepth = 5;  // from this depth on a path may be ended at random; 0: never
};

/// What the camera ray met first, for the auxiliary images.
struct FirstHit {
    SurfacePoint point;
    Spectrum albedo;
    float distance;
};

class Estimator {
public:
    virtual ~Estimator() = default;

    /// The radiance along a camera ray. `firstHit`, if wanted, receives what the ray met.
    virtual Spectrum radiance(const Scene& scene, const CameraRay& ray,
                              const Wavelengths& wavelengths, RandomStream& random,
                              std::optional<FirstHit>* firstHit) const = 0;
};

/// The kinds that makeEstimator knows.
const std::vector<std::string>& estimatorKinds();

/// Throws std::invalid_argument for an unknown kind.
std::unique_ptr<Estimator> makeEstimator(const EstimatorSettings& settings);

/// Path tracing with next-event estimation, the two combined by the balance heuristic (Veach 1997,
/// §9).
std::unique_ptr<Estimator> makePathTracer(const EstimatorSettings& settings);

}  // namespace etendue
