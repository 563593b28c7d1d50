#include "renderer/shape_builder.h"

#include "renderer/mesh_normals.h"

namespace etendue {

Vec2d circlePoint(int index, int count) {
    const int quadrant = 4 * index / count % 4;
    const double angle = 0.5 * std::numbers::pi * (4 * index % count) / count;
    const double c = std::cos(angle), s = std::sin(angle);
    switch (quadrant) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case 2:
            return {-c, -s};
        default:
            return {s, -c};
    }
}

void requireCount(std::string_view shape, std::string_view name, int value, int lowest) {
    constexpr int highest = 4096;
    if (value >= lowest && value <= highest) return;
    throw std::invalid_argument(std::string(shape) + ": " + std::string(name) + " is " +
                                std::to_string(value) + ", must be from " + std::to_string(lowest) +
                                " to " + std::to_string(highest));
}

std::uint32_t ShapeBuilder::addVertex(const ShapeVertex& vertex) {
    const std::uint32_t index = nextVertex();
    mesh_.positions.push_back(toFloat(vertex.position));
    mesh_.normals.push_back(toFloat(vertex.normal));
    mesh_.textureCoordinates.push_back(
        {static_cast<float>(vertex.uv.x), static_cast<float>(vertex.uv.y)});
    return index;
}

void ShapeBuilder::addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.triangles.push_back({a, b, c});
    mesh_.materialOfTriangle.push_back(0);
}

void ShapeBuilder::addBand(VertexRow lower, VertexRow upper, int columns) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
        const std::uint32_t a = lower.first + i, b = a + 1, d = upper.first + i, c = d + 1;
        if (lower.isPole) {
            addTriangle(a, c, d);
        } else if (upper.isPole) {
            addTriangle(a, b, d);
        } else {
            addTriangle(a, b, c);
            addTriangle(a, c, d);
        }
    }
}

Mesh ShapeBuilder::flat() && {
    makeFlat(mesh_);
    return std::move(mesh_);
}

}  // namespace etendue
