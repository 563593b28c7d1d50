#include "renderer/scene_loader.h"

#include <cmath>

#include "renderer/content_hash.h"
#include "renderer/scene_parts.h"

namespace etendue {

namespace {

constexpr int largestIncludeDepth = 16;
/// Each time counted: files that each include the next one twice would double at every level.
constexpr std::size_t mostFiles = 1000;

/// The file and what it includes, as one document.
Config loadWithIncludes(const std::filesystem::path& file,
                        std::vector<std::filesystem::path>& files, int depth) {
    Config config = Config::load(file);
    files.push_back(file);
    const ConfigTable root = config.root();
    if (depth > largestIncludeDepth)
        root.fail("include", "includes nest deeper than 16: does a file include itself?");
    for (const std::filesystem::path& included : root.files("include")) {
        if (files.size() >= mostFiles)
            root.fail("include", "includes add up to more than 1000 files");
        config.merge(loadWithIncludes(included, files, depth + 1));
    }
    return config;
}

/// The file's [camera] in place of the scene's, which still says where it stands.
void lookThrough(const std::filesystem::path& file, Config& config,
                 std::vector<std::filesystem::path>& files) {
    const Config camera = loadWithIncludes(file, files, 0);
    for (const std::string& key : camera.root().keys())
        if (key != "camera" && key != "include")
            camera.root().fail(key, "a camera file has a [camera] table and nothing else");
    config.replaceTable("camera", camera, {"from", "to", "up"});
}

FilmSettings loadFilm(const ConfigTable& table) {
    FilmSettings film;
    film.width = static_cast<int>(table.integer("width", {1, 32768}, film.width));
    film.height = static_cast<int>(table.integer("height", {1, 32768}, film.height));
    const std::string filter =
        table.choice("filter", {"box", "gaussian", "blackman-harris"}, "box");
    film.filter = filter == "box"        ? FilterKind::box
                  : filter == "gaussian" ? FilterKind::gaussian
                                         : FilterKind::blackmanHarris;
    if (table.choice("color", {"auto", "spectral"}, "auto") == "spectral")
        film.color = FilmColor::xyz;
    film.filterRadius =
        static_cast<float>(table.number("filter_radius", {0.01, 16.0}, defaultRadius(film.filter)));
    table.finish();
    return film;
}

/// Those that `techniques` names. Of names beyond `maxDepth` it is an error if there are no others,
/// since the picture would be black, and else worth a note.
TechniqueSet loadTechniques(const ConfigTable& table, int maxDepth, LoadingScene& loading) {
    const auto set = TechniqueSet::parse(table.text("techniques"));
    if (!set)
        table.fail("techniques",
                   "expected names like s2t1, t1 or s0, separated by commas: s vertices from "
                   "the light, t ≥ 1 from the camera");
    const std::vector<TechniqueName> names = set->names();
    std::string beyond;
    std::size_t count = 0;
    for (const auto& [name, fewestEdges] : names) {
        if (fewestEdges <= maxDepth) continue;
        ++count;
        beyond += (beyond.empty() ? "" : ", ") + name + " needs " + std::to_string(fewestEdges);
    }
    if (count == 0) return *set;
    beyond = "max_depth = " + std::to_string(maxDepth) + " edges: " + beyond;
    if (count == names.size()) table.fail("techniques", "nothing is within " + beyond);
    loading.notes.push_back("estimator.techniques: beyond " + beyond);
    return *set;
}

void loadEstimator(const ConfigTable& table, LoadingScene& loading, LoadedScene& loaded) {
    EstimatorSettings& e = loaded.estimator;
    e.kind = table.choice("kind", estimatorKinds(), e.kind);
    e.maxDepth = static_cast<int>(table.integer("max_depth", {1, 10000}, e.maxDepth));
    e.russianRouletteDepth = static_cast<int>(
        table.integer("russian_roulette_depth", {0, 10000}, e.russianRouletteDepth));
    e.lightPaths = static_cast<int>(table.integer("light_paths", {1, 1024}, e.lightPaths));
    e.usesOuterPupil = table.choice("pupil_sampling", {"aperture", "outer"}, "aperture") == "outer";
    if (e.usesOuterPupil && e.kind != "lt")
        table.fail("pupil_sampling", "\"outer\" is for kind = \"lt\"");
    if (table.has("techniques")) {
        if (e.kind != "bdpt") table.fail("techniques", "is for kind = \"bdpt\"");
        e.techniques = loadTechniques(table, e.maxDepth, loading);
    }
    if (table.choice("sampler", {"independent", "sobol"}, "independent") == "sobol")
        loaded.sampler = Sampler::sobol;
    loaded.samples = static_cast<int>(table.integer("samples", {1, 1 << 30}, loaded.samples));
    table.finish();
}

bool anythingEmits(const LoadingScene& loading) {
    if (!loading.parts.lights.empty()) return true;
    for (const Placement& p : loading.parts.placements)
        for (const Material* m : p.materials)
            if (emits(*m)) return true;
    return false;
}

/// A sky for bare models: bright above, dim below, brightest to the upper left of the camera.
Texture softSky() {
    Image image{64, 32, 3, std::vector<float>()};
    auto& pixels = std::get<std::vector<float>>(image.pixels);
    const Vec3 key = normalize(Vec3{-0.6f, 0.8f, 0.5f});
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float theta = pi * (static_cast<float>(y) + 0.5f) / 32.0f;
            const float phi = 2.0f * pi * (static_cast<float>(x) + 0.5f) / 64.0f;
            const Vec3 direction{std::sin(theta) * std::sin(phi), std::cos(theta),
                                 -std::sin(theta) * std::cos(phi)};
            const float facing = std::max(0.0f, dot(direction, key));
            const float value = 0.35f + 0.25f * direction.y + 2.5f * square(square(square(facing)));
            for (const float tint : {0.97f, 1.0f, 1.04f}) pixels.push_back(value * tint);
        }
    return Texture(std::move(image), ColorEncoding::linear, TextureWrap::clamp);
}

void addSoftLight(LoadingScene& loading) {
    const auto sky = std::make_shared<const Texture>(softSky());
    loading.parts.lights.push_back(
        [sky](BoundingSphere bounds) { return makeEnvironmentLight(sky, 1.0f, {}, bounds); });
    loading.notes.emplace_back("nothing emits light: a soft sky was added");
}

}  // namespace

