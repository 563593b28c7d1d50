// From the polygons of an OBJ file to a mesh: triangles, shading normals, shared vertices.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/mesh.h"
#include "renderer/obj_scan.h"

namespace etendue {

/// Indices from 0; -1 where the file gives none.
struct ObjCorner {
    std::int32_t position = -1, textureCoordinate = -1, normal = -1;
};

/// The vertex lists and faces of the file, every index valid.
struct ObjPolygons {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  // of any length, 0 included
    std::vector<Vec2> textureCoordinates;
    std::vector<ObjCorner> corners;       // of all faces, one face after another
    std::vector<std::uint32_t> faceEnds;  // per face, the index behind its last corner
};

/// - Triangles without area are left out.
/// - A corner of a smoothing group that brings no normal gets the angle-weighted mean of its
///   group's triangles around the vertex (Thürmer and Wüthrich 1998, "Computing Vertex Normals from
///   Polygonal Facets"); without a group, or where the mean vanishes or looks to the back, the
///   triangle's own. A mesh in which no corner needs more than that has no normals at all.
/// - The file's normals must look to the front, which the winding says. Where those of all three
///   corners look to the back they are turned around; any other, and those of length 0, become the
///   triangle's own.
/// - Texture coordinates that are missing are 0 if any are there.
/// Repairs are counted in `notes`.
Mesh buildObjMesh(const ObjPolygons& polygons, const ObjScan& scan,
                  std::vector<std::string>& notes);

}  // namespace etendue
