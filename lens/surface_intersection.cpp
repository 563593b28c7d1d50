#include "lens/surface_intersection.h"

namespace etendue {

namespace {

using detail::intersectQuadric, detail::Line, detail::signOf;

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

}  // namespace

std::optional<double> detail::intersectAsphere(const SurfaceShape& shape, double semiApertureMm,
                                               const Line& line, double sign) {
    std::optional<double> start = intersectQuadric(shape, line, sign);
    if (!start && line.direction.z * sign > 0.0) start = -line.origin.z / line.direction.z;
    std::optional<double> found;
    if (start) found = polish(shape, line, sign, *start, semiApertureMm);
    if (found && isWithin(line.at(*found), semiApertureMm)) return found;
    const std::optional<double> inside = intersectWithinRim(shape, semiApertureMm, line, sign);
    return inside ? inside : found;
}

}  // namespace etendue