Vec3d vector3(const ConfigTable& table, std::string_view key, Range range) {
    const std::vector<double> v = table.numbers(key, 3, range);
    return {v[0], v[1], v[2]};
}

LoadedScene loadScene(const std::filesystem::path& file, const LoadOptions& options) {
    LoadedScene loaded;
    LoadingScene loading;
    const bool isModel = file.extension() == ".obj" || file.extension() == ".OBJ";
    Config config = isModel ? Config::parse("", file) : loadWithIncludes(file, loading.files, 0);
    if (!options.camera.empty()) lookThrough(options.camera, config, loading.files);
    for (const std::string& assignment : options.overrides) config.set(assignment);
    const ConfigTable root = config.root();
    root.files("include");
    loaded.film = loadFilm(root.table("film"));
    loadEstimator(root.table("estimator"), loading, loaded);
    if (options.samples) loaded.samples = *options.samples;
    loadMaterials(root.tables("material"), loading);
    if (isModel) addModel(file, loading);
    loadMeshes(root.tables("mesh"), root.tables("instance"), loading);
    loadLights(root.tables("light"), loading);
    const ConfigTable camera = root.table("camera");
    root.finish();
    if (!anythingEmits(loading)) {
        if (isModel)
            addSoftLight(loading);
        else
            loading.notes.emplace_back(
                "nothing in the scene emits light: the picture will be black");
    }
    loaded.scene = std::make_unique<Scene>(std::move(loading.parts), options.threads);
    // Last, since it may focus on the scene, and since fitting its lens takes time: by now all
    // other input is known to be good.
    loadCamera(camera, options, loading, loaded);
    if (loaded.camera->settings().isDispersive || loading.isDispersive)
        loaded.film.color = FilmColor::xyz;
    if (loaded.estimator.usesOuterPupil && !loaded.camera->settings().outerPupil)
        root.table("estimator")
            .fail("pupil_sampling", "\"outer\" needs a camera with a lens of glass");
    loaded.hash = contentHash(loading.files, options.overrides);
    loaded.notes = std::move(loading.notes);
    return loaded;
}

}  // namespace etendue
