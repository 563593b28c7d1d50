// VertexPool: gives a mesh one vertex for all the triangle corners that are alike.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/mesh.h"

namespace etendue {

struct MeshVertex {
    Vec3 position;
    Vec3 normal;
    Vec2 textureCoordinate;
};

class VertexPool {
public:
    /// `mesh` has no vertices yet and must outlive this. What it shall not have is neither stored
    /// nor compared.
    VertexPool(Mesh& mesh, bool hasNormals, bool hasTextureCoordinates)
        : mesh_(mesh), hasNormals_(hasNormals), hasTextureCoordinates_(hasTextureCoordinates) {}

    /// The index of a vertex equal to this one.
    std::uint32_t add(MeshVertex vertex);

private:
    static constexpr std::uint32_t empty = 0xffffffffu;

    bool isEqual(std::uint32_t index, const MeshVertex& vertex) const;
    MeshVertex vertexAt(std::uint32_t index) const;
    /// Where in the table a vertex is, or would be.
    std::size_t slotOf(const MeshVertex& vertex) const;
    void grow();

    Mesh& mesh_;
    bool hasNormals_, hasTextureCoordinates_;
    // Open addressing with linear probing; a power of two in size, at most half full.
    std::vector<std::uint32_t> table_ = std::vector<std::uint32_t>(1024, empty);
};

}  // namespace etendue
