// The weights of bidirectional path tracing on the paths of every scene, against densities computed
// anew from the paths' vertices and multiplied up for each technique.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "renderer/bidirectional_sample.h"
#include "renderer/parallel.h"
#include "renderer/scattering.h"
#include "tests/lens/prescriptions.h"
#include "tests/support/scenes.h"
#include "tests/tools/every_material_scene.h"
#include "tools/sample_path.h"

using namespace etendue;

namespace {

/// A whole path from the lens to a light, x₁ … x_k, with the density of every vertex as each walk
/// would have drawn it.
struct Vertex {
    PathVertex::Kind kind;
    SurfacePoint point;
    Vec3 toCamera, toLight;     // unit
    bool isDirac = false;       // passed by a Dirac bounce
    VertexDensity stored = {};  // by the walk that drew it
    double fromCamera = 0.0, fromLight = 0.0;
};

struct Path {
    std::vector<Vertex> vertices;
    CameraRay ray;  // from x₀
    bool isLensConnectable = false;
    int light = -1;
    Technique technique;
};

Vertex vertexOf(const PathVertex& v) {
    Vertex vertex{v.kind, v.point, {}, {}};
    vertex.isDirac = !v.density.isConnectable;
    vertex.stored = v.density;
    return vertex;
}

Vec3 directionBetween(const Vertex& from, const Vertex& to) {
    return toFloat(normalize(toDouble(to.point.position) - toDouble(from.point.position)));
}

/// Per solid angle at `from` to the measure of `to`.
double converted(double pdfSolidAngle, const Vertex& from, const Vertex& to) {
    if (to.kind == PathVertex::Kind::infinite) return pdfSolidAngle;
    const Vec3d between = toDouble(to.point.position) - toDouble(from.point.position);
    // The cosine between positions, too: near each other their rounding turns the direction that
    // was drawn, for this density and every other one of the path.
    const double cosine = to.kind == PathVertex::Kind::point
                              ? 1.0
                              : absDot(toDouble(to.point.geometricNormal), normalize(between));
    return pdfSolidAngle * cosine / lengthSquared(between);
}

void setDirections(Path& path) {
    std::vector<Vertex>& x = path.vertices;
    x.front().toCamera = -path.ray.direction;
    const auto isSet = [](Vec3 v) { return lengthSquared(v) > 0.0f; };
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        // The walk's own direction where there is one: positions are rounded.
        const Vec3 direction = isSet(x[i].toLight)        ? x[i].toLight
                               : isSet(x[i + 1].toCamera) ? -x[i + 1].toCamera
                                                          : directionBetween(x[i], x[i + 1]);
        x[i].toLight = direction;
        x[i + 1].toCamera = -direction;
    }
}

void setDensities(const View& view, const Wavelengths& wavelengths, Path& path) {
    std::vector<Vertex>& x = path.vertices;
    const std::size_t k = x.size();  // x[i] is x_{i + 1}
    const auto pdfOf = [&](const Vertex& v, Transport transport, Vec3 wo, Vec3 wi) {
        return static_cast<double>(
            scatteringBetween(v.point, {v.point.uv, transport, wavelengths}, wo, wi).pdfSolidAngle);
    };
    const double distance = length(toDouble(x[0].point.position) - toDouble(path.ray.origin));
    x[0].fromCamera =
        x[0].kind == PathVertex::Kind::infinite
            ? pdfSolidAngle(path.ray)
            : pdfArea(path.ray, static_cast<float>(distance),
                      x[0].kind == PathVertex::Kind::point ? path.ray.direction
                                                           : x[0].point.geometricNormal);
    for (std::size_t i = 1; i < k; ++i)
        x[i].fromCamera = x[i - 1].isDirac ? x[i].stored.fromCamera
                                           : converted(pdfOf(x[i - 1], Transport::radiance,
                                                             x[i - 1].toCamera, x[i - 1].toLight),
                                                       x[i - 1], x[i]);
    const Light& light = view.scene.lights()[path.light];
    const double probability = view.scene.lights().probability(path.light);
    Vertex& end = x.back();
    const bool isInfinite = end.kind == PathVertex::Kind::infinite;
    const Vec3 toLight = -end.toCamera;
    const double lastLength =
        k == 1 ? distance
               : length(toDouble(end.point.position) - toDouble(x[k - 2].point.position));
    const EmissionPdf emission = light.emissionPdf(
        {toLight,
         isInfinite ? std::numeric_limits<float>::infinity() : static_cast<float>(lastLength),
         isInfinite ? -toLight : end.point.geometricNormal});
    end.fromLight = probability * (isInfinite ? emission.pdfSolidAngle : emission.pdfArea);
    if (k >= 2)
        x[k - 2].fromLight =
            isInfinite ? emission.pdfArea *
                             absDot(toDouble(x[k - 2].point.geometricNormal), toDouble(toLight))
                       : converted(emission.pdfSolidAngle, end, x[k - 2]);
    for (std::size_t i = k - 1; i-- > 1;)
        x[i - 1].fromLight =
            x[i].isDirac
                ? x[i - 1].stored.fromLight
                : converted(pdfOf(x[i], Transport::importance, x[i].toLight, x[i].toCamera), x[i],
                            x[i - 1]);
    // No ray finds a light without extent, or without width.
    const auto emitted = light.emit({0.5f, 0.5f}, {0.5f, 0.5f});
    if (!emitted || emitted->isDiracPosition || emitted->isDiracDirection) end.fromCamera = 0.0;
}

