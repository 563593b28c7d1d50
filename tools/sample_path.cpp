#include "tools/sample_path.h"

#include <cmath>
#include <limits>

#include "renderer/bidirectional_sample.h"
#include "renderer/visibility.h"

namespace etendue {

namespace {

void sumUp(const std::vector<Contribution>& contributions, SamplePath& path) {
    for (const Contribution& c : contributions)
        (c.isSplat ? path.splatted : path.ownPixel) += c.value * c.weight;
}

/// The walk of renderer/path_tracer.cpp once more, in the same arithmetic, with a record of what it
/// meets. A test holds the two together to the bit.
class RecordedPathTracing {
public:
    RecordedPathTracing(const View& view, const EstimatorSettings& settings, SamplePath& record)
        : scene_(view.scene),
          settings_(settings),
          sample_(*record.camera),
          path_(record.cameraPath),
          record_(record),
          throughput_(record.camera->throughput) {}

    void trace() {
        const CameraRay& cameraRay = *sample_.ray;
        path_.vertices.emplace_back().kind = PathVertex::Kind::lens;
        path_.vertices.back().point = bareSurfacePoint(cameraRay.origin, {}, cameraRay.direction);
        std::vector<Contribution> whole;
        contribute(sample_, {}, radiance({cameraRay.origin, cameraRay.direction}),
                   {1.0f, 1.0f, 1.0f, 1.0f}, whole);
        sumUp(whole, record_);
    }

private:
    Spectrum radiance(Ray ray) {
        Spectrum result;
        for (int depth = 1;; ++depth) {
            const std::optional<SurfacePoint> point = scene_.closestHit(ray);
            if (!point) {
                result += throughput_ * environment(ray);
                return result;
            }
            addVertex(*point, ray);
            const BsdfContext context{point->uv, Transport::radiance, sample_.color.wavelengths};
            if (point->light >= 0) result += throughput_ * emission(*point, ray);
            if (depth == settings_.maxDepth) return result;

            const Vec3 wo = -ray.direction;
            if (!point->material->bsdf->isDirac())
                result += throughput_ * nextEvent(*point, context, wo);

            const float uLobe = sample_.random.next();
            const std::optional<BsdfSample> next =
                sampleScattering(*point, context, wo, uLobe, sample_.random.next2());
            if (!next) return result;
            noteScattering(*next);
            throughput_ *= next->weight;
            attenuation_ *= next->weight;
            if (next->isHeroOnly && !isHeroOnly_) {
                throughput_ = heroAlone(throughput_, sample_.heroStandsFor);
                isHeroOnly_ = true;
            }
            if (!survivesRoulette(depth)) return result;
            pdfSolidAngle_ = next->isDirac ? std::nullopt : std::optional(next->pdfSolidAngle);
            ray = {offsetOrigin(*point, next->wi), next->wi};
        }
    }

    void addVertex(const SurfacePoint& point, const Ray& ray) {
        PathVertex& vertex = path_.vertices.emplace_back();
        const PathVertex& before = path_.vertices[path_.vertices.size() - 2];
        vertex.point = point;
        vertex.wo = -ray.direction;
        vertex.throughput = throughput_;
        vertex.isHeroOnly = isHeroOnly_;
        vertex.density.isConnectable = true;
        vertex.density.fromCamera =
            path_.vertices.size() == 2
                ? pdfArea(*sample_.ray, length(point.position - ray.origin), point.geometricNormal)
                : densityAt(vertex, before, drawn_);
    }

    void noteScattering(const BsdfSample& next) {
        PathVertex& vertex = path_.vertices.back();
        PathVertex& before = path_.vertices[path_.vertices.size() - 2];
        if (next.isDirac) vertex.density.isConnectable = false;
        before.density.fromLight = densityAt(before, vertex, next.pdfSolidAngleReverse);
        drawn_ = next.pdfSolidAngle;
    }

    void addTerm(int s, std::size_t t, const Spectrum& value, float weight) {
        if (isBlack(value)) return;
        contribute(sample_, {s, static_cast<int>(t)}, throughput_ * value,
                   {weight, weight, weight, weight}, record_.contributions);
    }

    Spectrum lanesOf(const Spectrum& rgb) const { return sample_.color.wavelengths.lanesOf(rgb); }

    static float balanceWeight(float pdf, float otherPdf) { return pdf / (pdf + otherPdf); }

    Spectrum emission(const SurfacePoint& point, const Ray& ray) {
        const LightTable& lights = scene_.lights();
        const EmitterHit hit{ray.direction, length(point.position - ray.origin),
                             point.geometricNormal};
        const Light& light = lights[point.light];
        const Spectrum radiance = lanesOf(light.radiance(hit));
        float weight = 1.0f;
        if (pdfSolidAngle_ && !isBlack(radiance))
            weight = balanceWeight(*pdfSolidAngle_,
                                   lights.probability(point.light) * light.pdfSolidAngle(hit));
        addTerm(0, path_.vertices.size(), radiance, weight);
        return radiance * weight;
    }

