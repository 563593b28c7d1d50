// Subpaths: random walks from the lens and from the lights, as flat arrays of vertices that carry
// what bidirectional path tracing asks of them (Veach 1997, §10.1).
#pragma once

#include <optional>
#include <vector>

#include "renderer/camera.h"
#include "renderer/estimator.h"
#include "renderer/mis.h"
#include "renderer/random.h"
#include "renderer/scattering.h"
#include "renderer/scene.h"

namespace etendue {

struct PathVertex {
    enum class Kind {
        lens,      // where the ray leaves the lens; stands for the aperture point
        surface,   // of the scene
        emitter,   // a point on an area light
        point,     // a point or spot light
        infinite,  // a direction of a light at infinity
    };
    Kind kind = Kind::surface;
    SurfacePoint point;  // surface: all of it; else place and normal, as far as there are any
    Vec3 wo;             // unit, toward the vertex before it on the walk. Infinite: to the light
    /// What arrives from the vertex before. On a walk from the camera: pixel value per radiance
    /// that leaves toward `wo`. On a walk from a light: flux, W.
    Spectrum throughput;
    bool isHeroOnly = false;  // …in the first lane alone: a glass has parted the colours
    /// The walk's own density is known when the vertex is drawn, the other one once the vertex
    /// after it has scattered. Connectable unless the walk went on from here by a Dirac bounce;
    /// whether a connection can end here is for `canConnect` to say.
    VertexDensity density;
};

/// Whether the surface has more than Dirac lobes.
inline bool canConnect(const PathVertex& vertex) { return !vertex.point.material->bsdf->isDirac(); }

/// The ray on which a walk left the scene.
struct Escape {
    Vec3 direction;
    Spectrum throughput;
    float pdfSolidAngle;  // of drawing it; from the lens: equation (2)'s limit at infinity
};

struct CameraSubpath {
    std::vector<PathVertex> vertices;  // [0] is the lens
    std::optional<Escape> escape;
};

struct LightSubpath {
    std::vector<PathVertex> vertices;  // [0] lies on the light, and nothing arrives there
    int light = -1;
    Spectrum radiance;     // as EmittedRay's, in lanes
    bool isDirac = false;  // no ray finds this light by chance
};

/// `pdfSolidAngle` at `from`, turned into the measure of `to`: 1/m² on a surface.
float densityAt(const PathVertex& to, const PathVertex& from, float pdfSolidAngle);

/// A walk from the lens along the sample's ray, which it must have, with its random numbers; at
/// most `settings.maxDepth` vertices into the scene. The vector's memory is used again.
void walkFromCamera(const Scene& scene, CameraSample& sample, const EstimatorSettings& settings,
                    CameraSubpath& path);

/// A walk from a light, at most `settings.maxDepth` vertices in all; none when no light emits.
void walkFromLight(const Scene& scene, const Wavelengths& wavelengths,
                   const EstimatorSettings& settings, RandomStream& random, LightSubpath& path);

}  // namespace etendue
