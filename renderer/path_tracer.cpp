// Path tracing with next-event estimation. Kept independent of the bidirectional estimators, on
// purpose: it is what they are compared with.
#include "renderer/estimator.h"
#include "renderer/scattering.h"
#include "renderer/visibility.h"

namespace etendue {

namespace {

/// Balance heuristic for one sample of each strategy (Veach 1997, equation 9.8).
float balanceWeight(float pdf, float otherPdf) { return pdf / (pdf + otherPdf); }

/// The walk of one path.
class PathWalk {
public:
    PathWalk(const Scene& scene, const Wavelengths& wavelengths, const EstimatorSettings& settings,
             RandomStream& random)
        : scene_(scene), wavelengths_(wavelengths), settings_(settings), random_(random) {}

    /// `throughput`: of the ray; `heroStandsFor`: as CameraSample's.
    Spectrum radiance(Ray ray, Spectrum throughput, float heroStandsFor) {
        bool isHeroOnly = false;
        Spectrum result, attenuation(1.0f);
        // The density with which the last scattering drew the ray; none after the camera or a Dirac
        // lobe, where no light sample competes.
        std::optional<float> pdfSolidAngle;
        for (int depth = 1;; ++depth) {
            const std::optional<SurfacePoint> point = scene_.closestHit(ray);
            if (!point) {
                result += throughput * environment(ray, pdfSolidAngle);
                return result;
            }
            const BsdfContext context{point->uv, Transport::radiance, wavelengths_};
            if (point->light >= 0) result += throughput * emission(*point, ray, pdfSolidAngle);
            if (depth == settings_.maxDepth) return result;

            const Vec3 wo = -ray.direction;
            if (!point->material->bsdf->isDirac())
                result += throughput * nextEvent(*point, context, wo);

            const float uLobe = random_.next();
            const std::optional<BsdfSample> next =
                sampleScattering(*point, context, wo, uLobe, random_.next2());
            if (!next) return result;
            throughput *= next->weight;
            attenuation *= next->weight;
            if (next->isHeroOnly && !isHeroOnly) {
                throughput = heroAlone(throughput, heroStandsFor);
                isHeroOnly = true;
            }
            if (!survivesRoulette(throughput, attenuation, depth)) return result;
            pdfSolidAngle = next->isDirac ? std::nullopt : std::optional(next->pdfSolidAngle);
            ray = {offsetOrigin(*point, next->wi), next->wi};
        }
    }

private:
    Spectrum emission(const SurfacePoint& point, const Ray& ray,
                      std::optional<float> pdfSolidAngle) const {
        const LightTable& lights = scene_.lights();
        const EmitterHit hit{ray.direction, length(point.position - ray.origin),
                             point.geometricNormal};
        const Light& light = lights[point.light];
        const Spectrum radiance = wavelengths_.lanesOf(light.radiance(hit));
        if (!pdfSolidAngle || isBlack(radiance)) return radiance;
        const float lightPdf = lights.probability(point.light) * light.pdfSolidAngle(hit);
        return radiance * balanceWeight(*pdfSolidAngle, lightPdf);
    }

    Spectrum environment(const Ray& ray, std::optional<float> pdfSolidAngle) const {
        Spectrum sum;
        const LightTable& lights = scene_.lights();
        const EmitterHit hit{ray.direction, std::numeric_limits<float>::infinity(), -ray.direction};
        for (const int index : lights.infiniteLights()) {
            const Spectrum radiance = wavelengths_.lanesOf(lights[index].radiance(hit));
            if (!pdfSolidAngle || isBlack(radiance)) {
                sum += radiance;
                continue;
            }
            const float lightPdf = lights.probability(index) * lights[index].pdfSolidAngle(hit);
            sum += radiance * balanceWeight(*pdfSolidAngle, lightPdf);
        }
        return sum;
    }

    /// Always draws the same count of random numbers, so that a path's later choices do not depend
    /// on whether a light was visible.
    Spectrum nextEvent(const SurfacePoint& point, const BsdfContext& context, Vec3 wo) {
        const float uLight = random_.next();
        const Vec2 u = random_.next2();
        const auto choice = scene_.lights().sample(uLight);
        if (!choice) return {};
        const auto sample = scene_.lights()[choice->index].sample(point.position, u);
        if (!sample) return {};
        const Scattering scattering = scatteringBetween(point, context, wo, sample->direction);
        if (isBlack(scattering.value) || !isVisible(scene_, point, *sample)) return {};
        const float lightPdf = choice->probability * sample->pdfSolidAngle;
        const float weight =
            sample->isDirac ? 1.0f : balanceWeight(lightPdf, scattering.pdfSolidAngle);
        return scattering.value * wavelengths_.lanesOf(sample->radiance) * (weight / lightPdf);
    }

    bool survivesRoulette(Spectrum& throughput, Spectrum& attenuation, int depth) {
        if (settings_.russianRouletteDepth == 0 || depth < settings_.russianRouletteDepth)
            return true;
        const float survival = std::min(1.0f, maxLane(attenuation));
        if (!(random_.next() < survival)) return false;
        throughput /= survival;
        attenuation /= survival;
        return true;
    }

    const Scene& scene_;
    const Wavelengths& wavelengths_;
    const EstimatorSettings& settings_;
    RandomStream& random_;
};

class PathTracer final : public Estimator {
public:
    explicit PathTracer(const EstimatorSettings& settings) : settings_(settings) {}

    void takeSample(const View& view, SampleId id, SampleRequest request,
                    Sample& result) const override {
        result.contributions.clear();
        result.firstHit.reset();
        if (!request.ownPixel && !isParted(view)) return;
        CameraSample camera = drawCameraSample(view, id);
        if (!camera.ray || !(request.ownPixel || isSplatting(view, camera))) return;
        if (request.firstHit) result.firstHit = firstHitOf(view.scene, *camera.ray);
        const Spectrum value =
            PathWalk(view.scene, camera.color.wavelengths, settings_, camera.random)
                .radiance({camera.ray->origin, camera.ray->direction}, camera.throughput,
                          camera.heroStandsFor);
        contribute(camera, {}, value, {1.0f, 1.0f, 1.0f, 1.0f}, result.contributions);
    }

private:
    EstimatorSettings settings_;
};

}  // namespace

Spectrum pathTracedRadiance(const Scene& scene, const Ray& ray, const Wavelengths& wavelengths,
                            const EstimatorSettings& settings, RandomStream& random) {
    return PathWalk(scene, wavelengths, settings, random)
        .radiance(ray, Spectrum(1.0f), Spectrum::lanes);
}

std::unique_ptr<Estimator> makePathTracer(const EstimatorSettings& settings) {
    return std::make_unique<PathTracer>(settings);
}

}  // namespace etendue