/// By all techniques, from the products themselves, in logarithms; and the sum of what
/// balanceWeight gives each of them.
struct Weights {
    double own = 0.0, sum = 0.0;
};
Weights weightsOf(const Path& path, const SampleCounts& counts) {
    const std::vector<Vertex>& x = path.vertices;
    const int k = static_cast<int>(x.size());
    std::vector<VertexDensity> densities{{0.0f, 0.0f, path.isLensConnectable}};
    for (const Vertex& v : x)
        densities.push_back(
            {static_cast<float>(v.fromCamera), static_cast<float>(v.fromLight), !v.isDirac});
    std::vector<double> logs;
    double most = -std::numeric_limits<double>::infinity(), own = most;
    Weights weights;
    for (int t = 1; t <= k + 1; ++t) {
        const Technique technique{k + 1 - t, t};
        const bool isJoined = technique.s > 0;
        const bool lastIsOpen =
            t == 1 ? path.isLensConnectable : !x[static_cast<std::size_t>(t - 2)].isDirac;
        if (isJoined && !(lastIsOpen && !x[static_cast<std::size_t>(t - 1)].isDirac)) continue;
        double log = std::log(counts(technique));
        for (int i = 1; i <= k; ++i) {
            const Vertex& v = x[static_cast<std::size_t>(i - 1)];
            log += std::log(i < t ? v.fromCamera : v.fromLight);
        }
        if (!(log > -std::numeric_limits<double>::infinity())) continue;
        logs.push_back(log);
        most = std::max(most, log);
        if (technique == path.technique) own = log;
        weights.sum += balanceWeight(densities, technique, counts).value();
    }
    double all = 0.0;
    for (const double log : logs) all += std::exp(log - most);
    weights.own = std::exp(own - most) / all;
    return weights;
}

/// What the estimator's own random numbers made of each contribution, found again.
class Paths {
public:
    Paths(const LoadedScene& loaded, const View& view, SampleId id)
        : loaded_(loaded), view_(view), id_(id), estimator_(makeEstimator(loaded.estimator)) {}

    /// check(path, wavelengths, the estimator's weight)
    template <class Check>
    void forEach(const Check& check) {
        retraceSample(view_, *estimator_, loaded_.estimator, id_, sample_);
        markReachability(view_, sample_);
        drawAgain();
        for (const Contribution& c : sample_.contributions) {
            const auto path = c.technique.t == 1 ? splatted(c) : gathered(c);
            if (path) check(*path, wavelengths_, c.weight);
        }
    }

private:
    struct NextEvent {
        int light = -1;
        LightSample sample;
    };

