// Bidirectional path tracing, with light tracing as the part of it that connects to the lens.
// docs/bidirectional.md has the formulas.
#include <cmath>

#include "renderer/estimator.h"
#include "renderer/subpath.h"
#include "renderer/visibility.h"

namespace etendue {

namespace {

/// What a technique adds to the densities that the two walks already know: those of the last two
/// vertices of either walk, as the other walk would have drawn them. Where a walk has no such
/// vertex the number means nothing.
struct JoinDensities {
    float cameraEnd = 0.0f, beforeCameraEnd = 0.0f;  // fromLight
    float lightEnd = 0.0f, beforeLightEnd = 0.0f;    // fromCamera
};

using Vertices = std::span<const PathVertex>;

/// Memory that one sample leaves to the next.
struct Scratch {
    CameraSubpath camera;
    LightSubpath light;
    std::vector<VertexDensity> path;
};

/// One sample: two walks and all that is made of them.
class BidirectionalSample {
public:
    BidirectionalSample(const View& view, const SpectralSample& color,
                        const EstimatorSettings& settings, const TechniqueSet& techniques,
                        Sample& result, Scratch& scratch)
        : view_(view),
          color_(color),
          wavelengths_(color.wavelengths),
          settings_(settings),
          techniques_(techniques),
          lightPaths_(1.0 * settings.lightPaths * view.camera.settings().width *
                      view.camera.settings().height),
          result_(result),
          camera_(scratch.camera),
          light_(scratch.light),
          path_(scratch.path) {
        light_.vertices.clear();
    }

    void walkFromCameraOf(CameraSample& sample) {
        walkFromCamera(view_.scene, sample, settings_, camera_);
        camera_.vertices.front().density.isConnectable = isReachable(sample);
    }

    void walkFromLight(RandomStream& random) {
        etendue::walkFromLight(view_.scene, wavelengths_, settings_, random, light_);
    }

    /// All techniques with t = 1.
    void connectToLens(RandomStream& random) {
        for (std::size_t s = 1; s <= light_.vertices.size(); ++s) {
            const Vec2 apertureUniform = random.next2();
            if (!techniques_.contains({static_cast<int>(s), 1})) continue;
            const PathVertex& y = light_.vertices[s - 1];
            if (y.kind == PathVertex::Kind::surface && !canConnect(y)) continue;
            // Behind a dispersive lens every wavelength lands in a place of its own.
            const int connections = isParted(view_) && !y.isHeroOnly ? Spectrum::lanes : 1;
            for (int lane = 0; lane < connections; ++lane) {
                if (y.kind == PathVertex::Kind::infinite)
                    connectInfinityToLens(y, apertureUniform, lane);
                else if (s == 1)
                    connectEmissionToLens(y, apertureUniform, lane);
                else
                    connectVertexToLens(s, apertureUniform, lane);
            }
        }
    }

    /// All techniques with t ≥ 2.
    void connectSubpaths(const CameraSample& sample, RandomStream& random) {
        film_ = sample.film;
        for (std::size_t t = 2; t <= camera_.vertices.size(); ++t) {
            hitLight(t);
            nextEvent(t, random);
            const std::size_t most = static_cast<std::size_t>(settings_.maxDepth) + 1 - t;
            for (std::size_t s = 2; s <= std::min(light_.vertices.size(), most); ++s)
                connectVertices(s, t);
        }
        if (camera_.escape) escapeToLights();
    }

private:
    /// Whether connecting what the camera met first to the lens would find this very film point.
    /// If not, no technique with t = 1 makes this path.
    bool isReachable(const CameraSample& sample) const {
        // Far below the distance of two roots, far above the rounding of the vertex.
        constexpr float tolerance = 0.1f;  // pixels
        std::optional<CameraConnection> connection;
        if (camera_.vertices.size() >= 2) {
            if (!canConnect(camera_.vertices[1])) return false;
            connection = view_.camera.connect(camera_.vertices[1].point.position,
                                              sample.apertureUniform, wavelengths_);
        } else if (camera_.escape) {
            connection = view_.camera.connectToInfinity(camera_.escape->direction,
                                                        sample.apertureUniform, wavelengths_);
        }
        return connection && std::abs(connection->film.x - sample.film.x) < tolerance &&
               std::abs(connection->film.y - sample.film.y) < tolerance;
    }

    BsdfContext contextAt(const PathVertex& vertex, Transport transport) const {
        return {vertex.point.uv, transport, wavelengths_};
    }

