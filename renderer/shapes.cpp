#include "renderer/shapes.h"

#include "renderer/shape_builder.h"

namespace etendue {
namespace {

/// A circle of latitude of the sphere: four quadrants of `pieces` sides, or a pole if that is zero.
struct LatitudeRow {
    std::uint32_t first;
    int pieces;

    std::uint32_t vertex(int quadrant, int k) const {
        return first + static_cast<std::uint32_t>(pieces == 0 ? quadrant : quadrant * pieces + k);
    }
};

LatitudeRow addLatitude(ShapeBuilder& builder, int row, int rows) {
    const LatitudeRow result{builder.nextVertex(), std::min(row, rows - row)};
    const Vec2d meridian = circlePoint(row, 2 * rows);  // from the south pole
    const double v = static_cast<double>(row) / rows;
    const auto add = [&](Vec2d circle, double u) {
        const Vec3d p = {meridian.y * circle.x, meridian.y * circle.y, -meridian.x};
        builder.addVertex({p, p, {u, v}});
    };
    const int sides = 4 * result.pieces;
    for (int i = 0; sides > 0 && i <= sides; ++i)
        add(circlePoint(i, sides), static_cast<double>(i) / sides);
    for (int quadrant = 0; sides == 0 && quadrant < 4; ++quadrant)
        add({0, 0}, (quadrant + 0.5) / 4);
    return result;
}

/// Between neighbours whose quadrants differ by one side.
void addLatitudeBand(ShapeBuilder& builder, LatitudeRow lower, LatitudeRow upper) {
    const bool isWidening = upper.pieces > lower.pieces;
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
        const auto low = [&](int k) { return lower.vertex(quadrant, k); };
        const auto high = [&](int k) { return upper.vertex(quadrant, k); };
        for (int k = 0; k < lower.pieces; ++k)
            builder.addTriangle(low(k), low(k + 1), high(isWidening ? k + 1 : k));
        for (int k = 0; k < upper.pieces; ++k)
            builder.addTriangle(low(isWidening ? k : k + 1), high(k + 1), high(k));
    }
}

/// Disc at height z, its front side up or down.
void addDisc(ShapeBuilder& builder, int segments, double z, bool facesUp) {
    const Vec3d normal = {0, 0, facesUp ? 1.0 : -1.0};
    const auto add = [&](Vec2d p) {
        const Vec2d uv = {0.5 + 0.5 * p.x, 0.5 + 0.5 * p.y * normal.z};
        return builder.addVertex({{p.x, p.y, z}, normal, uv});
    };
    const std::uint32_t center = add({0, 0});
    for (int i = 0; i < segments; ++i) add(circlePoint(i, segments));
    for (int i = 0; i < segments; ++i) {
        const std::uint32_t a = center + 1 + static_cast<std::uint32_t>(i);
        const std::uint32_t b = i + 1 < segments ? a + 1 : center + 1;
        builder.addTriangle(center, facesUp ? a : b, facesUp ? b : a);
    }
}

}  // namespace

Mesh makeSphere(int segments) {
    requireCount("sphere", "segments", segments, 3);
    const int rows = 2 * ((segments + 3) / 4);
    ShapeBuilder builder;
    LatitudeRow below = addLatitude(builder, 0, rows);
    for (int row = 1; row <= rows; ++row) {
        const LatitudeRow current = addLatitude(builder, row, rows);
        addLatitudeBand(builder, below, current);
        below = current;
    }
    return std::move(builder).smooth();
}

Mesh makeRectangle(int subdivisions) {
    requireCount("rectangle", "subdivisions", subdivisions, 1);
    ShapeBuilder builder;
    builder.addGrid(subdivisions, subdivisions, [&](int column, int row) {
        const Vec2d uv =
            Vec2d{static_cast<double>(column), static_cast<double>(row)} * (1.0 / subdivisions);
        return ShapeVertex{{2 * uv.x - 1, 2 * uv.y - 1, 0}, {0, 0, 1}, uv};
    });
    return std::move(builder).flat();
}

Mesh makeBox() {
    ShapeBuilder builder;
    for (const Vec3d normal : {Vec3d{-1, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 1, 0},
                               Vec3d{0, 0, -1}, Vec3d{0, 0, 1}}) {
        const Vec3d up = normal.z == 0 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
        const Vec3d right = cross(up, normal);
        builder.addGrid(1, 1, [&](int column, int row) {
            const Vec3d p = normal + right * (2.0 * column - 1) + up * (2.0 * row - 1);
            return ShapeVertex{p, normal, {static_cast<double>(column), static_cast<double>(row)}};
        });
    }
    return std::move(builder).flat();
}

Mesh makeDisc(int segments) {
    requireCount("disc", "segments", segments, 3);
    ShapeBuilder builder;
    addDisc(builder, segments, 0, true);
    return std::move(builder).flat();
}

Mesh makeCylinder(int segments, bool capped) {
    requireCount("cylinder", "segments", segments, 3);
    ShapeBuilder builder;
    builder.addGrid(segments, 1, [&](int column, int row) {
        const Vec2d p = circlePoint(column, segments);
        return ShapeVertex{{p.x, p.y, static_cast<double>(row)},
                           {p.x, p.y, 0},
                           {static_cast<double>(column) / segments, static_cast<double>(row)}};
    });
    if (capped) {
        addDisc(builder, segments, 0, false);
        addDisc(builder, segments, 1, true);
    }
    return std::move(builder).smooth();
}

Mesh makeTorus(float minorRadius, int majorSegments, int minorSegments) {
    if (!(minorRadius > 0 && minorRadius < 1))
        throw std::invalid_argument("torus: minor radius is " + std::to_string(minorRadius) +
                                    ", must be between 0 and 1");
    requireCount("torus", "major segments", majorSegments, 3);
    requireCount("torus", "minor segments", minorSegments, 3);
    ShapeBuilder builder;
    builder.addGrid(majorSegments, minorSegments, [&](int column, int row) {
        const Vec2d major = circlePoint(column, majorSegments);
        const Vec2d minor = circlePoint(row, minorSegments);
        const Vec3d normal = {major.x * minor.x, major.y * minor.x, minor.y};
        return ShapeVertex{Vec3d{major.x, major.y, 0} + normal * static_cast<double>(minorRadius),
                           normal,
                           {static_cast<double>(column) / majorSegments,
                            static_cast<double>(row) / minorSegments}};
    });
    return std::move(builder).smooth();
}

}  // namespace etendue