    void drawAgain() {
        wavelengths_ = drawWavelengths(view_, id_).wavelengths;
        RandomStream lightRandom = lightPathRandom(view_, id_, 0, 1);
        LightSubpath again;
        walkFromLight(view_.scene, wavelengths_, loaded_.estimator, lightRandom, again);
        apertureUniforms_.clear();
        for (std::size_t s = 0; s < again.vertices.size(); ++s)
            apertureUniforms_.push_back(lightRandom.next2());
        nextEvents_.clear();
        const std::vector<PathVertex>& camera = sample_.cameraPath.vertices;
        if (camera.empty()) return;
        // Where the walk leaves off the draws of next-event estimation begin.
        CameraSample start = drawCameraSample(view_, id_);
        CameraSubpath walked;
        walkFromCamera(view_.scene, start, loaded_.estimator, walked);
        for (std::size_t t = 2;
             t <= camera.size() && static_cast<int>(t) <= loaded_.estimator.maxDepth; ++t) {
            const float uLight = start.random.next();
            const Vec2 u = start.random.next2();
            NextEvent event;
            if (const auto choice = view_.scene.lights().sample(uLight))
                if (const auto drawn =
                        view_.scene.lights()[choice->index].sample(camera[t - 1].point.position, u))
                    event = {choice->index, *drawn};
            nextEvents_.push_back(event);
        }
    }

    /// The wavelength whose light it is.
    template <class Lanes>
    static std::size_t laneOf(Vec2 film, const Lanes& lanes) {
        const auto lane = std::find_if(lanes.begin(), lanes.end(),
                                       [&](const auto& l) { return l && l->film == film; });
        REQUIRE(lane != lanes.end());
        return static_cast<std::size_t>(lane - lanes.begin());
    }

    std::optional<Path> splatted(const Contribution& c) const {
        const LightSubpath& light = sample_.lightPaths.front();
        const auto s = static_cast<std::size_t>(c.technique.s);
        const PathVertex& end = light.vertices[s - 1];
        const auto connections =
            end.kind == PathVertex::Kind::infinite
                ? view_.camera.connectEachToInfinity(end.wo, apertureUniforms_[s - 1], wavelengths_)
                : view_.camera.connectEach(end.point.position, apertureUniforms_[s - 1],
                                           wavelengths_);
        Path path;
        path.ray = connections[laneOf(c.film, connections)]->ray;
        path.isLensConnectable = true;
        appendLight(path, s);
        path.light = light.light;
        path.technique = c.technique;
        return path;
    }

    std::optional<Path> gathered(const Contribution& c) const {
        const Technique technique = c.technique;
        const auto t = static_cast<std::size_t>(technique.t);
        const auto s = static_cast<std::size_t>(technique.s);
        const CameraSubpath& camera = sample_.cameraPath;
        Path path;
        const auto& origins = sample_.camera->origins;
        const std::size_t lane = origins ? laneOf(c.film, *origins) : 0;
        path.ray = origins ? (*origins)[lane]->ray : *sample_.camera->ray;
        path.isLensConnectable = reachableLanes(view_, *sample_.camera, camera)[lane];
        path.technique = technique;
        const std::size_t own = std::min(t, camera.vertices.size());
        for (std::size_t i = 1; i < own; ++i) {
            path.vertices.push_back(vertexOf(camera.vertices[i]));
            path.vertices.back().toCamera = camera.vertices[i].wo;
        }
        if (own < t) {  // the walk left the scene
            Vertex end{PathVertex::Kind::infinite, {}, -camera.escape->direction, {}};
            end.stored.fromCamera = camera.escape->pdfSolidAngle;
            path.vertices.push_back(end);
            path.light = view_.scene.lights().infiniteLights().front();
        } else if (s == 0) {
            path.light = path.vertices.back().point.light;
            path.vertices.back().isDirac = false;
        } else {
            path.vertices.back().isDirac = false;  // it takes part with its continuous lobes
            if (s == 1)
                appendNextEvent(path, nextEvents_[t - 2]);
            else
                appendLight(path, s);
            if (s >= 2) path.light = sample_.lightPaths.front().light;
        }
        return path;
    }

    void appendLight(Path& path, std::size_t s) const {
        const std::vector<PathVertex>& light = sample_.lightPaths.front().vertices;
        for (std::size_t j = s; j-- > 0;) {
            Vertex vertex = vertexOf(light[j]);
            if (j > 0) vertex.toLight = light[j].wo;
            if (light[j].kind == PathVertex::Kind::infinite) vertex.toCamera = -light[j].wo;
            if (j + 1 == s) vertex.isDirac = false;
            path.vertices.push_back(vertex);
        }
    }

