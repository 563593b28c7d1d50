#include "renderer/vertex_pool.h"

#include <doctest/doctest.h>

namespace etendue {
namespace {

/// 20^3 vertices that differ in a coordinate of their position, of their normal, or of their
/// texture coordinate.
MeshVertex vertexOf(int i) {
    const auto x = static_cast<float>(i % 20), y = static_cast<float>(i / 20 % 20),
               z = static_cast<float>(i / 400);
    return {{x, 0, 0}, {0, y, 0}, {0, z}};
}

constexpr int vertexCount = 20 * 20 * 20;

/// How many remain after each has been added twice.
std::size_t countDifferent(bool hasNormals, bool hasTextureCoordinates) {
    Mesh mesh;
    VertexPool pool(mesh, hasNormals, hasTextureCoordinates);
    for (int round = 0; round < 2; ++round) {
        for (int i = 0; i < vertexCount; ++i) {
            const MeshVertex vertex = vertexOf(i);
            const std::uint32_t index = pool.add(vertex);
            REQUIRE(index < mesh.positions.size());
            REQUIRE(mesh.positions[index] == vertex.position);
            if (hasNormals) REQUIRE(mesh.normals[index] == vertex.normal);
            if (hasTextureCoordinates)
                REQUIRE(mesh.textureCoordinates[index] == vertex.textureCoordinate);
        }
    }
    return mesh.positions.size();
}

}  // namespace

TEST_CASE("VertexPool: keeps one of each vertex, however many there are") {
    CHECK(countDifferent(true, true) == 20 * 20 * 20);
    CHECK(countDifferent(true, false) == 20 * 20);
    CHECK(countDifferent(false, true) == 20 * 20);
    CHECK(countDifferent(false, false) == 20);
}

}  // namespace etendue
