// Estimator: an unbiased estimate of the measurement of equation (1), one sample at a time.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/camera.h"
#include "renderer/filter.h"
#include "renderer/image_io.h"
#include "renderer/mis.h"
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
    TechniqueSet techniques;       // of bdpt
    int lightPaths = 1;            // of lt and bdpt: traced for each camera sample
    bool usesOuterPupil = false;   // of lt: CameraSettings::outerPupil
};

/// Another estimator under the same settings, by all of its techniques.
inline EstimatorSettings withKind(EstimatorSettings settings, const std::string& kind) {
    settings.kind = kind;
    settings.techniques = {};
    return settings;
}

/// What the samples are taken of.
struct View {
    const Scene& scene;
    const Camera& camera;
    const Filter& filter;
    bool isSpectral = false;
    std::optional<FrameWindow> window = {};  // of the frame, all that is wanted; else all of it
};

/// Names a sample, whose numbers can be had again from it. Light paths belong to the sample of a
/// pixel, too, wherever they may end.
struct SampleId {
    std::uint64_t seed = 0;
    int x = 0, y = 0;  // pixel of the full frame
    std::uint32_t sample = 0;
    Sampler sampler = Sampler::independent;
};

/// What the camera ray met first, for the auxiliary images.
struct FirstHit {
    SurfacePoint point;
    Spectrum albedo;
    float distance;
};

/// The part of a sample that one technique found.
struct Contribution {
    Technique technique;  // s = t = 0 for path tracing, which has none
    Spectrum value;       // what the film adds (SpectralSample::onFilm), not weighted yet
    float weight = 1.0f;  // of multiple importance sampling
    Vec2 film;            // of a splat: pixels of the full frame
    /// A light path may fall anywhere (t = 1), and so may wavelengths of a camera path, behind a
    /// lens that parts them. The first is a sample of the whole frame, the second of one pixel.
    bool isSplat = false;
};

struct SampleRequest {
    bool ownPixel = true;  // what the camera sample brings to the pixel itself; if not, only splats
                           // count
    bool firstHit = false;
};

struct Sample {
    std::vector<Contribution> contributions;
    std::optional<FirstHit> firstHit;  // if requested, and anything was met
};

class Estimator {
public:
    virtual ~Estimator() = default;

    /// Sets `result`, whose memory is used again.
    virtual void takeSample(const View& view, SampleId id, SampleRequest request,
                            Sample& result) const = 0;

    /// Light paths that each sample traces; a pixel's value is the mean of what camera paths bring
    /// to it over the samples, plus the mean of what light paths do over all of those.
    virtual int lightPathsPerSample() const { return 0; }
    /// Whether camera paths bring anything.
    virtual bool hasCameraLight() const { return true; }
};

/// The film point by the filter and the lens point uniform on the aperture, alike for every
/// estimator. No ray where the lens blocks it.
struct CameraSample {
    RandomStream random;  // the rest of its numbers
    SpectralSample color;
    Vec2 film, apertureUniform;
    std::optional<CameraRay> ray;
    /// Behind a lens that parts colours, where the ray comes from at each wavelength: a lane's
    /// light lands on its own film point. Else empty, and all land on `film`.
    std::optional<CameraRayOrigins> origins;
    /// The ray's weight in every lane. Parted, each is shared with the samples of the other lanes'
    /// heroes that find the same ray, by the balance heuristic.
    Spectrum throughput;
    /// What the first lane is worth as soon as it goes on alone, which no other's hero could.
    float heroStandsFor = Spectrum::lanes;
};
CameraSample drawCameraSample(const View& view, SampleId id);
/// The wavelengths of a sample, of its camera path and its light paths alike.
SpectralSample drawWavelengths(const View& view, SampleId id);
/// Whether each wavelength goes through the lens on a way of its own.
inline bool isParted(const Camera& camera, bool isSpectral) {
    return isSpectral && camera.settings().isDispersive;
}
inline bool isParted(const View& view) { return isParted(view.camera, view.isSpectral); }
/// Whether the filter of any pixel reaches `film`, of the view's window if it has one.
bool isOnFilm(const View& view, Vec2 film);
/// Whether any wavelength may splat there.
bool isSplatting(const View& view, const CameraSample& sample);

/// Weights of multiple importance sampling, of each lane.
using LaneWeights = std::array<float, Spectrum::lanes>;
/// What a camera path brings, `value` in lanes: to the pixel, and splats of lanes that land
/// elsewhere.
void contribute(const CameraSample& sample, Technique technique, const Spectrum& value,
                const LaneWeights& weights, std::vector<Contribution>& contributions);

/// What `ray` meets first.
std::optional<FirstHit> firstHitOf(const Scene& scene, const CameraRay& ray);

/// The random numbers of a sample's camera path. A pixel's are stratified among themselves.
RandomStream cameraPathRandom(const View& view, SampleId id);
/// Of its light path number `path` out of `count`. Stratified among all of the frame's, which may
/// fall anywhere.
RandomStream lightPathRandom(const View& view, SampleId id, int path, int count);

/// The kinds that makeEstimator knows.
const std::vector<std::string>& estimatorKinds();

/// Throws std::invalid_argument for an unknown kind.
std::unique_ptr<Estimator> makeEstimator(const EstimatorSettings& settings);

/// Path tracing with next-event estimation, the two combined by the balance heuristic (Veach 1997,
/// §9).
std::unique_ptr<Estimator> makePathTracer(const EstimatorSettings& settings);
/// The radiance that path tracing sees along a ray.
Spectrum pathTracedRadiance(const Scene& scene, const Ray& ray, const Wavelengths& wavelengths,
                            const EstimatorSettings& settings, RandomStream& random);

/// Light paths connected to the lens at every vertex: the techniques with t = 1 alone.
std::unique_ptr<Estimator> makeLightTracer(const EstimatorSettings& settings);
/// All techniques of bidirectional path tracing, or those that the settings name (Veach 1997,
/// chapter 10).
std::unique_ptr<Estimator> makeBidirectional(const EstimatorSettings& settings);

}  // namespace etendue
