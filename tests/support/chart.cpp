#include "tests/support/chart.h"

#include <cmath>
#include <numbers>

#include "lens/sensor_fits.h"
#include "renderer/emission_disc.h"
#include "renderer/estimator.h"
#include "renderer/film.h"
#include "renderer/parallel.h"
#include "renderer/render.h"

namespace etendue {

namespace {

/// The chart as a light: pt meets it where a ray ends, lt emits from it.
class ChartLight final : public Light {
public:
    ChartLight(const Chart& chart, BoundingSphere scene)
        : chart_(chart),
          scene_(scene),
          oneMinusCosMax_(static_cast<float>(1.0 - chart.leastCosine)) {}

    float power() const override { return 1.0f; }
    bool isInfinite() const override { return true; }
    Spectrum radiance(const EmitterHit& hit) const override { return towards(hit.direction); }
    float pdfSolidAngle(const EmitterHit& hit) const override {
        return isInCone(hit.direction) ? conePdfSolidAngle(oneMinusCosMax_) : 0.0f;
    }
    EmissionPdf emissionPdf(const EmitterHit& hit) const override {
        return {emissionDiscPdfArea(scene_), pdfSolidAngle(hit)};
    }

    std::optional<LightSample> sample(Vec3, Vec2 u) const override {
        const Vec3 direction = sampleCone(u, oneMinusCosMax_);
        return LightSample{.direction = direction,
                           .distance = std::numeric_limits<float>::infinity(),
                           .position = {},
                           .positionError = {},
                           .normal = -direction,
                           .radiance = towards(direction),
                           .pdfSolidAngle = conePdfSolidAngle(oneMinusCosMax_)};
    }

    std::optional<EmittedRay> emit(Vec2 uPosition, Vec2 uDirection) const override {
        const Vec3 from = sampleCone(uDirection, oneMinusCosMax_);
        EmittedRay ray;
        ray.direction = -from;
        ray.origin = sampleEmissionDisc(scene_, ray.direction, uPosition);
        ray.normal = ray.direction;
        ray.radiance = towards(from);
        ray.pdf = {emissionDiscPdfArea(scene_), conePdfSolidAngle(oneMinusCosMax_)};
        return ray;
    }

private:
    bool isInCone(Vec3 d) const { return static_cast<double>(d.z) >= chart_.leastCosine; }
    Spectrum towards(Vec3 d) const {
        const auto value = static_cast<float>(
            chart_.radiance(Eigen::Vector3d(double{d.x}, double{d.y}, double{d.z})));
        return {value, value, value, 0.0f};
    }

    Chart chart_;
    BoundingSphere scene_;
    float oneMinusCosMax_;
};

}  // namespace

double Chart::radiance(const Eigen::Vector3d& d) const {
    if (!(d.z() >= leastCosine)) return 0.0;
    const Eigen::Vector2d phase = wavenumber * fieldCoordinates(d);
    return 1.0 + amplitude * (std::sin(phase.x()) + std::sin(phase.y()));
}

Eigen::Vector3d Chart::gradient(const Eigen::Vector3d& d) const {
    const double scale = std::sqrt(2.0 / (1.0 + d.z()));
    const Eigen::Vector2d phase = wavenumber * fieldCoordinates(d);
    const Eigen::Vector2d byField =
        amplitude * wavenumber * Eigen::Vector2d(std::cos(phase.x()), std::cos(phase.y()));
    const double byZ = -0.5 * scale / (1.0 + d.z()) * byField.dot(d.head<2>());
    return {scale * byField.x(), scale * byField.y(), byZ};
}

double Chart::mostSecondOrder(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    // Of the waves, and of the coordinates u = (x, y) g(z) with g = √(2 / (1 + z)), |(x, y)| ≤ 1.
    const double across = (fieldCoordinates(to) - fieldCoordinates(from)).squaredNorm();
    const double scale = std::sqrt(2.0 / (1.0 + from.z()));
    const double byZ = 0.5 * scale / (1.0 + from.z()), byZTwice = 1.5 * byZ / (1.0 + from.z());
    const double bend = (byZ + 0.5 * byZTwice) * (to - from).squaredNorm();
    return amplitude * wavenumber * (0.5 * wavenumber * across + std::numbers::sqrt2 * bend);
}

std::unique_ptr<Scene> chartScene(const Chart& chart) {
    SceneParts parts;
    parts.lights.emplace_back(
        [chart](BoundingSphere bounds) { return std::make_unique<ChartLight>(chart, bounds); });
    return std::make_unique<Scene>(std::move(parts), 1);
}

std::vector<PixelMap> renderChart(const Scene& scene, const Camera& camera, const char* kind,
                                  std::uint32_t samples, std::uint64_t firstSeed, int seeds) {
    EstimatorSettings estimatorSettings;
    estimatorSettings.kind = kind;
    estimatorSettings.maxDepth = 1;
    const auto estimator = makeEstimator(estimatorSettings);
    const int width = camera.settings().width, height = camera.settings().height;
    std::vector<PixelMap> maps;
    for (int i = 0; i < seeds; ++i) {
        Film film({width, height, 0, 0, width, height});
        RenderSettings settings;
        settings.samples = samples;
        settings.seed = firstSeed + static_cast<std::uint64_t>(i);
        settings.threads = hardwareThreads();
        const RenderResult result =
            render(scene, camera, *estimator, Filter(FilterKind::box), film, settings, {});
        if (result.badSampleCount > 0) throw std::runtime_error("the chart had bad samples");
        // The sums themselves: a picture's floats would round what is compared here.
        const FilmState& state = film.state();
        PixelMap& map = maps.emplace_back();
        for (std::size_t p = 0; p < static_cast<std::size_t>(width * height); ++p) {
            map.push_back(state.colorSums[p].value().x / static_cast<double>(state.samples));
        }
    }
    return maps;
}

}  // namespace etendue
