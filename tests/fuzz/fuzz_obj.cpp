// OBJ and MTL: what loads is a mesh without holes in its tables, and renders.
//
// An input is the OBJ, a line "=== mtl", and the MTL that is found as "m.mtl"; "t.png" is an image.
#include <algorithm>
#include <cctype>

#include "renderer/obj_loader.h"
#include "tests/fuzz/scene_checks.h"

using namespace etendue;

namespace {

/// Names stay in the folder: a slash parts a face's indices, and nothing else.
bool namesAnotherFolder(std::string_view text) {
    const auto isOfName = [](char c) {
        return std::isalpha(static_cast<unsigned char>(c)) || c == '.';
    };
    for (std::size_t i = 0; i + 1 < text.size(); ++i)
        if ((text[i] == '/' || text[i] == '\\') && isOfName(text[i + 1])) return true;
    return false;
}

void checkMesh(const Mesh& mesh) {
    require(!mesh.triangles.empty(), "a mesh without triangles");
    require(mesh.materialOfTriangle.size() == mesh.triangles.size(), "a triangle without material");
    require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(),
            "normals for some vertices alone");
    require(
        mesh.textureCoordinates.empty() || mesh.textureCoordinates.size() == mesh.positions.size(),
        "texture coordinates for some vertices alone");
    for (const std::uint16_t material : mesh.materialOfTriangle)
        require(material < mesh.materialNames.size(), "a material that is none");
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle)
            require(vertex < mesh.positions.size(), "a vertex that is none");
    for (const Vec3& p : mesh.positions) require(isFinite(p), "a vertex that is nowhere");
    for (const Vec3& n : mesh.normals)
        require(std::abs(length(n) - 1.0f) < 1e-4f, "a normal that is no unit");
    for (const Vec2& t : mesh.textureCoordinates)
        require(std::isfinite(t.x) && std::isfinite(t.y),
                "a texture coordinate that is not finite");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FuzzFolder folder = folderWithImages();
    const std::string_view text = textOf(data, size);
    if (namesAnotherFolder(text)) return 0;
    constexpr std::string_view separator = "\n=== mtl\n";
    const std::size_t at = text.find(separator);
    folder.write("m.mtl", at == text.npos ? "" : text.substr(at + separator.size()));
    const std::filesystem::path file = folder.write("m.obj", text.substr(0, at));
    try {
        const ObjModel model = loadObj(file);
        checkMesh(model.mesh);
        require(model.materials.size() == model.mesh.materialNames.size(),
                "materials and their names do not match");
        checkRender(file);
    } catch (const InputError&) {
    }
    return 0;
}
