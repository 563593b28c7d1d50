// What the tests of shapes and normals measure of a mesh, all in double.
#pragma once

#include <algorithm>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "renderer/mesh.h"

namespace etendue {

inline std::array<Vec3d, 3> cornersOf(const Mesh& mesh, std::size_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {toDouble(mesh.positions[a]), toDouble(mesh.positions[b]), toDouble(mesh.positions[c])};
}

/// Twice the area, along the front side.
inline Vec3d areaVector(const std::array<Vec3d, 3>& p) { return cross(p[1] - p[0], p[2] - p[0]); }

inline double areaOf(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        sum += 0.5 * length(areaVector(cornersOf(mesh, i)));
    return sum;
}

/// Of a closed mesh, by the divergence theorem; negative when it is inside out.
inline double volumeOf(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::array<Vec3d, 3> p = cornersOf(mesh, i);
        sum += dot(p[0], cross(p[1], p[2])) / 6;
    }
    return sum;
}

inline double longestEdge(const Mesh& mesh) {
    double longest = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::array<Vec3d, 3> p = cornersOf(mesh, i);
        longest =
            std::max({longest, length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
    }
    return longest;
}

struct EdgeCounts {
    int boundary = 0;  // sides that no other triangle shares
    int faulty = 0;    // shared by more than two, or by two that disagree on the front side
};

/// Vertices at equal positions count as one.
inline EdgeCounts countEdges(const Mesh& mesh) {
    const auto key = [](Vec3d p) { return std::tuple(p.x, p.y, p.z); };
    using Key = std::tuple<double, double, double>;
    std::map<std::pair<Key, Key>, int> sides;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::array<Vec3d, 3> p = cornersOf(mesh, i);
        for (std::size_t k = 0; k < 3; ++k) ++sides[{key(p[k]), key(p[(k + 1) % 3])}];
    }
    EdgeCounts result;
    for (const auto& [side, count] : sides) {
        if (count != 1) ++result.faulty;
        if (!sides.contains({side.second, side.first})) ++result.boundary;
    }
    return result;
}

/// Area and volume of a polyline of (radius, height) turned in `segments` steps. Every cell is
/// plane: a trapezoid whose parallel sides are chords of 2 r sin(π / segments).
inline double turnedArea(std::span<const Vec2> profile, int segments) {
    const double half = std::numbers::pi / segments;
    double sum = 0;
    for (std::size_t i = 1; i < profile.size(); ++i) {
        const Vec2 a = profile[i - 1], b = profile[i];
        const double height = std::hypot((b.x - a.x) * std::cos(half), b.y - a.y);
        sum += std::sin(half) * segments * (a.x + b.x) * height;
    }
    return sum;
}

inline double turnedVolume(std::span<const Vec2> profile, int segments) {
    const double polygon = 0.5 * segments * std::sin(2 * std::numbers::pi / segments);
    double sum = 0;
    for (std::size_t i = 1; i < profile.size(); ++i) {
        const double a = profile[i - 1].x, b = profile[i].x;
        sum += polygon * (a * a + a * b + b * b) / 3 * (profile[i].y - profile[i - 1].y);
    }
    return sum;
}

}  // namespace etendue
