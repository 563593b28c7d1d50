// Shading normals computed from a mesh's triangles.
#pragma once

#include "renderer/mesh.h"

namespace etendue {

/// Every triangle shades with its own plane.
void makeFlat(Mesh& mesh);

/// Gives every vertex the mean of the normals of the triangles around it, each weighted by its
/// angle there (Thürmer and Wüthrich 1998, "Computing Vertex Normals from Polygonal Facets").
/// Vertices at equal positions count as one. An edge is a crease, across which nothing is averaged,
/// when its two triangles' normals differ by more than `maxAngleDegrees`, and unless it belongs to
/// exactly two triangles that agree on the front side. Vertices are split where a crease needs it;
/// the order of triangles, and their texture coordinates, stay. Earlier normals are replaced.
/// Triangles without area have no say; their own normals, which nobody sees, are +z.
void makeSmooth(Mesh& mesh, float maxAngleDegrees);

}  // namespace etendue