    /// Of the path made of the first t camera and the first s light vertices.
    float weightOf(Vertices camera, Vertices light, const JoinDensities& join) {
        path_.clear();
        for (const PathVertex& v : camera) path_.push_back(v.density);
        for (std::size_t i = light.size(); i-- > 0;) path_.push_back(light[i].density);
        const std::size_t t = camera.size(), s = light.size();
        // Both ends take part with their continuous lobes, whatever the walks did there.
        path_[t - 1].fromLight = join.cameraEnd;
        if (t >= 2) path_[t - 1].isConnectable = true;
        if (t >= 3) path_[t - 2].fromLight = join.beforeCameraEnd;
        if (s >= 1) {
            path_[t].fromCamera = join.lightEnd;
            path_[t].isConnectable = true;
        }
        if (s >= 2) path_[t + 1].fromCamera = join.beforeLightEnd;
        // Through a dispersive lens connections are made at each of four wavelengths, paths at one;
        // unless a glass has left only one on either.
        const bool isInDispersion =
            camera.back().isInDispersion || (s > 0 && light.back().isInDispersion);
        const double lanes = isParted(view_) && !isInDispersion ? Spectrum::lanes : 1.0;
        return balanceWeight(path_, {static_cast<int>(s), static_cast<int>(t)},
                             {techniques_, lanes * lightPaths_});
    }

    void add(std::size_t s, std::size_t t, const Spectrum& value, float weight) {
        result_.contributions.push_back({.technique = {static_cast<int>(s), static_cast<int>(t)},
                                         .value = color_.onFilm(value),
                                         .weight = weight,
                                         .film = film_});
    }
    void splat(std::size_t s, int lane, Vec2 film, const Spectrum& value, float weight) {
        const bool isAlone = isParted(view_) && !light_.vertices[s - 1].isHeroOnly;
        const Spectrum landing =
            isAlone ? Spectrum::fromLanes([&](int i) { return i == lane ? value[i] : 0.0f; })
                    : value;
        result_.contributions.push_back({.technique = {static_cast<int>(s), 1},
                                         .value = color_.onFilm(landing),
                                         .weight = weight,
                                         .film = film,
                                         .isSplat = true});
    }
    bool isWanted(std::size_t s, std::size_t t) const {
        return techniques_.contains({static_cast<int>(s), static_cast<int>(t)});
    }
    Vertices cameraVertices(std::size_t t) const { return Vertices(camera_.vertices).first(t); }
    Vertices lightVertices(std::size_t s) const { return Vertices(light_.vertices).first(s); }

    /// s = 0: the camera's walk met an area light.
    void hitLight(std::size_t t) {
        const PathVertex& end = camera_.vertices[t - 1];
        if (end.point.light < 0 || !isWanted(0, t)) return;
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
        add(0, t, end.throughput * radiance, weightOf(cameraVertices(t), {}, join));
    }

    /// s = 0: the camera's walk left the scene, toward every light at infinity at once.
    void escapeToLights() {
        const Escape& escape = *camera_.escape;
        const std::size_t t = camera_.vertices.size() + 1;
        if (static_cast<int>(t) > settings_.maxDepth + 1 || !isWanted(0, t)) return;
        PathVertex& end = camera_.vertices.emplace_back();
        end.kind = PathVertex::Kind::infinite;
        end.density.fromCamera = escape.pdfSolidAngle;
        end.isInDispersion = escape.isInDispersion;
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
            add(0, t, escape.throughput * radiance, weightOf(cameraVertices(t), {}, join));
        }
        camera_.vertices.pop_back();
    }

    /// s = 1: a light sampled for the vertex. Always draws the same count of random numbers.
    void nextEvent(std::size_t t, RandomStream& random) {
        if (static_cast<int>(t) > settings_.maxDepth) return;
        const float uLight = random.next();
        const Vec2 u = random.next2();
        const PathVertex& end = camera_.vertices[t - 1];
        if (!canConnect(end) || !isWanted(1, t)) return;
        const auto choice = view_.scene.lights().sample(uLight);
        if (!choice) return;
        const Light& light = view_.scene.lights()[choice->index];
        const auto sample = light.sample(end.point.position, u);
        if (!sample) return;
        const Scattering scattering = scatteringBetween(
            end.point, contextAt(end, Transport::radiance), end.wo, sample->direction);
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
            weightOf(cameraVertices(t), Vertices(&onLight, 1), join));
    }

