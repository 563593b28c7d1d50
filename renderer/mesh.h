// Mesh: indexed triangles as the renderer keeps them, whatever file or shape they came from.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/vec.h"

namespace etendue {

/// Every vertex has a position; normals and texture coordinates are for all vertices or for none.
struct Mesh {
    std::string name;
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;                            // unit shading normals, or empty: flat
    std::vector<Vec2> textureCoordinates;                 // v upward, or empty
    std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from the front
    std::vector<std::uint16_t> materialOfTriangle;        // index into materialNames
    std::vector<std::string> materialNames;               // never empty if there are triangles
};

}  // namespace etendue
