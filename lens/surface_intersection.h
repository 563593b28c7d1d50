// Where a line crosses a lens surface.
#pragma once

#include <concepts>
#include <optional>

#include "lens/surface_shape.h"

namespace etendue {

/// Which way light travels through the lens. Fields beyond 90° are why this is not the sign of z.
enum class Heading { toScene, toSensor };

namespace detail {

struct Line {
    Vector3<double> origin, direction;
    Vector3<double> at(double t) const { return origin + direction * t; }
};

inline double signOf(Heading heading) { return heading == Heading::toScene ? 1.0 : -1.0; }

/// The level set along the line is g + b t − ½ a t². At the crossing its slope is ±√(b² + 2 a g),
/// with the sign of the heading.
inline std::optional<double> intersectQuadric(const SurfaceShape& shape, const Line& line,
                                              double sign) {
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

std::optional<double> intersectAsphere(const SurfaceShape& shape, double semiApertureMm,
                                       const Line& line, double sign);

}  // namespace detail

/// The parameter t at which origin + t direction (relative to the vertex) passes from one side of
/// the surface to the other in the given heading, on the sheet that holds the vertex; it may be
/// negative. Empty when the line does not cross that way.
///
/// A conic's sheet is crossed at most once in each heading, so the heading alone chooses between
/// the two intersections of the line. An asphere's crossing is found by Newton's method from its
/// conic's; if that ends outside the clear aperture, a crossing inside is sought by bisection, for
/// beyond its rim an asphere is no more than a polynomial.
inline std::optional<double> intersect(const SurfaceShape& shape, double semiApertureMm,
                                       const Vector3<double>& origin,
                                       const Vector3<double>& direction, Heading heading) {
    const detail::Line line{origin, direction};
    const double sign = detail::signOf(heading);
    return shape.isAsphere ? detail::intersectAsphere(shape, semiApertureMm, line, sign)
                           : detail::intersectQuadric(shape, line, sign);
}

/// The point at the parameter t that intersect() found.
inline Vector3<double> pointOnSurface(const SurfaceShape& /*shape*/, const LensRay<double>& ray,
                                      double t) {
    return ray.origin + ray.direction * t;
}

/// With its derivatives: one step of Newton's method from where a constant t would lead is the
/// implicit function theorem.
template <int N>
Vector3<Dual<N>> pointOnSurface(const SurfaceShape& shape, const LensRay<Dual<N>>& ray, double t) {
    const Vector3<double> d = valueOf(ray.direction), held = valueOf(ray.origin) + d * t;
    const Vector3<double> normal = gradient(shape, held);
    const double perSlope = 1.0 / dot(normal, d);
    const double step = levelSet(shape, held) * perSlope;
    Vector3<Dual<N>> point{held.x - d.x * step, held.y - d.y * step, held.z - d.z * step};
    for (std::size_t i = 0; i < N; ++i) {
        const Vector3<double> by = partialsOf(ray.origin, i) + partialsOf(ray.direction, i) * t;
        setPartials(point, i, by - d * (dot(normal, by) * perSlope));
    }
    return point;
}

}  // namespace etendue
