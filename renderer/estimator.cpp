#include "renderer/estimator.h"

#include <algorithm>
#include <cmath>
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

/// The density of film points, per pixel area, that one camera sample of every pixel draws: one,
/// but near the frame's edge and for filters that do not sum to one everywhere.
double samplesAt(const View& view, Vec2 film) {
    const CameraSettings& frame = view.camera.settings();
    const float radius = view.filter.radius();
    const auto along = [&](float at, int pixels) {
        if (!(at > -radius && at < static_cast<float>(pixels) + radius)) return 0.0;
        const auto first = static_cast<int>(std::floor(std::max(at - radius - 0.5f, 0.0f)));
        double sum = 0.0;
        for (int i = first; i < pixels && static_cast<float>(i) <= at + radius; ++i)
            sum += view.filter.pdfAxis(at - (static_cast<float>(i) + 0.5f));
        return sum;
    };
    return along(film.x, frame.width) * along(film.y, frame.height);
}

/// The throughput of each lane. The ray of one wavelength might as well have been drawn for each
/// of the others, from where it comes at that one: the densities of that, per étendue, are summed
/// by the balance heuristic ("Hero Wavelength Spectral Sampling", Wilkie et al. 2014, where the
/// lens' map is the path's first vertex). A lane's own samples are drawn pixel by pixel, by the
/// very filter that weighs them: of those the density is one.
void shareAmongLanes(const View& view, CameraSample& sample) {
    CameraRayOrigins& origins = *sample.origins;
    std::array<double, Spectrum::lanes> density{}, own{};
    double sum = 0.0;
    for (std::size_t lane = 0; lane < origins.size(); ++lane) {
        if (!origins[lane]) continue;
        own[lane] = 1.0 / origins[lane]->etendue;
        density[lane] = samplesAt(view, origins[lane]->film) * own[lane];
        sum += density[lane];
        if (lane > 0 && density[lane] == 0.0) origins[lane].reset();  // no pixel would see it
    }
    sample.throughput = Spectrum::fromLanes([&](int i) {
        const auto lane = static_cast<std::size_t>(i);
        if (!origins[lane]) return 0.0f;
        const double share = own[lane] / (sum - density[lane] + own[lane]);
        return static_cast<float>(Spectrum::lanes * share * origins[lane]->ray.weight);
    });
    sample.heroStandsFor = static_cast<float>((sum - density[0] + own[0]) / own[0]);
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

SpectralSample drawWavelengths(const View& view, SampleId id) {
    if (!view.isSpectral) return {};
    return sampleWavelengths(pixelRandom(view, id, RandomDomain::wavelength).next());
}

bool isOnFilm(const View& view, Vec2 film) {
    const CameraSettings& frame = view.camera.settings();
    const FrameWindow window = view.window.value_or(
        FrameWindow{frame.width, frame.height, 0, 0, frame.width, frame.height});
    const float margin = view.filter.radius() - 0.5f;
    const auto isWithin = [&](float at, int begin, int size) {
        return at >= static_cast<float>(begin) - margin &&
               at < static_cast<float>(begin + size) + margin;
    };
    return isWithin(film.x, window.x, window.width) && isWithin(film.y, window.y, window.height);
}

bool isSplatting(const View& view, const CameraSample& sample) {
    if (!sample.origins) return false;
    for (std::size_t lane = 1; lane < sample.origins->size(); ++lane)
        if (const auto& origin = (*sample.origins)[lane]; origin && isOnFilm(view, origin->film))
            return true;
    return false;
}

CameraSample drawCameraSample(const View& view, SampleId id) {
    CameraSample result{.random = cameraPathRandom(view, id),
                        .color = drawWavelengths(view, id),
                        .film = {},
                        .apertureUniform = {},
                        .ray = {},
                        .origins = {},
                        .throughput = {}};
    const Vec2 center{static_cast<float>(id.x) + 0.5f, static_cast<float>(id.y) + 0.5f};
    result.film = center + view.filter.sample(result.random.next2());
    result.apertureUniform = result.random.next2();
    const Wavelengths& wavelengths = result.color.wavelengths;
    if (isParted(view)) {
        result.origins =
            view.camera.sampleRayOfEach(result.film, result.apertureUniform, wavelengths);
        if (const auto& hero = result.origins->front()) {
            result.ray = hero->ray;
            shareAmongLanes(view, result);
        }
    } else {
        result.ray = view.camera.sampleRay(result.film, result.apertureUniform, wavelengths);
        if (result.ray) result.throughput = Spectrum(result.ray->weight);
    }
    return result;
}

void contribute(const CameraSample& sample, Technique technique, const Spectrum& value,
                const LaneWeights& weights, std::vector<Contribution>& contributions) {
    if (!sample.origins) {
        contributions.push_back({technique, sample.color.onFilm(value), weights[0], sample.film});
        return;
    }
    for (std::size_t lane = 0; lane < Spectrum::lanes; ++lane) {
        const auto& origin = (*sample.origins)[lane];
        const float landing = value[static_cast<int>(lane)];
        const bool isSplat = lane > 0;
        if (!origin || (isSplat && landing == 0.0f)) continue;
        contributions.push_back(
            {technique, sample.color.onFilm(lane, landing), weights[lane], origin->film, isSplat});
    }
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
