#include "renderer/vertex_pool.h"

#include <bit>

namespace etendue {
namespace {

std::uint64_t bits(float a, float b) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(a)} << 32 | std::bit_cast<std::uint32_t>(b);
}

/// Multiply-xorshift over 64-bit words; the multiplier is 2^64 divided by the golden ratio.
std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 32;
}

std::uint64_t hashOf(const MeshVertex& v) {
    std::uint64_t hash = mix(0, bits(v.position.x, v.position.y));
    hash = mix(hash, bits(v.position.z, v.normal.x));
    hash = mix(hash, bits(v.normal.y, v.normal.z));
    return mix(hash, bits(v.textureCoordinate.x, v.textureCoordinate.y));
}

}  // namespace

std::uint32_t VertexPool::add(MeshVertex vertex) {
    if (!hasNormals_) vertex.normal = {};
    if (!hasTextureCoordinates_) vertex.textureCoordinate = {};
    std::uint32_t& slot = table_[slotOf(vertex)];
    if (slot != empty) return slot;
    const auto index = static_cast<std::uint32_t>(mesh_.positions.size());
    slot = index;
    mesh_.positions.push_back(vertex.position);
    if (hasNormals_) mesh_.normals.push_back(vertex.normal);
    if (hasTextureCoordinates_) mesh_.textureCoordinates.push_back(vertex.textureCoordinate);
    if (2 * mesh_.positions.size() > table_.size()) grow();
    return index;
}

bool VertexPool::isEqual(std::uint32_t index, const MeshVertex& v) const {
    const MeshVertex other = vertexAt(index);
    return other.position == v.position && other.normal == v.normal &&
           other.textureCoordinate == v.textureCoordinate;
}

MeshVertex VertexPool::vertexAt(std::uint32_t index) const {
    return {mesh_.positions[index], hasNormals_ ? mesh_.normals[index] : Vec3{},
            hasTextureCoordinates_ ? mesh_.textureCoordinates[index] : Vec2{}};
}

std::size_t VertexPool::slotOf(const MeshVertex& vertex) const {
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = hashOf(vertex) & mask;
    while (table_[slot] != empty && !isEqual(table_[slot], vertex)) slot = (slot + 1) & mask;
    return slot;
}

void VertexPool::grow() {
    table_.assign(2 * table_.size(), empty);
    for (std::uint32_t i = 0; i < mesh_.positions.size(); ++i) table_[slotOf(vertexAt(i))] = i;
}

}  // namespace etendue
