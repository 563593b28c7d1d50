#include "renderer/triangulate.h"

#include <utility>

namespace etendue {
namespace {

using Index = std::uint32_t;
using Point = Vec2T<double>;

/// Twice the signed area of a triangle. Differences of floats and their products mostly fit a
/// double without rounding.
double doubleArea(Point a, Point b, Point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The polygon without its coordinate along the axis nearest to its normal, counter-clockwise.
std::vector<Point> flatten(std::span<const Vec3> polygon) {
    const Vec3d normal = polygonNormal(polygon);
    const Vec3d size = abs(normal);
    const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    std::vector<Point> points;
    points.reserve(polygon.size());
    for (const Vec3& p : polygon) points.push_back({p[u], p[v]});
    return points;
}

/// A ring of corners that loses one ear after another. What a clipped ear changes is whether its
/// two neighbours are ears, and nothing else, so that n corners of which r are reflex take O(n r).
class EarClipper {
public:
    explicit EarClipper(std::span<const Vec3> polygon)
        : points_(flatten(polygon)), count_(static_cast<Index>(polygon.size())) {
        for (Index i = 0; i < count_; ++i)
            ring_.push_back({(i + count_ - 1) % count_, (i + 1) % count_, false, false});
        for (Index i = 0; i < count_; ++i) {
            ring_[i].isConvex = area(i) > 0;
            if (!ring_[i].isConvex) reflex_.push_back(i);
        }
        for (Index i = 0; i < count_; ++i) ring_[i].isEar = isEar(i);
    }

    void clip(Index first, std::vector<std::array<Index, 3>>& triangles) {
        Index at = first;
        for (; count_ > 3; --count_) {
            for (Index tries = 0; !ring_[at].isEar && tries < count_; ++tries) at = ring_[at].next;
            if (!ring_[at].isEar) at = leastHarmful(at);
            const auto [before, after] = neighbours(at);
            triangles.push_back({before, at, after});
            remove(at);
            at = ring_[after].next;  // alternate ears give rounder triangles than one long fan
        }
        triangles.push_back({ring_[at].previous, at, ring_[at].next});
    }

private:
    struct Corner {
        Index previous, next;
        bool isConvex, isEar;
    };

    std::array<Index, 2> neighbours(Index i) const { return {ring_[i].previous, ring_[i].next}; }

    double area(Index i) const {
        return doubleArea(points_[ring_[i].previous], points_[i], points_[ring_[i].next]);
    }

    /// No other corner is in its triangle or on its rim. Corners at the same place as one of the
    /// triangle's are the other side of a cut and do not count.
    bool isEar(Index i) const {
        if (!ring_[i].isConvex) return false;
        const Point a = points_[ring_[i].previous], b = points_[i], c = points_[ring_[i].next];
        for (const Index other : reflex_) {
            const Point p = points_[other];
            if (ring_[other].isConvex || p == a || p == b || p == c) continue;
            if (doubleArea(a, b, p) >= 0 && doubleArea(b, c, p) >= 0 && doubleArea(c, a, p) >= 0)
                return false;
        }
        return true;
    }

    /// Only a polygon that crosses or touches itself has no ear.
    Index leastHarmful(Index at) const {
        Index convex = at;
        for (Index i = 0; i < count_; ++i, at = ring_[at].next) {
            if (area(at) == 0) return at;
            if (ring_[at].isConvex) convex = at;
        }
        return convex;
    }

    void remove(Index i) {
        const auto [before, after] = neighbours(i);
        ring_[before].next = after;
        ring_[after].previous = before;
        // No corner of the ring may see the one that left.
        ring_[i].isConvex = true;
        for (const Index neighbour : {before, after}) {
            const bool isConvex = area(neighbour) > 0;
            if (ring_[neighbour].isConvex && !isConvex) reflex_.push_back(neighbour);
            ring_[neighbour].isConvex = isConvex;
        }
        for (const Index neighbour : {before, after}) ring_[neighbour].isEar = isEar(neighbour);
    }

    std::vector<Point> points_;
    std::vector<Corner> ring_;
    std::vector<Index> reflex_;  // includes some that have become convex
    Index count_;
};

}  // namespace

void triangulate(std::span<const Vec3> polygon, std::vector<std::array<Index, 3>>& triangles) {
    if (polygon.size() == 3) {
        triangles.push_back({0, 1, 2});
        return;
    }
    const bool startsAtFirst = polygon.size() == 4 && lengthSquared(polygon[2] - polygon[0]) >
                                                          lengthSquared(polygon[3] - polygon[1]);
    EarClipper(polygon).clip(startsAtFirst ? 0 : 1, triangles);
}

Vec3d polygonNormal(std::span<const Vec3> polygon) {
    Vec3d sum;
    for (std::size_t i = 0; i + 2 < polygon.size(); ++i) {
        const Vec3d origin = toDouble(polygon[0]);
        sum += cross(toDouble(polygon[i + 1]) - origin, toDouble(polygon[i + 2]) - origin);
    }
    return sum;
}

}  // namespace etendue