    void appendNextEvent(Path& path, const NextEvent& event) const {
        const Light& light = view_.scene.lights()[event.light];
        Vertex end{light.isInfinite()     ? PathVertex::Kind::infinite
                   : event.sample.isDirac ? PathVertex::Kind::point
                                          : PathVertex::Kind::emitter,
                   {},
                   -event.sample.direction,
                   {}};
        end.point.position = event.sample.position;
        end.point.geometricNormal = event.sample.normal;
        path.vertices.push_back(end);
        path.light = event.light;
    }

    const LoadedScene& loaded_;
    const View& view_;
    SampleId id_;
    std::unique_ptr<Estimator> estimator_;
    SamplePath sample_;
    Wavelengths wavelengths_;
    std::vector<Vec2> apertureUniforms_;
    std::vector<NextEvent> nextEvents_;
};

/// Paths whose weights are compared.
void checkWeights(const LoadedScene& loaded, std::size_t count) {
    const FlushDenormals flush;
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    const View view{*loaded.scene, *loaded.camera, filter, loaded.film.color == FilmColor::xyz};
    const SampleCounts counts{loaded.estimator.techniques,
                              1.0 * loaded.film.width * loaded.film.height};
    std::size_t paths = 0, wrong = 0, wrongSums = 0;
    double worst = 0.0, worstSum = 0.0;
    std::map<Technique, std::size_t> wrongBy;
    for (std::uint32_t sample = 0; paths < count && sample < 100000; ++sample)
        for (int y = 0; y < loaded.film.height; ++y)
            for (int x = 0; x < loaded.film.width; ++x)
                Paths(loaded, view, {1, x, y, sample})
                    .forEach([&](Path path, const Wavelengths& wavelengths, float weight) {
                        setDirections(path);
                        setDensities(view, wavelengths, path);
                        const Weights expected = weightsOf(path, counts);
                        ++paths;
                        const double off = std::abs(weight - expected.own);
                        const double offSum = std::abs(expected.sum - 1.0);
                        worst = std::max(worst, off);
                        worstSum = std::max(worstSum, offSum);
                        if (!(off <= 1e-5)) ++wrong, ++wrongBy[path.technique];
                        if (!(offSum <= 1e-5)) ++wrongSums;
                    });
    CHECK(paths >= count);
    CHECK(wrong == 0);
    CHECK(wrongSums == 0);
    MESSAGE(paths << " paths, weights off by up to " << worst << ", sums by " << worstSum);
    for (const auto& entry : wrongBy)
        MESSAGE(nameOf(entry.first) << ": " << entry.second << " wrong");
}

}  // namespace

TEST_CASE("Weights: on every scene's paths they are those of the products of all densities" *
          doctest::test_suite("statistical")) {
    const std::filesystem::path scenes =
        std::filesystem::path(__FILE__).parent_path() / "../../scenes";
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scenes)) {
        const std::filesystem::path file = entry.path() / "scene.toml";
        if (!std::filesystem::exists(file)) continue;
        ++count;
        LoadOptions options{
            {"film.width=24", "film.height=16", "estimator.kind=bdpt", "estimator.light_paths=1"},
            8};
        options.disperses = false;  // one connection a vertex
        CAPTURE(file.string());
        MESSAGE(file.string());
        checkWeights(loadScene(file, options), 1000000);
    }
    CHECK(count >= 9);
}

TEST_CASE("Weights: …and on those of each wavelength that a lens parts") {
    const std::string lens = lensFile("double-gauss-50mm-f1.1.toml").string();
    checkWeights(sceneFromText(dispersiveFrame(lens) + everyMaterialRoom + lampAndSky + pointAndSun,
                               {"estimator.kind=bdpt"}),
                 50000);
}

TEST_CASE("Weights: …and on those of every material and light, a shining mirror among them") {
    checkWeights(sceneFromText(everyMaterialScene + R"(
[[material]]
name = "shining mirror"
type = "conductor"
metal = "gold"
roughness = 0
emission = [2, 2, 2]
[[mesh]]
shape = "rectangle"
material = "shining mirror"
transform = [{scale = 0.3}, {translate = [-0.6, 0.6, 0.2]}]
)",
                               {"estimator.kind=bdpt"}),
                 50000);
}
