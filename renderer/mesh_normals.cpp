#include "renderer/mesh_normals.h"

#include <numeric>
#include <tuple>

namespace etendue {
namespace {

// A corner is a triangle's view of one of its vertices: corner 3 t + k belongs to triangle t.
using Index = std::uint32_t;

constexpr Index nextCorner(Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
constexpr Index previousCorner(Index corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

double angleBetween(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

/// For every vertex the first one (in some fixed order) that lies at the same position.
std::vector<Index> weld(const std::vector<Vec3>& positions) {
    std::vector<Index> order(positions.size());
    std::iota(order.begin(), order.end(), Index{0});
    const auto key = [&](Index i) {
        return std::tuple(positions[i].x, positions[i].y, positions[i].z, i);
    };
    std::ranges::sort(order, {}, key);
    std::vector<Index> welded(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
        welded[order[i]] = same ? welded[order[i - 1]] : order[i];
    }
    return welded;
}

/// Sets of corners that share a normal (union–find with path halving).
class CornerGroups {
public:
    explicit CornerGroups(std::size_t corners) : parent_(corners) {
        std::iota(parent_.begin(), parent_.end(), Index{0});
    }
    Index find(Index corner) {
        while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
        return corner;
    }
    void join(Index a, Index b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<Index> parent_;
};

/// The triangle's side that leaves `corner`, named by its welded ends, lower first.
struct Side {
    Index low, high;
    Index corner;
    bool isForward;  // from low to high
};

class Smoother {
public:
    explicit Smoother(const Mesh& mesh)
        : mesh_(mesh), welded_(weld(mesh.positions)), groups_(3 * mesh.triangles.size()) {
        faceNormals_.reserve(mesh.triangles.size());
        for (const auto& [a, b, c] : mesh.triangles) {
            const Vec3d n = cross(position(b) - position(a), position(c) - position(a));
            faceNormals_.push_back(lengthSquared(n) > 0 ? normalize(n) : Vec3d{});
        }
    }

    void joinAcrossEdges(double maxAngleDegrees) {
        const std::vector<Side> sides = sortedSides();
        for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
            while (end < sides.size() && sides[end].low == sides[begin].low &&
                   sides[end].high == sides[begin].high)
                ++end;
            if (end - begin != 2 || sides[begin].isForward == sides[begin + 1].isForward) continue;
            const Index a = sides[begin].corner, b = sides[begin + 1].corner;
            const double angle = angleBetween(faceNormals_[a / 3], faceNormals_[b / 3]);
            if (angle * (180.0 / std::numbers::pi) > maxAngleDegrees) continue;
            groups_.join(a, nextCorner(b));
            groups_.join(nextCorner(a), b);
        }
    }

    /// The mesh with one vertex for each of its vertices and each group of corners there.
    Mesh rebuild() {
        const std::vector<Vec3d> sums = sumNormals();
        std::vector<Index> order(sums.size());
        std::iota(order.begin(), order.end(), Index{0});
        const auto key = [&](Index corner) {
            return std::pair(vertexOf(corner), groups_.find(corner));
        };
        std::ranges::sort(order, {}, key);

        Mesh result = mesh_;
        result.positions.clear();
        result.normals.clear();
        result.textureCoordinates.clear();
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Index corner = order[i];
            if (i == 0 || key(corner) != key(order[i - 1])) addVertex(result, corner, sums);
            result.triangles[corner / 3][corner % 3] =
                static_cast<Index>(result.positions.size() - 1);
        }
        return result;
    }

private:
    Vec3d position(Index vertex) const { return toDouble(mesh_.positions[vertex]); }
    Index vertexOf(Index corner) const { return mesh_.triangles[corner / 3][corner % 3]; }

    std::vector<Side> sortedSides() const {
        std::vector<Side> sides;
        sides.reserve(3 * mesh_.triangles.size());
        for (Index corner = 0; corner < 3 * mesh_.triangles.size(); ++corner) {
            if (faceNormals_[corner / 3] == Vec3d{}) continue;
            const Index from = welded_[vertexOf(corner)];
            const Index to = welded_[vertexOf(nextCorner(corner))];
            sides.push_back({std::min(from, to), std::max(from, to), corner, from < to});
        }
        std::ranges::sort(sides, {},
                          [](const Side& s) { return std::tuple(s.low, s.high, s.corner); });
        return sides;
    }

    /// Per group, at its representative: the normals of its triangles, weighted by their angles.
    std::vector<Vec3d> sumNormals() {
        std::vector<Vec3d> sums(3 * mesh_.triangles.size());
        for (Index corner = 0; corner < sums.size(); ++corner) {
            const Vec3d p = position(vertexOf(corner));
            const double angle = angleBetween(position(vertexOf(nextCorner(corner))) - p,
                                              position(vertexOf(previousCorner(corner))) - p);
            sums[groups_.find(corner)] += faceNormals_[corner / 3] * angle;
        }
        return sums;
    }

    void addVertex(Mesh& result, Index corner, const std::vector<Vec3d>& sums) {
        const Index vertex = vertexOf(corner);
        result.positions.push_back(mesh_.positions[vertex]);
        if (!mesh_.textureCoordinates.empty())
            result.textureCoordinates.push_back(mesh_.textureCoordinates[vertex]);
        // The normals of a group may cancel, on two leaves of paper glued back to back; then the
        // triangle's own normal does, where it has one.
        Vec3d normal = sums[groups_.find(corner)];
        if (length(normal) < 1e-9) normal = faceNormals_[corner / 3];
        if (normal == Vec3d{}) normal = {0, 0, 1};
        result.normals.push_back(toFloat(normalize(normal)));
    }

    const Mesh& mesh_;
    std::vector<Index> welded_;
    std::vector<Vec3d> faceNormals_;  // unit; zero for a triangle without area
    CornerGroups groups_;
};

}  // namespace

void makeFlat(Mesh& mesh) { mesh.normals.clear(); }

void makeSmooth(Mesh& mesh, float maxAngleDegrees) {
    Smoother smoother(mesh);
    smoother.joinAcrossEdges(maxAngleDegrees);
    mesh = smoother.rebuild();
}

}  // namespace etendue
