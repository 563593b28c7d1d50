#include "tools/replay_command.h"

#include <fmt/format.h>

#include <map>

#include "lens/fit_cache.h"
#include "renderer/film.h"
#include "renderer/parallel.h"
#include "renderer/scene_loader.h"
#include "tools/json.h"
#include "tools/progress.h"
#include "tools/sample_path.h"
#include "tools/scene_names.h"
#include "tools/text_table.h"

namespace etendue {

namespace {

const char* nameOf(PathVertex::Kind kind) {
    switch (kind) {
        case PathVertex::Kind::lens:
            return "lens";
        case PathVertex::Kind::surface:
            return "surface";
        case PathVertex::Kind::emitter:
            return "emitter";
        case PathVertex::Kind::point:
            return "point";
        case PathVertex::Kind::infinite:
            break;
    }
    return "infinite";
}

std::string nameOf(const Material* material) { return material ? material->name : ""; }

/// Whether a connection can end there: of a surface that it has more than Dirac lobes, and that the
/// walk did not use one of those; of the lens that it would find this film point.
bool isConnectable(const PathVertex& vertex) {
    return vertex.density.isConnectable &&
           (vertex.kind != PathVertex::Kind::surface || canConnect(vertex));
}

/// Why the film does not take it, or nothing.
std::string defectOf(const Spectrum& value) {
    if (!isFinite(value)) return "NOT FINITE";
    return isUsable(value) ? "" : "NEGATIVE";
}

std::string text(Vec3 v) { return fmt::format("{:.5g} {:.5g} {:.5g}", v.x, v.y, v.z); }
std::string text(Vec2 v) { return fmt::format("{:.5g}, {:.5g}", v.x, v.y); }
std::string text(const Spectrum& s) {
    return fmt::format("{:.5g} {:.5g} {:.5g}", s[0], s[1], s[2]);
}
/// Of a density that no walk has asked for, a dash.
std::string density(float value) { return value > 0.0f ? fmt::format("{:.4g}", value) : "–"; }

Json json(Vec3 v) { return Json::numbers({v.x, v.y, v.z}); }
Json json(Vec2 v) { return Json::numbers({v.x, v.y}); }
Json json(const Spectrum& s) { return Json::numbers({s[0], s[1], s[2]}); }

/// The lanes that a path carries: R, G, B, or one for each of four wavelengths.
struct Lanes {
    Wavelengths wavelengths;

