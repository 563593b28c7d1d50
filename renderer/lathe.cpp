// makeLathe: profile → curves between corners → smooth strips → bands of triangles.
#include "renderer/shape_builder.h"
#include "renderer/shapes.h"

namespace etendue {
namespace {

// Of the profile: x is the radius, y the height.
using Curve = std::vector<Vec2d>;

double norm(Vec2d a) { return std::hypot(a.x, a.y); }

[[noreturn]] void reject(std::size_t index, const std::string& what) {
    throw std::invalid_argument("lathe: profile[" + std::to_string(index) + "] " + what);
}

void requireProfile(std::span<const Vec2> profile, int segments, int subdivisions,
                    float creaseDegrees) {
    requireCount("lathe", "segments", segments, 3);
    requireCount("lathe", "subdivisions", subdivisions, 1);
    if (!(creaseDegrees >= 0 && creaseDegrees <= 179))
        throw std::invalid_argument("lathe: crease angle is " + std::to_string(creaseDegrees) +
                                    " degrees, must be from 0 to 179");
    if (profile.size() < 2)
        throw std::invalid_argument("lathe: the profile needs at least two points");
    // More than that is caught below; the conversion needs it here.
    const int points = static_cast<int>(std::min<std::size_t>(profile.size(), 1u << 18));
    requireCount("lathe", "the number of points times subdivisions", points * subdivisions, 2);
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const Vec2 p = profile[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) reject(i, "is not finite");
        if (p.x < 0) reject(i, "has the radius " + std::to_string(p.x) + ", must not be negative");
        if (i > 0 && p.x == 0 && profile[i - 1].x == 0 && p != profile[i - 1])
            reject(i, "follows another one on the axis, where there is no surface between them");
    }
}

/// The profile cut at points that are given twice.
std::vector<Curve> splitAtCorners(std::span<const Vec2> profile) {
    std::vector<Curve> curves(1);
    for (std::size_t i = 0; i < profile.size(); ++i) {
        if (i > 0 && profile[i] == profile[i - 1]) curves.emplace_back();
        curves.back().push_back({profile[i].x, profile[i].y});
    }
    std::erase_if(curves, [](const Curve& curve) { return curve.size() < 2; });
    if (curves.empty())
        throw std::invalid_argument("lathe: the profile needs at least two different points");
    return curves;
}

/// A point beyond the curve's `end`, by which the curve's direction there is told: its reflection
/// in the axis goes on from the axis, and elsewhere a straight line.
Vec2d reflected(Vec2d neighbour) { return {-neighbour.x, neighbour.y}; }
Vec2d straightOn(Vec2d end, Vec2d neighbour) { return end * 2.0 - neighbour; }
Vec2d beyond(Vec2d end, Vec2d neighbour) {
    return end.x == 0 ? reflected(neighbour) : straightOn(end, neighbour);
}

/// The centripetal Catmull–Rom curve through p[0] … p[3] at `fraction` of the way from p[1] to
/// p[2], by Barry and Goldman's pyramid.
Vec2d catmullRom(const std::array<Vec2d, 4>& p, double fraction) {
    std::array<double, 4> knot{};
    for (std::size_t i = 1; i < 4; ++i) knot[i] = knot[i - 1] + std::sqrt(norm(p[i] - p[i - 1]));
    const double t = knot[1] + fraction * (knot[2] - knot[1]);
    std::array<Vec2d, 4> level = p;
    for (std::size_t width = 1; width < 4; ++width) {
        // The last level spans p[1] to p[2] only.
        for (std::size_t i = 0; i + width < 4; ++i) {
            const std::size_t low = width == 3 ? 1 : i, high = width == 3 ? 2 : i + width;
            const double x = (t - knot[low]) / (knot[high] - knot[low]);
            level[i] = level[i] * (1 - x) + level[i + 1] * x;
        }
    }
    return level[0];
}

Curve subdivide(const Curve& points, int pieces) {
    if (pieces == 1) return points;
    Curve padded = points;
    padded.insert(padded.begin(), beyond(points[0], points[1]));
    padded.push_back(beyond(points.back(), points[points.size() - 2]));
    Curve result;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        result.push_back(points[i]);
        for (int k = 1; k < pieces; ++k) {
            const Vec2d p = catmullRom({padded[i], padded[i + 1], padded[i + 2], padded[i + 3]},
                                       static_cast<double>(k) / pieces);
            if (!(p.x > 0))
                reject(i,
                       "and the next one have a curve between them that crosses the axis; "
                       "another point between them will keep it away");
            result.push_back(p);
        }
    }
    result.push_back(points.back());
    return result;
}