    Spectrum environment(const Ray& ray) {
        path_.escape = Escape{ray.direction, throughput_,
                              path_.vertices.size() == 1 ? pdfSolidAngle(*sample_.ray) : drawn_};
        Spectrum sum;
        const LightTable& lights = scene_.lights();
        const EmitterHit hit{ray.direction, std::numeric_limits<float>::infinity(), -ray.direction};
        for (const int index : lights.infiniteLights()) {
            const Spectrum radiance = lanesOf(lights[index].radiance(hit));
            float weight = 1.0f;
            if (pdfSolidAngle_ && !isBlack(radiance))
                weight = balanceWeight(
                    *pdfSolidAngle_, lights.probability(index) * lights[index].pdfSolidAngle(hit));
            addTerm(0, path_.vertices.size() + 1, radiance, weight);
            sum += radiance * weight;
        }
        return sum;
    }

    Spectrum nextEvent(const SurfacePoint& point, const BsdfContext& context, Vec3 wo) {
        const float uLight = sample_.random.next();
        const Vec2 u = sample_.random.next2();
        const auto choice = scene_.lights().sample(uLight);
        if (!choice) return {};
        const auto light = scene_.lights()[choice->index].sample(point.position, u);
        if (!light) return {};
        const Scattering scattering = scatteringBetween(point, context, wo, light->direction);
        if (isBlack(scattering.value) || !isVisible(scene_, point, *light)) return {};
        const float lightPdf = choice->probability * light->pdfSolidAngle;
        const float weight =
            light->isDirac ? 1.0f : balanceWeight(lightPdf, scattering.pdfSolidAngle);
        const Spectrum arriving = lanesOf(light->radiance);
        addTerm(1, path_.vertices.size(), scattering.value * arriving / lightPdf, weight);
        return scattering.value * arriving * (weight / lightPdf);
    }

    bool survivesRoulette(int depth) {
        if (settings_.russianRouletteDepth == 0 || depth < settings_.russianRouletteDepth)
            return true;
        const float survival = std::min(1.0f, maxLane(attenuation_));
        if (!(sample_.random.next() < survival)) return false;
        throughput_ /= survival;
        attenuation_ /= survival;
        return true;
    }

    const Scene& scene_;
    const EstimatorSettings& settings_;
    CameraSample& sample_;
    CameraSubpath& path_;
    SamplePath& record_;
    Spectrum throughput_, attenuation_ = Spectrum(1.0f);
    bool isHeroOnly_ = false;  // as PathVertex's
    /// With which the last scattering drew the ray; none after the camera or a Dirac lobe, where no
    /// light sample competes.
    std::optional<float> pdfSolidAngle_;
    float drawn_ = 0.0f;  // the same, and a Dirac lobe's probability
};

void retracePathTracing(const View& view, const EstimatorSettings& settings, SampleId id,
                        SamplePath& result) {
    result.camera = drawCameraSample(view, id);
    if (result.camera->ray) RecordedPathTracing(view, settings, result).trace();
}

/// What makeEstimator makes of light tracing and bidirectional path tracing, without forgetting.
void retraceBidirectional(const View& view, const EstimatorSettings& settings, SampleId id,
                          int lightPaths, SamplePath& result) {
    static thread_local Sample found;
    static thread_local BidirectionalMemory memory;
    const TechniqueSet techniques =
        settings.kind == "lt" ? TechniqueSet::lightTracing() : settings.techniques;
    const SpectralSample color = drawWavelengths(view, id);
    found.contributions.clear();
    std::swap(memory.camera, result.cameraPath);
    BidirectionalSample sample{view, color, settings, techniques, memory, found};
    result.lightPaths.resize(static_cast<std::size_t>(lightPaths));
    takeLightPaths(sample, id, lightPaths, [&](int i) {
        if (i + 1 < lightPaths) result.lightPaths[static_cast<std::size_t>(i)] = memory.light;
    });
    if (techniques.needsCameraWalk(settings.maxDepth)) {
        result.camera = drawCameraSample(view, id);
        if (result.camera->ray) takeCameraPath(sample, *result.camera);
    }
    std::swap(memory.camera, result.cameraPath);
    if (lightPaths > 0) std::swap(result.lightPaths.back(), memory.light);
    std::swap(result.contributions, found.contributions);
    sumUp(result.contributions, result);
}

}  // namespace

void retraceSample(const View& view, const Estimator& estimator, const EstimatorSettings& settings,
                   SampleId id, SamplePath& result) {
    result.camera.reset();
    result.cameraPath.vertices.clear();
    result.cameraPath.escape.reset();
    result.contributions.clear();
    result.ownPixel = result.splatted = {};
    if (settings.kind == "pt") {
        result.lightPaths.clear();
        retracePathTracing(view, settings, id, result);
    } else {
        retraceBidirectional(view, settings, id, estimator.lightPathsPerSample(), result);
    }
}

void markReachability(const View& view, SamplePath& path) {
    if (!path.cameraPath.vertices.empty())
        path.cameraPath.vertices.front().density.isConnectable =
            reachableLanes(view, *path.camera, path.cameraPath).front();
}

}  // namespace etendue