    /// s ≥ 2, t ≥ 2: vertices of the two walks see each other.
    void connectVertices(std::size_t s, std::size_t t) {
        const PathVertex& z = camera_.vertices[t - 1];
        const PathVertex& y = light_.vertices[s - 1];
        if (!isWanted(s, t) || !canConnect(z) || !canConnect(y)) return;
        const Vec3d between = toDouble(y.point.position) - toDouble(z.point.position);
        const double distanceSquared = lengthSquared(between);
        if (distanceSquared == 0.0) return;
        const Vec3 direction = toFloat(between / std::sqrt(distanceSquared));
        const Scattering atCamera =
            scatteringBetween(z.point, contextAt(z, Transport::radiance), z.wo, direction);
        if (isBlack(atCamera.value)) return;
        const Scattering atLight =
            scatteringBetween(y.point, contextAt(y, Transport::importance), y.wo, -direction);
        if (isBlack(atLight.value) || !isVisible(view_.scene, z.point, y.point)) return;

        JoinDensities join;
        join.cameraEnd = densityAt(z, y, atLight.pdfSolidAngle);
        join.beforeCameraEnd = densityAt(camera_.vertices[t - 2], z, atCamera.pdfSolidAngleReverse);
        join.lightEnd = densityAt(y, z, atCamera.pdfSolidAngle);
        join.beforeLightEnd = lightOriginDensity(s, y, atLight.pdfSolidAngleReverse);
        // Where each walk is left with the hero, each lets it stand for all four.
        const double stands = z.isHeroOnly && y.isHeroOnly ? 1.0 / Spectrum::lanes : 1.0;
        const Spectrum value = z.throughput * atCamera.value * atLight.value * y.throughput *
                               static_cast<float>(stands / distanceSquared);
        add(s, t, value, weightOf(cameraVertices(t), lightVertices(s), join));
    }

    /// fromCamera of light vertex s − 2, seen from `y`, its successor. No ray meets a Dirac light.
    float lightOriginDensity(std::size_t s, const PathVertex& y, float pdfSolidAngle) const {
        if (s == 2 && light_.isDirac) return 0.0f;
        return densityAt(light_.vertices[s - 2], y, pdfSolidAngle);
    }

    /// s ≥ 2, t = 1.
    void connectVertexToLens(std::size_t s, Vec2 apertureUniform, int lane) {
        const PathVertex& y = light_.vertices[s - 1];
        const auto connection =
            view_.camera.connect(y.point.position, apertureUniform, wavelengths_, lane);
        if (!connection || !isOnFilm(connection->film)) return;
        const Vec3 toLens = -connection->ray.direction;
        const Scattering scattering =
            scatteringBetween(y.point, contextAt(y, Transport::importance), y.wo, toLens);
        if (isBlack(scattering.value) || !isLensVisible(y.point, connection->ray)) return;
        JoinDensities join;
        join.lightEnd = pdfArea(connection->ray, connection->distance, y.point.geometricNormal);
        join.beforeLightEnd = lightOriginDensity(s, y, scattering.pdfSolidAngleReverse);
        // `scattering` holds the cosine of the surface, so the importance is that across the ray.
        const Spectrum value = y.throughput * scattering.value *
                               importance(connection->ray, connection->distance, toLens);
        splat(s, lane, connection->film, value, weightOf(lens(), lightVertices(s), join));
    }

    /// s = 1, t = 1: the light itself through the lens.
    void connectEmissionToLens(const PathVertex& y, Vec2 apertureUniform, int lane) {
        const auto connection =
            view_.camera.connect(y.point.position, apertureUniform, wavelengths_, lane);
        if (!connection || !isOnFilm(connection->film)) return;
        const CameraRay& ray = connection->ray;
        const Light& light = view_.scene.lights()[light_.light];
        const bool isPoint = y.kind == PathVertex::Kind::point;
        const Vec3 normal = isPoint ? ray.direction : y.point.geometricNormal;
        const Spectrum emitted = wavelengths_.lanesOf(
            isPoint ? intensityToward(light, ray.origin, connection->distance)
                    : light.radiance({ray.direction, connection->distance, normal}));
        if (isBlack(emitted) || !isLensVisible(y.point, ray)) return;
        JoinDensities join;
        join.lightEnd = isPoint ? 0.0f : pdfArea(ray, connection->distance, normal);
        const Spectrum value =
            emitted * (importance(ray, connection->distance, normal) / y.density.fromLight);
        splat(1, lane, connection->film, value, weightOf(lens(), lightVertices(1), join));
    }

