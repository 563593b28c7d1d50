// The techniques with t ≥ 2: a camera path that meets a light (s = 0), is given one (s = 1), or is
// joined to a light path.
#include <cmath>

#include "renderer/bidirectional_sample.h"
#include "renderer/visibility.h"

namespace etendue {

namespace {

class SubpathConnections {
public:
    SubpathConnections(BidirectionalSample& sample, CameraSample& start)
        : sample_(sample),
          view_(sample.view),
          wavelengths_(sample.color.wavelengths),
          start_(start),
          camera_(sample.memory.camera),
          light_(sample.memory.light) {
        const LaneFlags isReachable = reachableLanes(view_, start_, camera_);
        camera_.vertices.front().density.isConnectable = isReachable[0];
        for (std::size_t lane = 0; lane < isReachable.size(); ++lane)
            if (isReachable[lane]) lensFactors_[lane] = lensFactor(lane);
    }

    void makeAll() {
        for (std::size_t t = 2; t <= camera_.vertices.size(); ++t) {
            hitLight(t);
            nextEvent(t, start_.random);
            const std::size_t most = static_cast<std::size_t>(sample_.settings.maxDepth) + 1 - t;
            for (std::size_t s = 2; s <= std::min(light_.vertices.size(), most); ++s)
                connectVertices(s, t);
        }
        if (camera_.escape) escapeToLights();
    }

private:
    /// How much denser techniques with t = 1 are, against those from the lens, in a lane than in
    /// the hero's: as camera samples are less dense, where the ray comes from at its wavelength.
    double lensFactor(std::size_t lane) const {
        if (lane == 0) return 1.0;
        const bool isEscape = camera_.vertices.size() < 2;
        const CameraRay &hero = *start_.ray, &ray = (*start_.origins)[lane]->ray;
        const auto density = [&](const CameraRay& from) -> double {
            return isEscape
                       ? pdfSolidAngle(from)
                       : pdfArea(from, length(camera_.vertices[1].point.position - from.origin),
                                 from.direction);
        };
        return density(hero) / density(ray);
    }

    /// s = 0: the camera's walk met an area light.
    void hitLight(std::size_t t) {
        const PathVertex& end = camera_.vertices[t - 1];
        if (end.point.light < 0 || !sample_.wants(0, t)) return;
        const PathVertex& before = camera_.vertices[t - 2];
        const EmitterHit hit{-end.wo, length(end.point.position - before.point.position),
                             end.point.geometricNormal};
        const Light& light = view_.scene.lights()[end.point.light];
        const Spectrum radiance = wavelengths_.lanesOf(light.radiance(hit));
        if (isBlack(radiance)) return;
        const float probability = view_.scene.lights().probability(end.point.light);
        const EmissionPdf emission = light.emissionPdf(hit);
        JoinDensities join;
        join.cameraEnd = probability * emission.pdfArea;
        join.beforeCameraEnd = densityAt(before, end, emission.pdfSolidAngle);
        add(0, t, end.throughput * radiance,
            weightOf(sample_, sample_.cameraVertices(t), {}, join));
    }

    /// s = 0: the camera's walk left the scene, toward every light at infinity at once.
    void escapeToLights() {
        const Escape& escape = *camera_.escape;
        const std::size_t t = camera_.vertices.size() + 1;
        if (static_cast<int>(t) > sample_.settings.maxDepth + 1 || !sample_.wants(0, t)) return;
        PathVertex& end = camera_.vertices.emplace_back();
        end.kind = PathVertex::Kind::infinite;
        end.density.fromCamera = escape.pdfSolidAngle;
        const PathVertex& last = camera_.vertices[t - 2];
        const EmitterHit hit{escape.direction, std::numeric_limits<float>::infinity(),
                             -escape.direction};
        for (const int index : view_.scene.lights().infiniteLights()) {
            const Light& light = view_.scene.lights()[index];
            const Spectrum radiance = wavelengths_.lanesOf(light.radiance(hit));
            if (isBlack(radiance)) continue;
            const EmissionPdf emission = light.emissionPdf(hit);
            JoinDensities join;
            join.cameraEnd = view_.scene.lights().probability(index) * light.pdfSolidAngle(hit);
            join.beforeCameraEnd =
                emission.pdfArea * absDot(last.point.geometricNormal, escape.direction);
            add(0, t, escape.throughput * radiance,
                weightOf(sample_, sample_.cameraVertices(t), {}, join));
        }
        camera_.vertices.pop_back();
    }

