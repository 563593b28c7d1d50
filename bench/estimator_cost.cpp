// Path vertices per second of every estimator on every scene, and what splatting costs.
//
// A path vertex is a vertex of a camera's or a light's walk, counted once: the point on the lens
// where the walk of a camera sample begins, the point on the light where a light path begins, and
// every surface that either walk meets. Points on lights that next-event estimation draws are none.
#include <fmt/format.h>

#include <cstdio>

#include "bench/bench_scene.h"
#include "bench/embree_probe.h"

namespace etendue {
namespace {

constexpr int rounds = 5, splatRounds = 11, width = 240, height = 160;
constexpr double pixels = 1.0 * width * height;
constexpr const char* sceneNames[] = {"still-life",
                                      "cornell-box",
                                      "diffuse-box",
                                      "bokeh-lights",
                                      "fisheye-room",
                                      "hidden-light",
                                      "environment-still-life",
                                      "glass-caustic",
                                      "mirror-corridor"};

std::filesystem::path sceneFile(const std::filesystem::path& project, const char* name) {
    return project / "scenes" / name / "scene.toml";
}

/// Per camera sample. Begun by the lens and by the lights, and what both meet.
struct Walks {
    double vertices, rays;
};

Walks countWalks(const LoadedScene& loaded, const std::string& kind) {
    probeEmbree(EmbreeProbe::counting);
    renderForBench(loaded, kind, 1, 1);
    const EmbreeUse use = embreeUse();
    probeEmbree(EmbreeProbe::off);
    const double camera = kind == "lt" ? 0.0 : 1.0;
    const double light = kind == "pt" ? 0.0 : loaded.estimator.lightPaths;
    return {camera + light + static_cast<double>(use.met) / pixels,
            static_cast<double>(use.closestHits + use.occlusions) / pixels};
}

double nanosecondsPerSample(const LoadedScene& loaded, const std::string& kind,
                            std::uint32_t samples) {
    const double before = threadSeconds();
    renderForBench(loaded, kind, samples, 1);
    return (threadSeconds() - before) * 1e9 / (pixels * samples);
}

/// Nanoseconds of a ray through the lens, and of a connection to it: to what those rays meet.
struct LensCost {
    double ray, connection;
};

LensCost lensCost(const LoadedScene& loaded) {
    struct Question {
        Vec2 film, aperture;
        SpectralSample color;
        Vec3 target;
    };
    constexpr std::size_t count = 40000;
    const Filter filter = filterOf(loaded);
    const View view{*loaded.scene, *loaded.camera, filter, loaded.film.color == FilmColor::xyz};
    std::vector<Question> questions;
    for (std::uint32_t i = 0; questions.size() < count && i < 4 * count; ++i) {
        const int pixel = static_cast<int>(i % static_cast<std::uint32_t>(width * height));
        const CameraSample sample =
            drawCameraSample(view, {0, pixel % width, pixel / width, i / (width * height)});
        if (!sample.ray) continue;
        const auto hit = loaded.scene->closestHit({sample.ray->origin, sample.ray->direction});
        if (!hit) continue;
        questions.push_back({sample.film, sample.apertureUniform, sample.color, hit->position});
    }
    if (questions.empty()) return {0.0, 0.0};
    float sum = 0.0f;  // or nothing would have to be computed
    const double start = threadSeconds();
    for (const Question& q : questions)
        if (const auto ray = loaded.camera->sampleRay(q.film, q.aperture, q.color.wavelengths))
            sum += ray->weight;
    const double middle = threadSeconds();
    for (const Question& q : questions)
        if (const auto c = loaded.camera->connect(q.target, q.aperture, q.color.wavelengths))
            sum += c->film.x;
    const double end = threadSeconds();
    volatile float sink = sum;
    static_cast<void>(sink);
    const double each = 1e9 / static_cast<double>(questions.size());
    return {(middle - start) * each, (end - middle) * each};
}

void benchVerticesOf(const LoadedScene& loaded, const char* name) {
    struct Row {
        const char* kind;
        Walks walks{};
        double rawRay = 0.0;
        std::vector<double> times{}, ratios{};
    };
    Row rows[] = {{"pt"}, {"lt"}, {"bdpt"}};
    for (Row& row : rows) {
        row.walks = countWalks(loaded, row.kind);
        probeEmbree(EmbreeProbe::recording);
        renderForBench(loaded, row.kind, 1, 1);
        probeEmbree(EmbreeProbe::off);
        std::vector<double> raw;
        for (int i = 0; i < 3; ++i) raw.push_back(replayNanosecondsPerQuery());
        row.rawRay = median(raw);
    }
    std::vector<double> lensRays, connections;
    for (int i = 0; i < rounds; ++i) {
        for (Row& row : rows) {
            row.times.push_back(nanosecondsPerSample(loaded, row.kind, 4));
            row.ratios.push_back(row.walks.vertices / row.times.back() * rows[0].times.back() /
                                 rows[0].walks.vertices);
        }
        const LensCost cost = lensCost(loaded);
        lensRays.push_back(cost.ray);
        connections.push_back(cost.connection);
    }
    for (const Row& row : rows)
        fmt::print(
            "{:<24}{:>6}{:>10.0f}{:>10.2f}{:>12.2f}{:>12.2f}{:>10.2f}{:>10.1f}{:>12.0f} "
            "%{:>10.1f}{:>10.1f}\n",
            name, row.kind, median(row.times), row.walks.vertices,
            row.walks.vertices / median(row.times) * 1e3, median(row.ratios), row.walks.rays,
            1e3 / row.rawRay, 100.0 * row.walks.rays * row.rawRay / median(row.times),
            1e3 / median(lensRays), 1e3 / median(connections));
    std::fflush(stdout);
}

/// An estimator whose splats are lost: all is done but to record and to add them.
class WithoutSplats final : public Estimator {
public:
    explicit WithoutSplats(std::unique_ptr<Estimator> whole) : whole_(std::move(whole)) {}

