// Where a line crosses a lens surface.
#pragma once

#include <concepts>
#include <optional>

#include "lens/surface_shape.h"

namespace etendue {

/// Which way light travels through the lens. Fields beyond 90° are why this is not the sign of z.
enum class Heading { toScene, toSensor };

/// The parameter t at which origin + t direction (relative to the vertex) passes from one side of
/// the surface to the other in the given heading, on the sheet that holds the vertex; it may be
/// negative. Empty when the line does not cross that way.
///
/// A conic's sheet is crossed at most once in each heading, so the heading alone chooses between
/// the two intersections of the line. An asphere's crossing is found by Newton's method from its
/// conic's; if that ends outside the clear aperture, a crossing inside is sought by bisection, for
/// beyond its rim an asphere is no more than a polynomial.
std::optional<double> intersect(const SurfaceShape& shape, double semiApertureMm,
                                const Vector3<double>& origin, const Vector3<double>& direction,
                                Heading heading);

/// The point at the parameter t that intersect() found, with its derivatives: one step of Newton's
/// method from where a constant t would lead is the implicit function theorem.
template <class T>
Vector3<T> pointOnSurface(const SurfaceShape& shape, const LensRay<T>& ray, double t) {
    const Vector3<T> point = ray.origin + ray.direction * t;
    if constexpr (std::same_as<T, double>) return point;
    const T slope = dot(gradient(shape, point), ray.direction);
    return point - ray.direction * (levelSet(shape, point) / slope);
}

}  // namespace etendue
