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

private:
    /// s ≥ 2, t = 1.
    void connectVertexToLens(std::size_t s, Vec2 apertureUniform, int lane) {
        const PathVertex& y = light_.vertices[s - 1];
        const auto connection =
            view_.camera.connect(y.point.position, apertureUniform, wavelengths_, lane);
        if (!connection || !isOnFilm(connection->film)) return;
        const Vec3 toLens = -connection->ray.direction;
        const Scattering scattering =
            scatteringBetween(y.point, sample_.contextAt(y, Transport::importance), y.wo, toLens);
        if (isBlack(scattering.value) || !isLensVisible(y.point, connection->ray)) return;
        JoinDensities join;
        join.lightEnd = pdfArea(connection->ray, connection->distance, y.point.geometricNormal);
        join.beforeLightEnd = lightOriginDensity(light_, s, y, scattering.pdfSolidAngleReverse);
        // `scattering` holds the cosine of the surface, so the importance is that across the ray.
        const Spectrum value = y.throughput * scattering.value *
                               importance(connection->ray, connection->distance, toLens);
        splat(s, lane, connection->film, value,
              weightOf(sample_, lens(), sample_.lightVertices(s), join));
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
        splat(1, lane, connection->film, value,
              weightOf(sample_, lens(), sample_.lightVertices(1), join));
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
        splat(1, lane, connection->film, value,
              weightOf(sample_, lens(), sample_.lightVertices(1), join));
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

    void splat(std::size_t s, int lane, Vec2 film, const Spectrum& value, float weight) {
        const bool isAlone = isParted(view_) && !light_.vertices[s - 1].isHeroOnly;
        const Spectrum landing =
            isAlone ? Spectrum::fromLanes([&](int i) { return i == lane ? value[i] : 0.0f; })
                    : value;
        sample_.result.contributions.push_back({.technique = {static_cast<int>(s), 1},
                                                .value = sample_.color.onFilm(landing),
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