    void takeSample(const View& view, SampleId id, SampleRequest request,
                    Sample& result) const override {
        whole_->takeSample(view, id, request, result);
        std::erase_if(result.contributions, [](const Contribution& c) { return c.isSplat; });
    }
    int lightPathsPerSample() const override { return whole_->lightPathsPerSample(); }
    bool hasCameraLight() const override { return whole_->hasCameraLight(); }

private:
    std::unique_ptr<Estimator> whole_;
};

void benchSplatsOf(const LoadedScene& loaded, const char* name) {
    for (const char* kind : {"lt", "bdpt"}) {
        EstimatorSettings settings = loaded.estimator;
        settings.kind = kind;
        const std::unique_ptr<Estimator> whole = makeEstimator(settings);
        const WithoutSplats without(makeEstimator(settings));
        const Filter filter = filterOf(loaded);
        const auto nanoseconds = [&](const Estimator& estimator) {
            Film film(loaded.film.fullFrame(), {}, loaded.film.color);
            RenderSettings render;
            render.samples = 4;
            const double before = threadSeconds();
            etendue::render(*loaded.scene, *loaded.camera, estimator, filter, film, render, {});
            return (threadSeconds() - before) * 1e9 / (pixels * render.samples);
        };
        std::vector<double> with, shares;
        for (int i = 0; i < splatRounds; ++i) {
            with.push_back(nanoseconds(*whole));
            shares.push_back(1.0 - nanoseconds(without) / with.back());
        }
        const View view{*loaded.scene, *loaded.camera, filter, loaded.film.color == FilmColor::xyz};
        Sample sample;
        std::size_t splats = 0;
        for (int i = 0; i < width * height; ++i) {
            whole->takeSample(view, {0, i % width, i / width, 0, Sampler::independent}, {}, sample);
            splats += static_cast<std::size_t>(
                std::count_if(sample.contributions.begin(), sample.contributions.end(),
                              [](const Contribution& c) { return c.isSplat; }));
        }
        const double perSample = static_cast<double>(splats) / pixels;
        fmt::print("{:<24}{:>6}{:>12.0f}{:>12.2f}{:>12.1f} %{:>12.1f}\n", name, kind, median(with),
                   perSample, 100.0 * median(shares), median(shares) * median(with) / perSample);
    }
    std::fflush(stdout);
}

}  // namespace

void benchVertices(const std::filesystem::path& project, const std::string& wanted) {
    fmt::print("{:<24}{:>6}{:>10}{:>10}{:>12}{:>12}{:>10}{:>10}{:>14}{:>10}{:>10}\n", "scene", "",
               "ns/sample", "vertices", "Mvert./s", "over pt's", "rays", "Mrays/s", "rays' part",
               "Mlens/s", "Mconn./s");
    for (const char* name : sceneNames)
        if (wanted.empty() || wanted == name)
            benchVerticesOf(loadForBench(sceneFile(project, name), width, height), name);
    fmt::print(
        "vertices, rays: per camera sample. Mrays/s: Embree's, of the same rays, nothing between "
        "them; rays' part: of\nns/sample at that speed. Mlens/s, Mconn./s: rays through the lens "
        "and connections to it alone.\nOne thread's own time, medians of {} rounds\n",
        rounds);
}

void benchSplats(const std::filesystem::path& project, const std::string& wanted) {
    fmt::print("{:<24}{:>6}{:>12}{:>12}{:>14}{:>12}\n", "scene", "", "ns/sample", "splats",
               "splatting", "ns/splat");
    for (const char* name : sceneNames)
        if (wanted.empty() || wanted == name)
            benchSplatsOf(loadForBench(sceneFile(project, name), width, height), name);
    fmt::print(
        "splats: per sample. splatting: to record them and to add them to the film, by leaving "
        "both "
        "out.\nOne thread's own time, medians of {} rounds\n",
        splatRounds);
}

}  // namespace etendue
