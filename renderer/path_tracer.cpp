// Path tracing with next-event estimation. Kept independent of the bidirectional estimators, on
// purpose: it is what they are compared with.
#include "renderer/estimator.h"
#include "renderer/scattering.h"

namespace etendue {

namespace {

/// Balance heuristic for one sample of each strategy (Veach 1997, equation 9.8).
float balanceWeight(float pdf, float otherPdf) { return pdf / (pdf + otherPdf); }

class PathTracer final : public Estimator {
public:
    explicit PathTracer(const EstimatorSettings& settings) : settings_(settings) {}

    Spectrum radiance(const Scene& scene, const CameraRay& cameraRay,
                      const Wavelengths& wavelengths, RandomStream& random,
                      std::optional<FirstHit>* firstHit) const override {
        Spectrum result, throughput(1.0f);
        Ray ray{cameraRay.origin, cameraRay.direction};
        // The density with which the last scattering drew the ray; none after the camera or a Dirac
        // lobe, where no light sample competes.
        std::optional<float> pdfSolidAngle;
        for (int depth = 1;; ++depth) {
            const std::optional<SurfacePoint> point = scene.closestHit(ray);
            if (!point) {
                result += throughput * environment(scene, ray, pdfSolidAngle);
                return result;
            }
            const BsdfContext context{point->uv, Transport::radiance, wavelengths};
            if (depth == 1 && firstHit)
                *firstHit = {*point, point->material->bsdf->albedo(context),
                             length(point->position - ray.origin)};
            if (point->light >= 0)
                result += throughput * emission(scene, *point, ray, pdfSolidAngle);
            if (depth == settings_.maxDepth) return result;

            const Vec3 wo = -ray.direction;
            if (!point->material->bsdf->isDirac())
                result += throughput * nextEvent(scene, *point, context, wo, random);

            const float uLobe = random.next();
            const std::optional<BsdfSample> next =
                sampleScattering(*point, context, wo, uLobe, random.next2());
            if (!next) return result;
            throughput *= next->weight;
            if (!survivesRoulette(throughput, depth, random)) return result;
            pdfSolidAngle = next->isDirac ? std::nullopt : std::optional(next->pdfSolidAngle);
            ray = {offsetOrigin(*point, next->wi), next->wi};
        }
    }

private:
    Spectrum emission(const Scene& scene, const SurfacePoint& point, const Ray& ray,
                      std::optional<float> pdfSolidAngle) const {
        const LightTable& lights = scene.lights();
        const EmitterHit hit{ray.direction, length(point.position - ray.origin),
                             point.geometricNormal};
        const Light& light = lights[point.light];
        const Spectrum radiance = light.radiance(hit);
        if (!pdfSolidAngle || isBlack(radiance)) return radiance;
        const float lightPdf = lights.probability(point.light) * light.pdfSolidAngle(hit);
        return radiance * balanceWeight(*pdfSolidAngle, lightPdf);
    }

    Spectrum environment(const Scene& scene, const Ray& ray,
                         std::optional<float> pdfSolidAngle) const {
        Spectrum sum;
        const LightTable& lights = scene.lights();
        const EmitterHit hit{ray.direction, std::numeric_limits<float>::infinity(), -ray.direction};
        for (const int index : lights.infiniteLights()) {
            const Spectrum radiance = lights[index].radiance(hit);
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
    Spectrum nextEvent(const Scene& scene, const SurfacePoint& point, const BsdfContext& context,
                       Vec3 wo, RandomStream& random) const {
        const float uLight = random.next();
        const Vec2 u = random.next2();
        const auto choice = scene.lights().sample(uLight);
        if (!choice) return {};
        const auto sample = scene.lights()[choice->index].sample(point.position, u);
        if (!sample) return {};
        const Scattering scattering = scatteringBetween(point, context, wo, sample->direction);
        if (isBlack(scattering.value) || !isVisible(scene, point, *sample)) return {};
        const float lightPdf = choice->probability * sample->pdfSolidAngle;
        const float weight =
            sample->isDirac ? 1.0f : balanceWeight(lightPdf, scattering.pdfSolidAngle);
        return scattering.value * sample->radiance * (weight / lightPdf);
    }

    static bool isVisible(const Scene& scene, const SurfacePoint& point,
                          const LightSample& sample) {
        const Vec3 from = offsetOrigin(point, sample.direction);
        if (std::isinf(sample.distance)) return scene.isVisibleToInfinity(from, sample.direction);
        SurfacePoint end;
        end.position = sample.position;
        end.positionError = sample.positionError;
        end.geometricNormal = sample.normal;
        return scene.isVisible(from, offsetOrigin(end, -sample.direction));
    }

    bool survivesRoulette(Spectrum& throughput, int depth, RandomStream& random) const {
        if (settings_.russianRouletteDepth == 0 || depth < settings_.russianRouletteDepth)
            return true;
        const float survival = std::min(1.0f, maxLane(throughput));
        if (!(random.next() < survival)) return false;
        throughput /= survival;
        return true;
    }

    EstimatorSettings settings_;
};

}  // namespace

std::unique_ptr<Estimator> makePathTracer(const EstimatorSettings& settings) {
    return std::make_unique<PathTracer>(settings);
}

}  // namespace etendue