    void connectInfinityToLens(const PathVertex& y, Vec2 apertureUniform, int lane) {
        const auto connection =
            view_.camera.connectToInfinity(y.wo, apertureUniform, wavelengths_, lane);
        if (!connection || !isOnFilm(connection->film)) return;
        const CameraRay& ray = connection->ray;
        if (!view_.scene.isVisibleToInfinity(ray.origin, ray.direction)) return;
        JoinDensities join;
        join.lightEnd = light_.isDirac ? 0.0f : pdfSolidAngle(ray);
        const Spectrum value =
            light_.radiance * (ray.weight * pdfSolidAngle(ray) / y.density.fromLight);
        splat(1, lane, connection->film, value, weightOf(lens(), lightVertices(1), join));
    }

    /// W/sr, from the irradiance of a light that is a point.
    static Spectrum intensityToward(const Light& light, Vec3 receiver, float distance) {
        const auto sample = light.sample(receiver, {});
        return sample ? sample->radiance * (distance * distance) : Spectrum();
    }

    bool isLensVisible(const SurfacePoint& point, const CameraRay& ray) const {
        return isVisible(view_.scene, point, bareSurfacePoint(ray.origin, {}, ray.direction));
    }

    /// Whether the filter of any pixel reaches `film`.
    bool isOnFilm(Vec2 film) const {
        const float margin = view_.filter.radius() - 0.5f;
        const CameraSettings& frame = view_.camera.settings();
        return film.x >= -margin && film.x < static_cast<float>(frame.width) + margin &&
               film.y >= -margin && film.y < static_cast<float>(frame.height) + margin;
    }

    Vertices lens() const { return Vertices(&lens_, 1); }

    static PathVertex connectableLens() {
        PathVertex lens;
        lens.kind = PathVertex::Kind::lens;
        lens.density.isConnectable = true;
        return lens;
    }

    const View& view_;
    const SpectralSample& color_;
    const Wavelengths& wavelengths_;
    const EstimatorSettings& settings_;
    const TechniqueSet& techniques_;
    double lightPaths_;  // of one sample of the whole frame
    Sample& result_;
    CameraSubpath& camera_;
    LightSubpath& light_;
    std::vector<VertexDensity>& path_;
    PathVertex lens_ = connectableLens();
    Vec2 film_;
};

class Bidirectional final : public Estimator {
public:
    Bidirectional(const EstimatorSettings& settings, TechniqueSet techniques)
        : settings_(settings),
          needsCamera_(techniques.needsCameraWalk(settings.maxDepth)),
          needsLight_(techniques.needsLightWalk(settings.maxDepth)),
          techniques_(std::move(techniques)) {}

    void takeSample(const View& view, SampleId id, SampleRequest request,
                    Sample& result) const override {
        result.contributions.clear();
        result.firstHit.reset();
        const SpectralSample color = drawWavelengths(view, id);
        static thread_local Scratch scratch;
        BidirectionalSample sample(view, color, settings_, techniques_, result, scratch);
        // The last light path is the one that the camera's is connected to.
        for (int i = 0; i < lightPathsPerSample(); ++i) {
            RandomStream random = lightPathRandom(view, id, i, settings_.lightPaths);
            sample.walkFromLight(random);
            sample.connectToLens(random);
        }
        if (!request.ownPixel) return;
        if (!needsCamera_ && !request.firstHit) return;
        CameraSample camera = drawCameraSample(view, id);
        if (!camera.ray) return;
        if (request.firstHit) result.firstHit = firstHitOf(view.scene, *camera.ray);
        if (!needsCamera_) return;
        sample.walkFromCameraOf(camera);
        sample.connectSubpaths(camera, camera.random);
    }

    int lightPathsPerSample() const override { return needsLight_ ? settings_.lightPaths : 0; }

private:
    EstimatorSettings settings_;
    bool needsCamera_, needsLight_;
    TechniqueSet techniques_;
};

}  // namespace

std::unique_ptr<Estimator> makeLightTracer(const EstimatorSettings& settings) {
    return std::make_unique<Bidirectional>(settings, TechniqueSet::lightTracing());
}

std::unique_ptr<Estimator> makeBidirectional(const EstimatorSettings& settings) {
    return std::make_unique<Bidirectional>(settings, settings.techniques);
}

}  // namespace etendue
