// One sample of light tracing or bidirectional path tracing under way: two walks, and what joins
// them to each other and to the lens. docs/bidirectional.md has the formulas.
#pragma once

#include <span>
#include <vector>

#include "renderer/estimator.h"
#include "renderer/subpath.h"

namespace etendue {

/// Memory that one sample leaves to the next.
struct BidirectionalMemory {
    CameraSubpath camera;
    LightSubpath light;
    std::vector<VertexDensity> path;
};

/// What every technique needs, and where it puts what it finds.
struct BidirectionalSample {
    const View& view;
    const SpectralSample& color;
    const EstimatorSettings& settings;
    const TechniqueSet& techniques;
    BidirectionalMemory& memory;
    Sample& result;

    bool wants(std::size_t s, std::size_t t) const {
        return techniques.contains({static_cast<int>(s), static_cast<int>(t)});
    }
    BsdfContext contextAt(const PathVertex& vertex, Transport transport) const {
        return {vertex.point.uv, transport, color.wavelengths};
    }
    std::span<const PathVertex> cameraVertices(std::size_t t) const {
        return std::span(memory.camera.vertices).first(t);
    }
    std::span<const PathVertex> lightVertices(std::size_t s) const {
        return std::span(memory.light.vertices).first(s);
    }
};

/// What a technique adds to the densities that the two walks already know: those of the last two
/// vertices of either walk, as the other walk would have drawn them. Where a walk has no such
/// vertex the number means nothing.
struct JoinDensities {
    float cameraEnd = 0.0f, beforeCameraEnd = 0.0f;  // fromLight
    float lightEnd = 0.0f, beforeLightEnd = 0.0f;    // fromCamera
};

/// The weight of the path made of these vertices of a camera's walk and those of a light's, each
/// from its beginning, if the lens can be connected to.
PathWeight weightOf(BidirectionalSample& sample, std::span<const PathVertex> camera,
                    std::span<const PathVertex> light, const JoinDensities& join);

/// In which lanes connecting what the camera's walk met first to the lens finds the film point
/// where it began. In others no technique with t = 1 makes its paths. Of the first lane alone
/// unless the lens parts them.
using LaneFlags = std::array<bool, Spectrum::lanes>;
LaneFlags reachableLanes(const View& view, const CameraSample& start, const CameraSubpath& path);

/// fromCamera of light vertex s − 2, seen from `y`, its successor. No ray meets a Dirac light.
float lightOriginDensity(const LightSubpath& light, std::size_t s, const PathVertex& y,
                         float pdfSolidAngle);

/// All techniques with t = 1, of the sample's light path; the rest of its random numbers.
void connectToLens(BidirectionalSample& sample, RandomStream& random);

/// All techniques with t ≥ 2, of its camera path, begun by `camera`, and its light path.
void connectSubpaths(BidirectionalSample& sample, CameraSample& camera);

/// A sample's light paths, each walked and connected to the lens; then afterEach(its number). The
/// last is left for the camera's to be connected to.
template <class AfterEach>
void takeLightPaths(BidirectionalSample& sample, SampleId id, int count,
                    const AfterEach& afterEach) {
    sample.memory.light.vertices.clear();
    for (int i = 0; i < count; ++i) {
        RandomStream random = lightPathRandom(sample.view, id, i, count);
        walkFromLight(sample.view.scene, sample.color.wavelengths, sample.settings, random,
                      sample.memory.light);
        connectToLens(sample, random);
        afterEach(i);
    }
}

/// Its camera path, begun by the ray of `camera`: walked and connected.
inline void takeCameraPath(BidirectionalSample& sample, CameraSample& camera) {
    walkFromCamera(sample.view.scene, camera, sample.settings, sample.memory.camera);
    connectSubpaths(sample, camera);
}

}  // namespace etendue
