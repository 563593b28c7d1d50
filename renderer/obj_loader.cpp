#include "renderer/obj_loader.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <istream>
#include <map>
#include <set>
#include <streambuf>

#include "renderer/obj_mesh.h"
#include "renderer/obj_scan.h"
#include "renderer/referenced_file.h"
#include "renderer/text_lines.h"

namespace etendue {
namespace {

/// A stream over text that stays where it is.
class TextBuffer : public std::streambuf {
public:
    explicit TextBuffer(std::string& text) {
        setg(text.data(), text.data(), text.data() + text.size());
    }
};

std::int32_t resolve(int index, std::size_t count) {
    if (index == 0) return -1;  // absent: a 0 in the file does not pass the scan
    return index > 0 ? index - 1 : static_cast<std::int32_t>(count) + index;
}

void addFace(void* user, tinyobj::index_t* indices, int count) {
    ObjPolygons& p = *static_cast<ObjPolygons*>(user);
    for (int i = 0; i < count; ++i)
        p.corners.push_back({resolve(indices[i].vertex_index, p.positions.size()),
                             resolve(indices[i].texcoord_index, p.textureCoordinates.size()),
                             resolve(indices[i].normal_index, p.normals.size())});
    p.faceEnds.push_back(static_cast<std::uint32_t>(p.corners.size()));
}

/// tinyobjloader's own triangulation loses or inverts parts of concave polygons, and its plain
/// interface cuts material names at blanks; its callbacks hand out the faces as they are.
ObjPolygons parse(std::string& text, const ObjScan& scan) {
    ObjPolygons result;
    result.positions.reserve(scan.positions);
    result.normals.reserve(scan.normals);
    result.textureCoordinates.reserve(scan.textureCoordinates);
    result.corners.reserve(scan.corners);
    result.faceEnds.reserve(scan.faces);

    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* user, float x, float y, float z, float) {
        static_cast<ObjPolygons*>(user)->positions.push_back({x, y, z});
    };
    callbacks.normal_cb = [](void* user, float x, float y, float z) {
        static_cast<ObjPolygons*>(user)->normals.push_back({x, y, z});
    };
    callbacks.texcoord_cb = [](void* user, float u, float v, float) {
        static_cast<ObjPolygons*>(user)->textureCoordinates.push_back({u, v});
    };
    callbacks.index_cb = addFace;
    TextBuffer buffer(text);
    std::istream stream(&buffer);
    tinyobj::LoadObjWithCallback(stream, callbacks, &result);
    return result;
}

/// That the parser saw what the scan saw. Nothing is known to pass the one and upset the other but
/// exponents such as 0e999.
void check(const ObjPolygons& p, const ObjScan& scan, const std::filesystem::path& file) {
    const auto isIn = [](std::int32_t index, std::size_t count) {
        return index >= 0 && static_cast<std::size_t>(index) < count;
    };
    const bool isValid =
        p.positions.size() == scan.positions && p.normals.size() == scan.normals &&
        p.textureCoordinates.size() == scan.textureCoordinates &&
        p.corners.size() == scan.corners && p.faceEnds.size() == scan.faces &&
        std::ranges::all_of(p.corners,
                            [&](const ObjCorner& c) {
                                return isIn(c.position, p.positions.size()) &&
                                       (c.normal == -1 || isIn(c.normal, p.normals.size())) &&
                                       (c.textureCoordinate == -1 ||
                                        isIn(c.textureCoordinate, p.textureCoordinates.size()));
                            }) &&
        std::ranges::all_of(p.positions, isFinite<float>) &&
        std::ranges::all_of(p.normals, isFinite<float>) &&
        std::ranges::all_of(p.textureCoordinates,
                            [](Vec2 t) { return std::isfinite(t.x) && std::isfinite(t.y); });
    if (!isValid)
        throw InputError(file.string() + ": holds numbers that tinyobjloader cannot read");
}

std::string quotedList(const std::set<std::string>& names) {
    constexpr std::size_t most = 10;
    std::string result;
    for (std::size_t left = most; const std::string& name : names) {
        if (!result.empty()) result += ", ";
        if (left-- == 0) return result + "...";
        result += quoteForMessage(name);
    }
    return result;
}

/// The files of a statement: one name with blanks if there is such a file, else one per word.
std::vector<std::filesystem::path> findLibraries(const ObjLibrary& library,
                                                 const std::filesystem::path& objFile,
                                                 std::vector<std::string>& notes) {
    const std::filesystem::path folder = objFile.parent_path();
    const std::string where = objFile.string() + ":" + std::to_string(library.line);
    if (auto file = findAsWritten(folder, library.names)) return {*file};
    std::vector<std::filesystem::path> files;
    std::string names = library.names;
    TextLines words(names, objFile);
    if (!words.next()) notes.push_back(where + ": mtllib names no file");
    while (!words.atEnd()) {
        const std::string name(words.word());
        if (auto file = findReferencedFile(folder, name, where, notes))
            files.push_back(*file);
        else
            notes.push_back(where + ": no file " + quoteForMessage(name) + " with materials");
    }
    return files;
}

void addMaterials(const ObjScan& scan, ObjModel& model) {
    const std::filesystem::path objFile = model.files.front();
    std::set<std::string> wanted(scan.materialNames.begin(), scan.materialNames.end());
    std::map<std::string, ObjMaterial> found;
    for (const ObjLibrary& library : scan.libraries) {
        for (const std::filesystem::path& file : findLibraries(library, objFile, model.notes)) {
            if (std::ranges::find(model.files, file) != model.files.end()) continue;
            model.files.push_back(file);
            for (ObjMaterial& m : readMtl(file, wanted, model.notes)) {
                wanted.erase(m.name);
                found.emplace(m.name, std::move(m));
            }
        }
    }
    for (const std::string& name : scan.materialNames) {
        const auto entry = found.find(name);
        model.materials.push_back(entry == found.end() ? ObjMaterial{} : entry->second);
        model.materials.back().name = name;
    }
    if (wanted.erase("") > 0)
        model.notes.push_back(objFile.string() + ": faces without a material: grey");
    if (!wanted.empty())
        model.notes.push_back(objFile.string() + ": no MTL file defines " + quotedList(wanted) +
                              ": grey");
}

/// A file gone wrong can give rise to a note a line.
void shorten(std::vector<std::string>& notes) {
    constexpr std::size_t most = 100;
    if (notes.size() <= most) return;
    const std::size_t more = notes.size() - most;
    notes.resize(most);
    notes.push_back("and " + std::to_string(more) + " more notes");
}

}  // namespace

ObjModel loadObj(const std::filesystem::path& file) {
    ObjModel model;
    model.files = {file};
    std::string text = readText(file);
    ObjScan scan = scanObj(text, file);
    const ObjPolygons polygons = parse(text, scan);
    check(polygons, scan, file);
    std::string().swap(text);  // no longer needed, and larger than the mesh

    std::vector<std::string> repairs;
    model.mesh = buildObjMesh(polygons, scan, repairs);
    model.mesh.name = file.stem().string();
    if (model.mesh.triangles.empty()) throw InputError(file.string() + ": no triangle has an area");
    model.notes = std::move(scan.notes);
    for (const std::string& repair : repairs) model.notes.push_back(file.string() + ": " + repair);
    addMaterials(scan, model);
    shorten(model.notes);
    return model;
}

}  // namespace etendue