    /// s = 1: a light sampled for the vertex. Always draws the same count of random numbers.
    void nextEvent(std::size_t t, RandomStream& random) {
        if (static_cast<int>(t) > sample_.settings.maxDepth) return;
        const float uLight = random.next();
        const Vec2 u = random.next2();
        const PathVertex& end = camera_.vertices[t - 1];
        if (!canConnect(end) || !sample_.wants(1, t)) return;
        const auto choice = view_.scene.lights().sample(uLight);
        if (!choice) return;
        const Light& light = view_.scene.lights()[choice->index];
        const auto sample = light.sample(end.point.position, u);
        if (!sample) return;
        const Scattering scattering = scatteringBetween(
            end.point, sample_.contextAt(end, Transport::radiance), end.wo, sample->direction);
        if (isBlack(scattering.value) || !isVisible(view_.scene, end.point, *sample)) return;

        // The densities of the vertex on the light are kept per solid angle at the receiver.
        const float lightPdf = choice->probability * sample->pdfSolidAngle;
        PathVertex onLight;
        onLight.kind = light.isInfinite() ? PathVertex::Kind::infinite : PathVertex::Kind::emitter;
        onLight.point.position = sample->position;
        onLight.density.fromLight = lightPdf;
        const EmissionPdf emission =
            light.emissionPdf({sample->direction, sample->distance, sample->normal});
        JoinDensities join;
        join.lightEnd = sample->isDirac ? 0.0f : scattering.pdfSolidAngle;
        join.cameraEnd = light.isInfinite() ? emission.pdfArea * absDot(end.point.geometricNormal,
                                                                        sample->direction)
                                            : densityAt(end, onLight, emission.pdfSolidAngle);
        join.beforeCameraEnd =
            densityAt(camera_.vertices[t - 2], end, scattering.pdfSolidAngleReverse);
        add(1, t,
            end.throughput * scattering.value * wavelengths_.lanesOf(sample->radiance) / lightPdf,
            weightOf(sample_, sample_.cameraVertices(t), std::span(&onLight, 1), join));
    }

    /// s ≥ 2, t ≥ 2: vertices of the two walks see each other.
    void connectVertices(std::size_t s, std::size_t t) {
        const PathVertex& z = camera_.vertices[t - 1];
        const PathVertex& y = light_.vertices[s - 1];
        if (!sample_.wants(s, t) || !canConnect(z) || !canConnect(y)) return;
        const Vec3d between = toDouble(y.point.position) - toDouble(z.point.position);
        const double distanceSquared = lengthSquared(between);
        if (distanceSquared == 0.0) return;
        const Vec3 direction = toFloat(between / std::sqrt(distanceSquared));
        const Scattering atCamera =
            scatteringBetween(z.point, sample_.contextAt(z, Transport::radiance), z.wo, direction);
        if (isBlack(atCamera.value)) return;
        const Scattering atLight = scatteringBetween(
            y.point, sample_.contextAt(y, Transport::importance), y.wo, -direction);
        if (isBlack(atLight.value) || !isVisible(view_.scene, z.point, y.point)) return;

        JoinDensities join;
        join.cameraEnd = densityAt(z, y, atLight.pdfSolidAngle);
        join.beforeCameraEnd = densityAt(camera_.vertices[t - 2], z, atCamera.pdfSolidAngleReverse);
        join.lightEnd = densityAt(y, z, atCamera.pdfSolidAngle);
        join.beforeLightEnd = lightOriginDensity(light_, s, y, atLight.pdfSolidAngleReverse);
        // Where the light path is left with the hero, which stands for all four there, so it does
        // for the camera's, be it left with the hero or not.
        const double stands =
            !y.isHeroOnly ? 1.0
                          : (z.isHeroOnly ? 1.0 : double{start_.heroStandsFor}) / Spectrum::lanes;
        const Spectrum value = z.throughput * atCamera.value * atLight.value * y.throughput *
                               static_cast<float>(stands / distanceSquared);
        add(s, t, value,
            weightOf(sample_, sample_.cameraVertices(t), sample_.lightVertices(s), join));
    }

    void add(std::size_t s, std::size_t t, const Spectrum& value, const PathWeight& weight) {
        LaneWeights weights;
        for (std::size_t lane = 0; lane < weights.size(); ++lane)
            weights[lane] = weight.value(lensFactors_[lane]);
        contribute(start_, {static_cast<int>(s), static_cast<int>(t)}, value, weights,
                   sample_.result.contributions);
    }

    BidirectionalSample& sample_;
    const View& view_;
    const Wavelengths& wavelengths_;
    CameraSample& start_;
    CameraSubpath& camera_;
    const LightSubpath& light_;
    std::array<double, Spectrum::lanes> lensFactors_{};  // of PathWeight; 0 where unreachable
};

}  // namespace

void connectSubpaths(BidirectionalSample& sample, CameraSample& camera) {
    SubpathConnections(sample, camera).makeAll();
}

}  // namespace etendue
