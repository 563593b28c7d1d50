#include "lens/surface_intersection.h"

namespace etendue {

namespace {

struct Line {
    Vector3<double> origin, direction;
    Vector3<double> at(double t) const { return origin + direction * t; }
};

double signOf(Heading heading) { return heading == Heading::toScene ? 1.0 : -1.0; }

/// The level set along the line is g + b t − ½ a t². At the crossing its slope is ±√(b² + 2 a g),
/// with the sign of the heading.
std::optional<double> intersectQuadric(const SurfaceShape& shape, const Line& line, double sign) {
    const auto& [o, d] = line;
    const double c = shape.curvature, cz = c * (1.0 + shape.conic);
    const double cx = shape.curvedInX ? c : 0.0, cy = shape.curvedInY ? c : 0.0;
    const double a = cx * d.x * d.x + cy * d.y * d.y + cz * d.z * d.z;
    const double b = d.z - (cx * o.x * d.x + cy * o.y * d.y + cz * o.z * d.z);
    const double g = o.z - 0.5 * (cx * o.x * o.x + cy * o.y * o.y + cz * o.z * o.z);
    const double radicand = b * b + 2.0 * a * g;
    if (!(radicand > 0.0)) return {};
    const double slope = sign * std::sqrt(radicand);
    // Of the two forms of the root, the one that does not cancel.
    if (b * sign <= 0.0 && a == 0.0) return {};
    const double t = b * sign > 0.0 ? -2.0 * g / (b + slope) : (b - slope) / a;
    // Beyond the rim of the sheet (the equator of a sphere) the normal's z has changed its sign.
    if (!(1.0 - cz * (o.z + t * d.z) > 0.0)) return {};
    return t;
}

bool isWithin(const Vector3<double>& p, double radius) {
    return p.x * p.x + p.y * p.y <= radius * radius;
}

/// Newton's method on an asphere from `t`; empty when it leaves the conic's domain, turns against
/// the heading or does not converge.
std::optional<double> polish(const SurfaceShape& shape, const Line& line, double sign, double t,
                             double scale) {
    constexpr int mostSteps = 30;
    for (int i = 0; i < mostSteps; ++i) {
        const Vector3<double> p = line.at(t);
        const double slope = dot(gradient(shape, p), line.direction);
        if (!(slope * sign > 0.0)) return {};  // also when not a number
        const double step = levelSet(shape, p) / slope;
        t -= step;
        // The next step would be smaller than the square of this one.
        if (std::abs(step) <= 1e-9 * scale) return t - levelSet(shape, line.at(t)) / slope;
    }
    return {};
}

/// A crossing inside the cylinder of the clear aperture: it exists if the line enters it on the
/// near side of the surface and leaves it on the far side.
std::optional<double> intersectWithinRim(const SurfaceShape& shape, double radius, const Line& line,
                                         double sign) {
    const auto& [o, d] = line;
    const double a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y;
    const double radicand = b * b - a * (o.x * o.x + o.y * o.y - radius * radius);
    constexpr double parallel = 1e-20;  // then Newton's method has no difficulty
    if (!(radicand > 0.0 && a > parallel)) return {};
    double near = (-b - std::sqrt(radicand)) / a, far = (-b + std::sqrt(radicand)) / a;
    const auto level = [&](double t) { return sign * levelSet(shape, line.at(t)); };
    if (!(level(near) < 0.0 && level(far) > 0.0)) return {};
    constexpr int halvings = 40;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (near + far);
        (level(middle) < 0.0 ? near : far) = middle;
    }
    return polish(shape, line, sign, 0.5 * (near + far), radius);
}

std::optional<double> intersectAsphere(const SurfaceShape& shape, double semiApertureMm,
                                       const Line& line, double sign) {
    std::optional<double> start = intersectQuadric(shape, line, sign);
    if (!start && line.direction.z * sign > 0.0) start = -line.origin.z / line.direction.z;
    std::optional<double> found;
    if (start) found = polish(shape, line, sign, *start, semiApertureMm);
    if (found && isWithin(line.at(*found), semiApertureMm)) return found;
    const std::optional<double> inside = intersectWithinRim(shape, semiApertureMm, line, sign);
    return inside ? inside : found;
}

}  // namespace

std::optional<double> intersect(const SurfaceShape& shape, double semiApertureMm,
                                const Vector3<double>& origin, const Vector3<double>& direction,
                                Heading heading) {
    const Line line{origin, direction};
    if (shape.isAsphere) return intersectAsphere(shape, semiApertureMm, line, signOf(heading));
    return intersectQuadric(shape, line, signOf(heading));
}

}  // namespace etendue
