#include "renderer/subpath.h"

#include <cmath>

#include "renderer/visibility.h"

namespace etendue {

namespace {

/// The next stretch of a walk.
struct Leg {
    Ray ray;
    Spectrum throughput;
    float pdfSolidAngle;                    // of the direction; of a Dirac bounce its probability
    float heroStandsFor = Spectrum::lanes;  // as CameraSample's
    bool isHeroOnly = false;                // as PathVertex's
};

/// The density of that direction, or place, at the first vertex after the walk's origin is the
/// caller's to know.
template <class FirstDensity>
std::optional<Escape> walk(const Scene& scene, Transport transport, const Wavelengths& wavelengths,
                           const EstimatorSettings& settings, RandomStream& random, Leg leg,
                           std::size_t mostVertices, const FirstDensity& firstDensity,
                           std::vector<PathVertex>& path) {
    const auto own =
        transport == Transport::radiance ? &VertexDensity::fromCamera : &VertexDensity::fromLight;
    const auto other =
        transport == Transport::radiance ? &VertexDensity::fromLight : &VertexDensity::fromCamera;
    Spectrum attenuation(1.0f);
    while (path.size() < mostVertices) {
        const std::optional<SurfacePoint> hit = scene.closestHit(leg.ray);
        if (!hit) return Escape{leg.ray.direction, leg.throughput, leg.pdfSolidAngle};
        PathVertex& vertex = path.emplace_back();
        PathVertex& previous = path[path.size() - 2];
        vertex.point = *hit;
        vertex.wo = -leg.ray.direction;
        vertex.throughput = leg.throughput;
        vertex.isHeroOnly = leg.isHeroOnly;
        vertex.density.isConnectable = true;
        vertex.density.*own = path.size() == 2 ? firstDensity(vertex)
                                               : densityAt(vertex, previous, leg.pdfSolidAngle);
        if (path.size() == mostVertices) return {};

        const BsdfContext context{hit->uv, transport, wavelengths};
        const float uLobe = random.next();
        const std::optional<BsdfSample> next =
            sampleScattering(*hit, context, vertex.wo, uLobe, random.next2());
        if (!next) return {};
        if (next->isDirac) vertex.density.isConnectable = false;
        previous.density.*other = densityAt(previous, vertex, next->pdfSolidAngleReverse);
        leg.throughput *= next->weight;
        attenuation *= next->weight;
        if (next->isHeroOnly && !leg.isHeroOnly) {
            leg.throughput = heroAlone(leg.throughput, leg.heroStandsFor);
            leg.isHeroOnly = true;
        }
        const int depth = static_cast<int>(path.size()) - 1;
        if (settings.russianRouletteDepth > 0 && depth >= settings.russianRouletteDepth) {
            const float survival = std::min(1.0f, maxLane(attenuation));
            if (!(random.next() < survival)) return {};
            leg.throughput /= survival;
            attenuation /= survival;
        }
        leg.pdfSolidAngle = next->pdfSolidAngle;
        leg.ray = {offsetOrigin(*hit, next->wi), next->wi};
    }
    return {};
}

PathVertex::Kind kindOf(const Light& light, const EmittedRay& ray) {
    if (light.isInfinite()) return PathVertex::Kind::infinite;
    return ray.isDiracPosition ? PathVertex::Kind::point : PathVertex::Kind::emitter;
}

/// The vertex on the light, before it sent anything anywhere.
PathVertex emissionVertex(const Light& light, const EmittedRay& ray, float probability) {
    PathVertex vertex;
    vertex.kind = kindOf(light, ray);
    vertex.point = bareSurfacePoint(ray.origin, ray.originError, ray.normal);
    vertex.wo = -ray.direction;
    vertex.density.fromLight =
        probability * (light.isInfinite() ? ray.pdf.pdfSolidAngle : ray.pdf.pdfArea);
    vertex.density.isConnectable = true;
    return vertex;
}

}  // namespace

float densityAt(const PathVertex& to, const PathVertex& from, float pdfSolidAngle) {
    if (to.kind == PathVertex::Kind::infinite) return pdfSolidAngle;
    const Vec3d between = toDouble(to.point.position) - toDouble(from.point.position);
    const double squared = lengthSquared(between);
    if (squared == 0.0) return 0.0f;
    const double cosine =
        to.kind == PathVertex::Kind::point
            ? 1.0
            : absDot(toDouble(to.point.geometricNormal), between) / std::sqrt(squared);
    return static_cast<float>(pdfSolidAngle * cosine / squared);
}

void walkFromCamera(const Scene& scene, CameraSample& sample, const EstimatorSettings& settings,
                    CameraSubpath& path) {
    const CameraRay& ray = *sample.ray;
    path.vertices.clear();
    PathVertex& lens = path.vertices.emplace_back();
    lens.kind = PathVertex::Kind::lens;
    lens.point = bareSurfacePoint(ray.origin, {}, ray.direction);
    const Leg leg{{ray.origin, ray.direction}, sample.throughput, 0.0f, sample.heroStandsFor};
    const auto firstDensity = [&](const PathVertex& first) {
        return pdfArea(ray, length(first.point.position - ray.origin), first.point.geometricNormal);
    };
    path.escape =
        walk(scene, Transport::radiance, sample.color.wavelengths, settings, sample.random, leg,
             static_cast<std::size_t>(settings.maxDepth) + 1, firstDensity, path.vertices);
    if (path.escape && path.vertices.size() == 1) path.escape->pdfSolidAngle = pdfSolidAngle(ray);
}

void walkFromLight(const Scene& scene, const Wavelengths& wavelengths,
                   const EstimatorSettings& settings, RandomStream& random, LightSubpath& path) {
    path.vertices.clear();
    const float uLight = random.next();
    const Vec2 uPosition = random.next2(), uDirection = random.next2();
    const auto choice = scene.lights().sample(uLight);
    if (!choice) return;
    const Light& light = scene.lights()[choice->index];
    const auto emitted = light.emit(uPosition, uDirection);
    if (!emitted) return;
    path.light = choice->index;
    path.radiance = wavelengths.lanesOf(emitted->radiance);
    path.isDirac = emitted->isDiracPosition || emitted->isDiracDirection;
    path.vertices.push_back(emissionVertex(light, *emitted, choice->probability));
    const PathVertex& origin = path.vertices.front();

    const double pdfOrigin = choice->probability * static_cast<double>(emitted->pdf.pdfArea);
    const Leg leg{{offsetOrigin(origin.point, emitted->direction), emitted->direction},
                  path.radiance * static_cast<float>(emitted->cosTheta /
                                                     (pdfOrigin * emitted->pdf.pdfSolidAngle)),
                  emitted->pdf.pdfSolidAngle};
    const auto firstDensity = [&](const PathVertex& first) {
        if (!light.isInfinite())
            return densityAt(first, path.vertices.front(), emitted->pdf.pdfSolidAngle);
        return emitted->pdf.pdfArea * absDot(first.point.geometricNormal, emitted->direction);
    };
    walk(scene, Transport::importance, wavelengths, settings, random, leg,
         static_cast<std::size_t>(settings.maxDepth), firstDensity, path.vertices);
    if (path.isDirac) path.vertices.front().density.fromCamera = 0.0f;
}

}  // namespace etendue
