// Models that others wrote, from Debian's packages assimp-testmodels and glmark2-data.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include "renderer/obj_loader.h"
#include "tests/config/error_message.h"
#include "tests/renderer/mesh_measures.h"
#include "tests/support/temporary_folder.h"

namespace etendue {
namespace {

/// What must be refused, and how the message goes on behind the file's name.
const std::map<std::string, std::string> refused = {
    {"box_UTF16BE.obj", ": UTF-16 text, expected UTF-8"},
    {"number_formats.obj", ":11: expected a number, found \"3.1+e2\""},
    {"point_cloud.obj", ": no faces (f)"},
    {"testline.obj", ": no faces (f)"},
    {"testpoints.obj", ": no faces (f)"},
    {"empty.obj", ": no faces (f)"},
    {"malformed.obj", ":28: index 0 in \"0\", they count from 1"},
    {"malformed2.obj", ":23: f: expected 3 to 4096 corners, found 0"},
};

/// Every .obj file of the packages; none if they are not installed.
std::vector<std::filesystem::path> realModels() {
    std::vector<std::filesystem::path> files;
    for (const char* folder : {"/usr/share/assimp/models", "/usr/share/glmark2/models"}) {
        std::error_code notInstalled;
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(folder, notInstalled))
            if (entry.path().extension() == ".obj") files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

/// A reader of its own for the test: lenient, slow, and simple.
std::vector<std::vector<Vec3d>> readFaces(const std::filesystem::path& file) {
    std::istringstream lines(readFile(file));
    std::vector<Vec3d> positions;
    std::vector<std::vector<Vec3d>> faces;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string keyword, word;
        words >> keyword;
        if (keyword == "v") {
            float x = 0, y = 0, z = 0;
            words >> x >> y >> z;
            positions.push_back({x, y, z});
        } else if (keyword == "f") {
            std::vector<Vec3d>& face = faces.emplace_back();
            while (words >> word) {
                const long index = std::atol(word.c_str());
                face.push_back(positions.at(static_cast<std::size_t>(
                    index > 0 ? index - 1 : static_cast<long>(positions.size()) + index)));
            }
        }
    }
    return faces;
}

struct Expectation {
    std::size_t triangles = 0;
    double area = 0;  // along each face's normal (Newell)
};

/// n - 2 triangles per face; a face of three corners on a line makes none.
Expectation expectationOf(const std::vector<std::vector<Vec3d>>& faces) {
    Expectation result;
    for (const std::vector<Vec3d>& face : faces) {
        Vec3d sum;
        for (std::size_t i = 0; i + 2 < face.size(); ++i)
            sum += cross(face[i + 1] - face[0], face[i + 2] - face[0]);
        if (face.size() > 3 || length(sum) > 0) result.triangles += face.size() - 2;
        result.area += 0.5 * length(sum);
    }
    return result;
}

void checkModel(const ObjModel& model, const std::filesystem::path& file) {
    const Expectation expected = expectationOf(readFaces(file));
    const bool windsAround = file.filename() == "box_longline.obj";
    // One of its faces goes 234 times around a square, where two triangles a turn have an area; the
    // other five are squares.
    CHECK(model.mesh.triangles.size() == (windsAround ? 5 * 2 + 234 * 2 : expected.triangles));
    // Overlaps or pieces outside of concave faces would add area. Some quadrilaterals are not flat:
    // their triangles have a little more area than they have along the normal.
    CHECK(areaOf(model.mesh) >= expected.area * (1 - 1e-6));
    CHECK(areaOf(model.mesh) <= expected.area * (1 + 1e-4));
    CHECK(model.materials.size() == model.mesh.materialNames.size());
    for (const ObjMaterial& m : model.materials)
        CHECK((m.diffuseMap.empty() || std::filesystem::exists(m.diffuseMap)));
}

/// Of a model that is installed: tests on it are skipped where it is not.
std::optional<ObjModel> loadInstalled(const std::string& name) {
    const std::filesystem::path file = "/usr/share/assimp/models/OBJ/" + name;
    if (!std::filesystem::exists(file)) {
        MESSAGE("skipped: assimp-testmodels is not installed");
        return {};
    }
    return loadObj(file);
}

}  // namespace

TEST_CASE("loadObj: every real model loads with the right triangles or is refused as expected") {
    const std::vector<std::filesystem::path> files = realModels();
    if (files.empty()) MESSAGE("skipped: neither assimp-testmodels nor glmark2-data is installed");
    for (const std::filesystem::path& file : files) {
        const std::string name = file.filename().string();
        CAPTURE(name);
        if (const auto entry = refused.find(name); entry != refused.end())
            CHECK(errorMessage([&] { loadObj(file); }) == file.string() + entry->second);
        else
            checkModel(loadObj(file), file);
    }
}

TEST_CASE("loadObj: real materials with blanks in their names, without a name, without a file") {
    if (const auto model = loadInstalled("box_mat_with_spaces.obj")) {
        CHECK(model->materials.at(0).name == "Material name with many, many spaces");
        CHECK(model->materials.at(0).diffuse == Vec3{0.2f, 0.2f, 0.2f});
    }
    if (const auto model = loadInstalled("empty_mat.obj")) {
        CHECK(model->materials.at(0).name == "");
        CHECK(model->materials.at(0).diffuse == Vec3{0.8f, 0.8f, 0.8f});
    }
    if (const auto model = loadInstalled("cube_mtllib_after_g.obj")) {
        CHECK(model->materials.at(0).diffuse == Vec3{0.5f, 0.5f, 0.5f});
        CHECK(contains(model->notes.at(0), ":2: no file \"cube_mtllib_after_g.mat\""));
    }
}

TEST_CASE("loadObj: the images of a model made on Windows are found") {
    if (const auto model = loadInstalled("spider.obj")) {
        REQUIRE(model->materials.size() == 4);
        CHECK(model->materials[1].name == "Skin");
        CHECK(model->materials[1].diffuseMap.filename() == "wal67ar_small.jpg");
        CHECK(model->files.size() == 2);
    }
}

}  // namespace etendue
