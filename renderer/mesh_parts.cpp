// [[mesh]] and [[instance]]: which triangles stand where, made of what.
#include <algorithm>
#include <cmath>
#include <map>

#include "renderer/mesh_normals.h"
#include "renderer/scene_parts.h"
#include "renderer/shapes.h"

namespace etendue {

namespace {

constexpr Range segmentRange{3, 4096};

/// A mesh and what each of its material slots stands for.
struct DressedMesh {
    std::uint32_t index = 0;
    std::vector<const Material*> materials;
};

Mesh latheFrom(const ConfigTable& table) {
    std::vector<Vec2> profile;
    for (const std::vector<double>& row : table.rows("profile", 2, {-1e6, 1e6}))
        profile.push_back({static_cast<float>(row[0]), static_cast<float>(row[1])});
    const auto segments = static_cast<int>(table.integer("segments", segmentRange, 64));
    const auto subdivisions = static_cast<int>(table.integer("subdivisions", {1, 256}, 1));
    const auto creaseDegrees = static_cast<float>(table.number("crease_angle", {0, 179}, 40));
    return attempt(table, "profile",
                   [&] { return makeLathe(profile, segments, subdivisions, creaseDegrees); });
}

struct Shape {
    const char* name;
    Mesh (*make)(const ConfigTable&);
};

int segments(const ConfigTable& table, int fallback) {
    return static_cast<int>(table.integer("segments", segmentRange, fallback));
}

constexpr Shape shapes[] = {
    {"sphere", [](const ConfigTable& t) { return makeSphere(segments(t, 64)); }},
    {"rectangle",
     [](const ConfigTable& t) {
         return makeRectangle(static_cast<int>(t.integer("subdivisions", {1, 1000}, 1)));
     }},
    {"box", [](const ConfigTable&) { return makeBox(); }},
    {"disc", [](const ConfigTable& t) { return makeDisc(segments(t, 64)); }},
    {"cylinder",
     [](const ConfigTable& t) { return makeCylinder(segments(t, 64), t.boolean("capped", true)); }},
    {"torus",
     [](const ConfigTable& t) {
         return makeTorus(static_cast<float>(t.number("minor_radius", {1e-6, 1.0}, 0.25)),
                          segments(t, 64),
                          static_cast<int>(t.integer("minor_segments", segmentRange, 32)));
     }},
    {"lathe", latheFrom},
};

Mesh shapeFrom(const ConfigTable& table) {
    std::vector<std::string> names;
    for (const Shape& s : shapes) names.emplace_back(s.name);
    const std::string name = table.choice("shape", names);
    for (const Shape& s : shapes)
        if (name == s.name) return attempt(table, "shape", [&] { return s.make(table); });
    table.fail("shape", "no such shape");
}

/// What each material slot stands for: the scene file's material of that name, else what the MTL
/// says
/// (`fileMaterials`, one for each slot or none), else grey.
std::vector<const Material*> dress(const Mesh& mesh, const std::vector<ObjMaterial>& fileMaterials,
                                   LoadingScene& loading) {
    std::vector<const Material*> slots;
    for (std::size_t i = 0; i < mesh.materialNames.size(); ++i) {
        const auto own = loading.materials.find(mesh.materialNames[i]);
        if (own != loading.materials.end())
            slots.push_back(own->second);
        else if (i < fileMaterials.size())
            slots.push_back(addObjMaterial(fileMaterials[i], loading));
        else
            slots.push_back(defaultMaterial(loading));
    }
    return slots;
}

DressedMesh addMesh(Mesh mesh, std::vector<const Material*> materials, LoadingScene& loading) {
    loading.parts.meshes.push_back(std::move(mesh));
    return {static_cast<std::uint32_t>(loading.parts.meshes.size() - 1), std::move(materials)};
}

DressedMesh addModelFile(const std::filesystem::path& file, LoadingScene& loading) {
    ObjModel model = loadObj(file);
    loading.files.insert(loading.files.end(), model.files.begin(), model.files.end());
    // A file that is used twice has the same to say twice.
    for (const std::string& note : model.notes)
        if (std::find(loading.notes.begin(), loading.notes.end(), note) == loading.notes.end())
            loading.notes.push_back(note);
    std::vector<const Material*> slots = dress(model.mesh, model.materials, loading);
    return addMesh(std::move(model.mesh), std::move(slots), loading);
}

// Written so that NaN fails.
bool isNear(Vec3d p) {
    return std::abs(p.x) <= farthestPlace && std::abs(p.y) <= farthestPlace &&
           std::abs(p.z) <= farthestPlace;
}
bool isWithin(const Transform& t, double longest) {
    return length(t.x) <= longest && length(t.y) <= longest && length(t.z) <= longest;
}

/// Rays are turned back into the mesh's own space, in floats.
bool canBeTurnedBack(const Transform& worldFromMesh) {
    constexpr double most = 1.000001e12;  // a single step's scale, and its rounding
    return isWithin(worldFromMesh, most) && std::abs(worldFromMesh.determinant()) > 0.0 &&
           isWithin(worldFromMesh.inverse(), most);
}

/// Every vertex must stay where float coordinates and Embree can handle it.
void placeMesh(const DressedMesh& mesh, const Transform& worldFromMesh, const ConfigTable& table,
               LoadingScene& loading) {
    for (const Vec3& p : loading.parts.meshes[mesh.index].positions) {
        const Vec3d world = worldFromMesh.point(toDouble(p));
        if (!isNear(world)) table.fail("transform", "moves a vertex beyond 1e15 m");
    }
    if (!canBeTurnedBack(worldFromMesh))
        table.fail("transform", "stretches or shrinks the mesh by more than 1e12 times");
    loading.parts.placements.push_back({mesh.index, worldFromMesh, mesh.materials});
}

DressedMesh loadMesh(const ConfigTable& table, LoadingScene& loading) {
    if (table.has("file") == table.has("shape"))
        table.fail("file", "a mesh needs either a file or a shape");
    const auto addModelOf = [&](const std::filesystem::path& file) {
        return addModelFile(file, loading);
    };
    DressedMesh mesh = table.has("file") ? table.readFile("file", addModelOf)
                                         : addMesh(shapeFrom(table), {}, loading);
    Mesh& geometry = loading.parts.meshes[mesh.index];
    if (mesh.materials.empty()) mesh.materials = dress(geometry, {}, loading);
    if (table.has("smooth")) {
        if (table.boolean("smooth", true))
            makeSmooth(geometry, static_cast<float>(table.number("smooth_angle", {0, 180}, 60)));
        else
            makeFlat(geometry);
    }
    if (table.has("material"))
        for (const Material*& slot : mesh.materials)
            slot = findMaterial(table, "material", loading);
    return mesh;
}

}  // namespace

Transform loadTransform(const ConfigTable& table, std::string_view key) {
    Transform result;
    for (const ConfigTable& step : table.tables(key)) {
        const std::vector<std::string> keys = step.keys();
        if (keys.size() != 1)
            step.fail("", "a step is one of {scale = …}, {rotate = […]}, {translate = […]}");
        Transform t;
        if (step.has("scale")) {
            const bool isUniform = !step.isArray("scale");
            const double k = isUniform ? step.number("scale", {-1e12, 1e12}) : 1.0;
            const Vec3d s = isUniform ? Vec3d{k, k, k} : vector3(step, "scale", {-1e12, 1e12});
            t = Transform::scale(s);
            if (!(std::abs(t.determinant()) > 0.0)) step.fail("scale", "must not be zero");
        } else if (step.has("rotate")) {
            const std::vector<double> r = step.numbers("rotate", 4, {-1e6, 1e6});
            const Vec3d axis{r[0], r[1], r[2]};
            if (!(lengthSquared(axis) > 0.0)) step.fail("rotate", "the axis must not be zero");
            t = Transform::rotate(normalize(axis), r[3]);
        } else if (step.has("translate")) {
            t = Transform::translate(vector3(step, "translate"));
        }
        step.finish();
        result = t * result;
    }
    return result;
}

void loadMeshes(const std::vector<ConfigTable>& meshes, const std::vector<ConfigTable>& instances,
                LoadingScene& loading) {
    std::map<std::string, DressedMesh> byName;
    std::vector<std::string> names;
    for (const ConfigTable& table : meshes) {
        const DressedMesh mesh = loadMesh(table, loading);
        if (table.has("name")) {
            const std::string name = table.text("name");
            if (!byName.emplace(name, mesh).second) table.fail("name", "used by an earlier mesh");
            names.push_back(name);
        }
        const Transform transform = loadTransform(table, "transform");
        if (!table.boolean("hidden", false)) placeMesh(mesh, transform, table, loading);
        table.finish();
    }
    for (const ConfigTable& table : instances) {
        DressedMesh mesh = byName.at(table.choice("mesh", names));
        if (table.has("material"))
            for (const Material*& slot : mesh.materials)
                slot = findMaterial(table, "material", loading);
        placeMesh(mesh, loadTransform(table, "transform"), table, loading);
        table.finish();
    }
}

void addModel(const std::filesystem::path& file, LoadingScene& loading) {
    const DressedMesh mesh = addModelFile(file, loading);
    for (const Vec3& p : loading.parts.meshes[mesh.index].positions)
        if (!isNear(toDouble(p))) throw InputError(file.string() + ": a vertex beyond 1e15 m");
    loading.parts.placements.push_back({mesh.index, {}, mesh.materials});
}

}  // namespace etendue
