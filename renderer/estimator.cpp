#include "renderer/estimator.h"

#include <stdexcept>

namespace etendue {

namespace {

struct Kind {
    const char* name;
    std::unique_ptr<Estimator> (*make)(const EstimatorSettings&);
};

constexpr Kind kinds[] = {
    {"pt", makePathTracer},
    {"lt", makeLightTracer},
    {"bdpt", makeBidirectional},
};

/// The index of the random numbers that belong to a pixel.
std::uint32_t pixelIndex(const View& view, SampleId id) {
    return static_cast<std::uint32_t>(id.y) *
               static_cast<std::uint32_t>(view.camera.settings().width) +
           static_cast<std::uint32_t>(id.x);
}

/// A pixel's numbers for one purpose, stratified over its samples.
RandomStream pixelRandom(const View& view, SampleId id, RandomDomain domain) {
    const std::uint32_t pixel = pixelIndex(view, id);
    const RandomStream random(id.seed, pixel, id.sample, domain);
    return id.sampler == Sampler::sobol ? RandomStream(random, pixel, id.sample) : random;
}

}  // namespace

RandomStream cameraPathRandom(const View& view, SampleId id) {
    return pixelRandom(view, id, RandomDomain::cameraPath);
}

RandomStream lightPathRandom(const View& view, SampleId id, int path, int count) {
    const std::uint32_t pixel = pixelIndex(view, id);
    const std::uint64_t pathOfPixel = std::uint64_t{id.sample} * static_cast<std::uint64_t>(count) +
                                      static_cast<std::uint64_t>(path);
    const RandomStream random(id.seed, pixel, pathOfPixel, RandomDomain::lightPath);
    if (id.sampler != Sampler::sobol) return random;
    const CameraSettings& frame = view.camera.settings();
    const auto pixels =
        static_cast<std::uint64_t>(frame.width) * static_cast<std::uint64_t>(frame.height);
    // A sequence has 2³² points. 2³² paths of a pixel are a whole number of sequences.
    const std::uint64_t point = pathOfPixel * pixels + pixel;
    return RandomStream(random, static_cast<std::uint32_t>(point >> 32),
                        static_cast<std::uint32_t>(point));
}

bool isParted(const View& view) { return view.isSpectral && view.camera.settings().isDispersive; }

SpectralSample drawWavelengths(const View& view, SampleId id) {
    if (!view.isSpectral) return {};
    return sampleWavelengths(pixelRandom(view, id, RandomDomain::wavelength).next());
}

CameraSample drawCameraSample(const View& view, SampleId id) {
    CameraSample result{.random = cameraPathRandom(view, id),
                        .color = drawWavelengths(view, id),
                        .film = {},
                        .apertureUniform = {},
                        .ray = {},
                        .throughput = {},
                        .isHeroOnly = isParted(view)};
    const Vec2 center{static_cast<float>(id.x) + 0.5f, static_cast<float>(id.y) + 0.5f};
    result.film = center + view.filter.sample(result.random.next2());
    result.apertureUniform = result.random.next2();
    result.ray =
        view.camera.sampleRay(result.film, result.apertureUniform, result.color.wavelengths);
    if (!result.ray) return result;
    const float weight = result.ray->weight;
    result.throughput = isParted(view) ? heroAlone(Spectrum(weight)) : Spectrum(weight);
    return result;
}

std::optional<FirstHit> firstHitOf(const Scene& scene, const CameraRay& ray) {
    const std::optional<SurfacePoint> point = scene.closestHit({ray.origin, ray.direction});
    if (!point) return {};
    const BsdfContext context{point->uv, Transport::radiance};  // as RGB, in any scene
    return FirstHit{*point, point->material->bsdf->albedo(context),
                    length(point->position - ray.origin)};
}

const std::vector<std::string>& estimatorKinds() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> result;
        for (const Kind& k : kinds) result.emplace_back(k.name);
        return result;
    }();
    return names;
}

std::unique_ptr<Estimator> makeEstimator(const EstimatorSettings& settings) {
    for (const Kind& k : kinds)
        if (settings.kind == k.name) return k.make(settings);
    throw std::invalid_argument("unknown estimator '" + settings.kind + "'");
}

}  // namespace etendue
