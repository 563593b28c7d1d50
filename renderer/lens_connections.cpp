// The techniques with t = 1: vertices of a light path, connected to the lens.
#include "renderer/bidirectional_sample.h"
#include "renderer/visibility.h"

namespace etendue {

namespace {

class LensConnections {
public:
    explicit LensConnections(BidirectionalSample& sample)
        : sample_(sample),
          view_(sample.view),
          wavelengths_(sample.color.wavelengths),
          light_(sample.memory.light) {
        lens_.kind = PathVertex::Kind::lens;
        lens_.density.isConnectable = true;
    }

    void makeAll(RandomStream& random) {
        for (std::size_t s = 1; s <= light_.vertices.size(); ++s) {
            const Vec2 apertureUniform = random.next2();
            if (!sample_.wants(s, 1)) continue;
            const PathVertex& y = light_.vertices[s - 1];
            if (y.kind == PathVertex::Kind::surface && !canConnect(y)) continue;
            if (s >= 2 && isTurnedAway(y)) continue;
            const Camera& camera = view_.camera;
            const bool isInfinite = y.kind == PathVertex::Kind::infinite;
            if (partsColors(y)) {
                const CameraConnections each =
                    isInfinite
                        ? camera.connectEachToInfinity(y.wo, apertureUniform, wavelengths_)
                        : camera.connectEach(y.point.position, apertureUniform, wavelengths_);
                for (std::size_t lane = 0; lane < each.size(); ++lane)
                    if (each[lane]) add(s, lane, *each[lane]);
            } else {
                const auto hero =
                    isInfinite ? camera.connectToInfinity(y.wo, apertureUniform, wavelengths_)
                               : camera.connect(y.point.position, apertureUniform, wavelengths_);
                if (hero) add(s, 0, *hero);
            }
        }
    }

private:
    /// Whether no light can be scattered to the lens, which may take long to be found.
    bool isTurnedAway(const PathVertex& y) const {
        if (y.point.material->bsdf->isTransmitting()) return false;
        const Vec3 normal = y.point.geometricNormal;
        return view_.camera.isBehind(y.point.position, dot(normal, y.wo) > 0.0f ? normal : -normal);
    }

    /// Whether every wavelength lands in a place of its own: behind a dispersive lens.
    bool partsColors(const PathVertex& y) const { return isParted(view_) && !y.isHeroOnly; }

    void add(std::size_t s, std::size_t lane, const CameraConnection& connection) {
        if (!isOnFilm(view_, connection.film)) return;
        if (light_.vertices[s - 1].kind == PathVertex::Kind::infinite)
            addInfinity(lane, connection);
        else if (s == 1)
            addEmission(lane, connection);
        else
            addVertex(s, lane, connection);
    }

    /// s ≥ 2, t = 1.
    void addVertex(std::size_t s, std::size_t lane, const CameraConnection& connection) {
        const PathVertex& y = light_.vertices[s - 1];
        const Vec3 toLens = -connection.ray.direction;
        const Scattering scattering =
            scatteringBetween(y.point, sample_.contextAt(y, Transport::importance), y.wo, toLens);
        if (isBlack(scattering.value) || !isLensVisible(y.point, connection.ray)) return;
        JoinDensities join;
        join.lightEnd = pdfArea(connection.ray, connection.distance, y.point.geometricNormal);
        join.beforeLightEnd = lightOriginDensity(light_, s, y, scattering.pdfSolidAngleReverse);
        // `scattering` holds the cosine of the surface, so the importance is that across the ray.
        const Spectrum value = y.throughput * scattering.value *
                               importance(connection.ray, connection.distance, toLens);
        splat(s, lane, connection.film, value,
              weightOf(sample_, lens(), sample_.lightVertices(s), join).value());
    }

    /// s = 1, t = 1: the light itself through the lens.
    void addEmission(std::size_t lane, const CameraConnection& connection) {
        const PathVertex& y = light_.vertices[0];
        const CameraRay& ray = connection.ray;
        const Light& light = view_.scene.lights()[light_.light];
        const bool isPoint = y.kind == PathVertex::Kind::point;
        const Vec3 normal = isPoint ? ray.direction : y.point.geometricNormal;
        const Spectrum emitted = wavelengths_.lanesOf(
            isPoint ? intensityToward(light, ray.origin, connection.distance)
                    : light.radiance({ray.direction, connection.distance, normal}));
        if (isBlack(emitted) || !isLensVisible(y.point, ray)) return;
        JoinDensities join;
        join.lightEnd = isPoint ? 0.0f : pdfArea(ray, connection.distance, normal);
        const Spectrum value =
            emitted * (importance(ray, connection.distance, normal) / y.density.fromLight);
        splat(1, lane, connection.film, value,
              weightOf(sample_, lens(), sample_.lightVertices(1), join).value());
    }

    void addInfinity(std::size_t lane, const CameraConnection& connection) {
        const PathVertex& y = light_.vertices[0];
        const CameraRay& ray = connection.ray;
        if (!view_.scene.isVisibleToInfinity(ray.origin, ray.direction)) return;
        JoinDensities join;
        join.lightEnd = light_.isDirac ? 0.0f : pdfSolidAngle(ray);
        const Spectrum value =
            light_.radiance * (ray.weight * pdfSolidAngle(ray) / y.density.fromLight);
        splat(1, lane, connection.film, value,
              weightOf(sample_, lens(), sample_.lightVertices(1), join).value());
    }

    /// W/sr, from the irradiance of a light that is a point.
    static Spectrum intensityToward(const Light& light, Vec3 receiver, float distance) {
        const auto sample = light.sample(receiver, {});
        return sample ? sample->radiance * (distance * distance) : Spectrum();
    }

    bool isLensVisible(const SurfacePoint& point, const CameraRay& ray) const {
        return isVisible(view_.scene, point, bareSurfacePoint(ray.origin, {}, ray.direction));
    }

    void splat(std::size_t s, std::size_t lane, Vec2 film, const Spectrum& value, float weight) {
        const Spectrum landing = partsColors(light_.vertices[s - 1])
                                     ? sample_.color.onFilm(lane, value[static_cast<int>(lane)])
                                     : sample_.color.onFilm(value);
        sample_.result.contributions.push_back({.technique = {static_cast<int>(s), 1},
                                                .value = landing,
                                                .weight = weight,
                                                .film = film,
                                                .isSplat = true});
    }

    std::span<const PathVertex> lens() const { return std::span(&lens_, 1); }

    BidirectionalSample& sample_;
    const View& view_;
    const Wavelengths& wavelengths_;
    const LightSubpath& light_;
    PathVertex lens_;
};

}  // namespace

void connectToLens(BidirectionalSample& sample, RandomStream& random) {
    LensConnections(sample).makeAll(random);
}

}  // namespace etendue
