// Wavefront OBJ files with their materials. tinyobjloader is known to obj_loader.cpp alone.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/mesh.h"
#include "renderer/mtl_reader.h"

namespace etendue {

struct ObjModel {
    Mesh mesh;                                 // named after the file
    std::vector<ObjMaterial> materials;        // one for each of mesh.materialNames, in their order
    std::vector<std::string> notes;            // what was ignored, repaired or missing: not errors
    std::vector<std::filesystem::path> files;  // all that were read: the OBJ, then MTLs
};

/// Polygons of any shape become triangles; lines, points, free-form surfaces and vertex colours are
/// ignored with a note. A material that no MTL file defines, or whose MTL file is missing, is grey
/// with a note. Throws InputError, "file:line: …" wherever a line is to blame: scanObj, readMtl,
/// and a model in which no triangle has an area.
ObjModel loadObj(const std::filesystem::path& file);

}  // namespace etendue
