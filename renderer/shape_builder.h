// ShapeBuilder: what the built-in shapes are put together with.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "renderer/mesh.h"

namespace etendue {

using Vec2d = Vec2T<double>;

/// Point `index` of the regular polygon of `count` corners on the unit circle, counter-clockwise
/// from (1, 0). Periodic in `index`, and exact on the axes: seams close to the last bit.
Vec2d circlePoint(int index, int count);

/// Throws std::invalid_argument unless `value` is at least `lowest` and not absurd.
void requireCount(std::string_view shape, std::string_view name, int value, int lowest);

struct ShapeVertex {
    Vec3d position;
    Vec3d normal;  // unit
    Vec2d uv;
};

/// Vertices from one side of a band to the other. At a pole they coincide, and there is one per
/// triangle, so that each can have its own texture coordinate.
struct VertexRow {
    std::uint32_t first;
    bool isPole;
};

class ShapeBuilder {
public:
    ShapeBuilder() { mesh_.materialNames = {""}; }

    std::uint32_t addVertex(const ShapeVertex& vertex);
    void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

    /// The strip between two rows of `columns` + 1 vertices (a pole: `columns`). Seen from the
    /// front, the rows run to the right and `upper` is above `lower`.
    void addBand(VertexRow lower, VertexRow upper, int columns);

    /// Bands of `columns` cells between `rows` + 1 rows; vertexAt(column, row).
    template <class VertexAt>
    void addGrid(int columns, int rows, VertexAt vertexAt) {
        VertexRow below{};
        for (int row = 0; row <= rows; ++row) {
            const VertexRow current{nextVertex(), false};
            for (int column = 0; column <= columns; ++column) addVertex(vertexAt(column, row));
            if (row > 0) addBand(below, current, columns);
            below = current;
        }
    }

    std::uint32_t nextVertex() const { return static_cast<std::uint32_t>(mesh_.positions.size()); }

    Mesh smooth() && { return std::move(mesh_); }
    /// Without the normals.
    Mesh flat() &&;

private:
    Mesh mesh_;
};

}  // namespace etendue