/// How far the polyline a, b, c turns at b.
double turnDegrees(Vec2d a, Vec2d b, Vec2d c) {
    const Vec2d u = b - a, v = c - b;
    return std::atan2(std::abs(u.x * v.y - u.y * v.x), u.x * v.x + u.y * v.y) * 180.0 /
           std::numbers::pi;
}

std::vector<Curve> splitAtCreases(const Curve& points, double creaseDegrees) {
    std::vector<Curve> strips(1);
    for (std::size_t i = 0; i < points.size(); ++i) {
        strips.back().push_back(points[i]);
        if (i == 0 || i + 1 == points.size()) continue;
        if (turnDegrees(points[i - 1], points[i], points[i + 1]) > creaseDegrees)
            strips.push_back({points[i]});
    }
    return strips;
}

/// The unit normal at b of the parabola through a, b, c over their distances: exact on a circle.
Vec2d normalAt(Vec2d a, Vec2d b, Vec2d c) {
    const double before = norm(b - a), after = norm(c - b);
    const Vec2d tangent = (b - a) * (after / before) + (c - b) * (before / after);
    return Vec2d{tangent.y, -tangent.x} * (1.0 / norm(tangent));
}

/// One normal per point of a smooth strip. A strip ends straight, but on the axis it goes on at the
/// other side, unless that makes a tip.
std::vector<Vec2d> normalsOf(const Curve& strip, double creaseDegrees) {
    const auto outer = [&](Vec2d end, Vec2d neighbour) {
        const bool isTip = turnDegrees(reflected(neighbour), end, neighbour) > creaseDegrees;
        return isTip ? straightOn(end, neighbour) : beyond(end, neighbour);
    };
    std::vector<Vec2d> normals;
    for (std::size_t i = 0; i < strip.size(); ++i) {
        const Vec2d before = i > 0 ? strip[i - 1] : outer(strip[0], strip[1]);
        const Vec2d after = i + 1 < strip.size() ? strip[i + 1] : outer(strip[i], strip[i - 1]);
        normals.push_back(normalAt(before, strip[i], after));
    }
    return normals;
}

VertexRow addRow(ShapeBuilder& builder, Vec2d point, Vec2d normal, double v, int segments) {
    const VertexRow row{builder.nextVertex(), point.x == 0};
    const auto add = [&](Vec2d circle, double u) {
        builder.addVertex({{circle.x * point.x, circle.y * point.x, point.y},
                           {circle.x * normal.x, circle.y * normal.x, normal.y},
                           {u, v}});
    };
    // A pole's vertices look along the middle of their triangles.
    for (int i = 0; row.isPole && i < segments; ++i)
        add(circlePoint(2 * i + 1, 2 * segments), (i + 0.5) / segments);
    for (int i = 0; !row.isPole && i <= segments; ++i)
        add(circlePoint(i, segments), static_cast<double>(i) / segments);
    return row;
}

double lengthOf(const Curve& points) {
    double sum = 0;
    for (std::size_t i = 1; i < points.size(); ++i) sum += norm(points[i] - points[i - 1]);
    return sum;
}

}  // namespace

Mesh makeLathe(std::span<const Vec2> profile, int segments, int subdivisions, float creaseDegrees) {
    requireProfile(profile, segments, subdivisions, creaseDegrees);
    std::vector<Curve> strips;
    double totalLength = 0;
    for (const Curve& points : splitAtCorners(profile)) {
        const Curve curve = subdivide(points, subdivisions);
        totalLength += lengthOf(curve);
        for (Curve& strip : splitAtCreases(curve, creaseDegrees))
            strips.push_back(std::move(strip));
    }

    ShapeBuilder builder;
    double lengthSoFar = 0;
    for (const Curve& strip : strips) {
        const std::vector<Vec2d> normals = normalsOf(strip, creaseDegrees);
        VertexRow below{};
        for (std::size_t i = 0; i < strip.size(); ++i) {
            if (i > 0) lengthSoFar += norm(strip[i] - strip[i - 1]);
            const double v = std::min(1.0, lengthSoFar / totalLength);
            const VertexRow row = addRow(builder, strip[i], normals[i], v, segments);
            if (i > 0) builder.addBand(below, row, segments);
            below = row;
        }
    }
    return std::move(builder).smooth();
}

}  // namespace etendue