    std::string text(const Spectrum& s) const {
        return wavelengths.isSpectral ? fmt::format("{} {:.5g}", etendue::text(s), s[3])
                                      : etendue::text(s);
    }
    Json json(const Spectrum& s) const {
        return wavelengths.isSpectral ? Json::numbers({s[0], s[1], s[2], s[3]}) : etendue::json(s);
    }
    std::string description() const {
        const auto& nm = wavelengths.nm;
        return wavelengths.isSpectral
                   ? fmt::format("{:.5g}, {:.5g}, {:.5g} and {:.5g} nm", nm[0], nm[1], nm[2], nm[3])
                   : fmt::format("R, G, B; the lens and glass at {:g} nm", wavelengths.heroNm());
    }
};

/// The density of what the camera ray meets first, and how to call it.
struct FirstDensity {
    float value;
    bool isSolidAngle;
};
std::optional<FirstDensity> firstDensityOf(const SamplePath& path) {
    if (path.cameraPath.vertices.size() >= 2)
        return FirstDensity{path.cameraPath.vertices[1].density.fromCamera, false};
    if (path.cameraPath.escape) return FirstDensity{path.cameraPath.escape->pdfSolidAngle, true};
    return {};
}

/// Where the other wavelengths of the ray come from.
std::string originsText(const CameraSample& sample) {
    std::string result;
    for (std::size_t lane = 1; lane < sample.origins->size(); ++lane)
        if (const auto& origin = (*sample.origins)[lane])
            result += fmt::format("{}{} px at {:.5g} nm", result.empty() ? "" : ", ",
                                  text(origin->film), sample.color.wavelengths.nm[lane]);
    return result.empty() ? "nowhere on the film" : result;
}

std::string cameraText(const SamplePath& path) {
    if (!path.camera) return "";
    const CameraSample& sample = *path.camera;
    std::vector<std::vector<std::string>> rows{
        {"film point", fmt::format("{} px", text(sample.film))},
        {"aperture point", fmt::format("{} of the unit square", text(sample.apertureUniform))}};
    if (sample.ray) {
        rows.push_back({"ray from", fmt::format("{} m", text(sample.ray->origin))});
        rows.push_back({"toward", text(sample.ray->direction)});
        rows.push_back(
            {"weight", fmt::format("{:.5g}, pixel value per radiance", sample.ray->weight)});
        if (sample.origins) rows.push_back({"it comes from", originsText(sample)});
    } else {
        rows.push_back({"ray", "none: the lens blocks it"});
    }
    if (const auto first = firstDensityOf(path))
        rows.push_back(
            {"footprint", fmt::format("of a pixel {:.4g} {} where the ray goes: its density "
                                      "is {:.4g} 1/{}",
                                      1.0 / first->value, first->isSolidAngle ? "sr" : "m²",
                                      first->value, first->isSolidAngle ? "sr" : "m²")});
    return "\ncamera sample\n" + alignedTable(rows, "ll");
}

std::string walkText(const std::vector<PathVertex>& vertices, const std::optional<Escape>& escape,
                     const Lanes& lanes) {
    std::vector<std::vector<std::string>> rows{{"", "kind", "material", "position, m",
                                                "toward the one before", "throughput",
                                                "from camera", "from light", "connects"}};
    int number = 0;
    for (const PathVertex& v : vertices) {
        const bool isPlace = v.kind != PathVertex::Kind::infinite;
        rows.push_back({fmt::format("{}", ++number), nameOf(v.kind), nameOf(v.point.material),
                        isPlace ? text(v.point.position) : "", number > 1 ? text(v.wo) : "",
                        number > 1 ? lanes.text(v.throughput) : "", density(v.density.fromCamera),
                        density(v.density.fromLight), isConnectable(v) ? "yes" : "no"});
    }
    if (escape)
        rows.push_back({"", "escape", "", "", text(-escape->direction),
                        lanes.text(escape->throughput), density(escape->pdfSolidAngle), "–", ""});
    return alignedTable(rows, "rlllllrrl");
}

std::string lightText(const SamplePath& path, const Lanes& lanes) {
    std::string result;
    for (std::size_t i = 0; i < path.lightPaths.size(); ++i) {
        const LightSubpath& light = path.lightPaths[i];
        const std::string which = path.lightPaths.size() > 1
                                      ? fmt::format(" {} of {}", i + 1, path.lightPaths.size())
                                      : "";
        result += fmt::format("\npath{} from a light\n", which);
        if (light.vertices.empty())
            result += "  none: nothing was emitted\n";
        else
            result +=
                fmt::format("  light {}{}, radiance {}\n", light.light,
                            light.isDirac ? ", without extent" : "", lanes.text(light.radiance)) +
                walkText(light.vertices, {}, lanes);
    }
    return result;
}

std::string contributionsText(const SamplePath& path, bool isSpectral) {
    std::vector<std::vector<std::string>> rows{{"technique",
                                                isSpectral ? "value, XYZ" : "value, RGB", "weight",
                                                "weighted", "lands on", ""}};
    bool isSplatting = !path.lightPaths.empty();
    for (const Contribution& c : path.contributions) {
        const Spectrum weighted = c.value * c.weight;
        isSplatting |= c.isSplat;
        rows.push_back(
            {nameOf(c.technique), text(c.value), fmt::format("{:.5g}", c.weight), text(weighted),
             c.isSplat ? fmt::format("{} px", text(c.film)) : "its own pixel", defectOf(weighted)});
    }
    rows.push_back({"sum", "", "", text(path.ownPixel), "its own pixel", defectOf(path.ownPixel)});
    if (isSplatting)
        rows.push_back(
            {"sum", "", "", text(path.splatted), "where they land", defectOf(path.splatted)});
    return "\ncontributions\n" + alignedTable(rows, "llrlll");
}

Json jsonOf(const std::vector<PathVertex>& vertices, const Lanes& lanes) {
    Json walk = Json::array();
    for (const PathVertex& v : vertices) {
        Json vertex = Json::object({{"kind", nameOf(v.kind)}});
        if (v.point.material) vertex.add("material", v.point.material->name);
        if (v.kind != PathVertex::Kind::infinite) vertex.add("position", json(v.point.position));
        if (v.kind == PathVertex::Kind::surface)
            vertex.add("normal", json(v.point.geometricNormal));
        vertex.add("toward_previous", json(v.wo));
        vertex.add("throughput", lanes.json(v.throughput));
        vertex.add("pdf_from_camera", v.density.fromCamera);
        vertex.add("pdf_from_light", v.density.fromLight);
        vertex.add("connectable", isConnectable(v));
        walk.add(std::move(vertex));
    }
    return walk;
}

Json jsonOf(const SamplePath& path, const Lanes& lanes) {
    Json object = Json::object({{"spectral", lanes.wavelengths.isSpectral}});
    if (lanes.wavelengths.isSpectral) {
        const auto& nm = lanes.wavelengths.nm;
        object.add("wavelengths_nm", Json::numbers({nm[0], nm[1], nm[2], nm[3]}));
    }
    if (path.camera) {
        const CameraSample& sample = *path.camera;
        Json camera = Json::object(
            {{"film", json(sample.film)}, {"aperture_uniform", json(sample.apertureUniform)}});
        if (sample.ray) {
            camera.add("origin", json(sample.ray->origin));
            camera.add("direction", json(sample.ray->direction));
            camera.add("weight", sample.ray->weight);
        }
        if (const auto first = firstDensityOf(path))
            camera.add(first->isSolidAngle ? "pdf_solid_angle" : "pdf_area", first->value);
        object.add("camera_sample", camera);
        object.add("camera_path", jsonOf(path.cameraPath.vertices, lanes));
        if (const auto& escape = path.cameraPath.escape)
            object.add("escape", Json::object({{"direction", json(escape->direction)},
                                               {"throughput", lanes.json(escape->throughput)},
                                               {"pdf_solid_angle", escape->pdfSolidAngle}}));
    }
    Json lightPaths = Json::array();
    for (const LightSubpath& light : path.lightPaths)
        lightPaths.add(Json::object({{"light", light.light},
                                     {"without_extent", light.isDirac},
                                     {"radiance", lanes.json(light.radiance)},
                                     {"vertices", jsonOf(light.vertices, lanes)}}));
    object.add("light_paths", lightPaths);
    Json contributions = Json::array();
    for (const Contribution& c : path.contributions) {
        const Spectrum weighted = c.value * c.weight;
        contributions.add(Json::object({{"technique", nameOf(c.technique)},
                                        {"value", json(c.value)},
                                        {"weight", c.weight},
                                        {"weighted", json(weighted)},
                                        {"film", json(c.film)},
                                        {"splat", c.isSplat},
                                        {"usable", isUsable(weighted)}}));
    }
    object.add("contributions", contributions);
    object.add("own_pixel", json(path.ownPixel));
    return object;
}

LoadedScene load(const ReplayCommand& command) {
    LoadOptions options{command.overrides, hardwareThreads(), fitCacheDirectory()};
    options.camera = command.camera;
    if (!command.size.empty()) options.setSize(command.size[0], command.size[1]);
    return loadShowingFit(command.scene, std::move(options));
}

SampleId sampleId(const ReplayCommand& command, const LoadedScene& loaded) {
    const FilmSettings& film = loaded.film;
    const SampleId id{command.seed, command.pixel[0], command.pixel[1], command.sample,
                      loaded.sampler};
    if (id.x >= film.width || id.y >= film.height)
        throw InputError(fmt::format("--pixel {},{}: must lie in the frame of {} × {} pixels", id.x,
                                     id.y, film.width, film.height),
                         ExitCode::usage);
    return id;
}

}  // namespace

ExitCode runReplay(const ReplayCommand& command) {
    const LoadedScene loaded = load(command);
    const SampleId id = sampleId(command, loaded);
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    const View view{*loaded.scene, *loaded.camera, filter, loaded.film.color == FilmColor::xyz};
    const auto estimator = makeEstimator(loaded.estimator);
    const FlushDenormals flush;
    SamplePath path;
    retraceSample(view, *estimator, loaded.estimator, id, path);
    markReachability(view, path);
    const Lanes lanes{drawWavelengths(view, id).wavelengths};
    if (command.asJson) {
        fmt::print("{}\n", jsonOf(path, lanes).text());
        return ExitCode::success;
    }
    fmt::print("{}: {}, pixel {},{} of {} × {}, sample {}, seed {}\n", command.scene.string(),
               loaded.estimator.kind, id.x, id.y, loaded.film.width, loaded.film.height, id.sample,
               id.seed);
    fmt::print("lanes: {}\n{}", lanes.description(), cameraText(path));
    if (!path.cameraPath.vertices.empty())
        fmt::print("\npath from the camera\n{}",
                   walkText(path.cameraPath.vertices, path.cameraPath.escape, lanes));
    fmt::print("{}{}", lightText(path, lanes), contributionsText(path, view.isSpectral));
    return ExitCode::success;
}

}  // namespace etendue
