// What the tests of OBJ files share.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "renderer/obj_loader.h"
#include "tests/config/error_message.h"
#include "tests/renderer/mesh_measures.h"
#include "tests/support/temporary_folder.h"

namespace etendue {

/// The corners of the unit square, four lines.
inline const std::string squareCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// The unit cube, quadrilaterals seen from outside.
inline const std::string cubeText =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// A folder with model.obj in it, and what else a test writes.
class ObjFixture {
public:
    ObjModel load(const std::string& text) const {
        writeFile(file(), text);
        return loadObj(file());
    }
    std::string errorOf(const std::string& text) const {
        return errorMessage([&] { load(text); });
    }
    void write(const std::string& name, const std::string& text) const {
        writeFile(folder_ / name, text);
    }
    void makeFolder(const std::string& name) const {
        std::filesystem::create_directory(folder_ / name);
    }
    std::filesystem::path file() const { return folder_ / "model.obj"; }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    bool hasNote(const ObjModel& model, const std::string& note) const {
        return std::ranges::count(model.notes, note) == 1;
    }

private:
    TemporaryFolder folder_;
};

/// What every mesh of a loaded file must be.
inline void checkIsConsistent(const ObjModel& model) {
    const Mesh& mesh = model.mesh;
    REQUIRE(!mesh.triangles.empty());
    CHECK(mesh.materialOfTriangle.size() == mesh.triangles.size());
    CHECK(model.materials.size() == mesh.materialNames.size());
    CHECK((mesh.normals.empty() || mesh.normals.size() == mesh.positions.size()));
    CHECK((mesh.textureCoordinates.empty() ||
           mesh.textureCoordinates.size() == mesh.positions.size()));
    for (const Vec3& p : mesh.positions) CHECK(isFinite(p));
    // Rounding of three components to float.
    for (const Vec3& n : mesh.normals) CHECK(std::abs(length(toDouble(n)) - 1.0) < 2 * 0x1p-24);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        CHECK(mesh.materialOfTriangle[t] < mesh.materialNames.size());
        for (const std::uint32_t i : mesh.triangles[t]) REQUIRE(i < mesh.positions.size());
        const Vec3d front = areaVector(cornersOf(mesh, t));
        CHECK(length(front) > 0);
        if (!mesh.normals.empty())
            for (const std::uint32_t i : mesh.triangles[t])
                CHECK(dot(toDouble(mesh.normals[i]), normalize(front)) > -2 * 0x1p-24);
    }
}

}  // namespace etendue
