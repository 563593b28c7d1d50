// Sequential tracing: a ray carried from surface to surface, exactly, over double or Dual, so that
// its derivatives come along. Either way through the lens.
#pragma once

#include <cstdint>
#include <span>

#include "lens/optical_system.h"
#include "lens/surface_intersection.h"

namespace etendue {

enum class TraceStatus : std::uint8_t {
    passed,
    missedSurface,            // the line does not meet the surface
    totalInternalReflection,  // it cannot leave the denser medium
    blockedBySurface,         // beyond the semi-aperture
    blockedByStop             // outside the aperture
};

/// How far a ray came, and what of its light.
struct Passage {
    TraceStatus status = TraceStatus::passed;
    std::size_t surface = 0;     // where it ended, unless it passed
    double transmittance = 1.0;  // of unpolarised light, Fresnel's losses and coatings
};

/// `geometry`: rims, the stop and losses are ignored; `light`: they are not.
enum class TraceMode { geometry, light };

/// The lens at one wavelength: a view of a system and of its indices there.
struct MonochromaticSystem {
    const OpticalSystem& system;
    std::span<const double> indices;  // of system.media
    double wavelengthNm;
};

namespace detail {

template <Heading heading>
Refraction refractionAt(const MonochromaticSystem& lens, std::size_t surface) {
    const double sceneSide = lens.indices[surface], sensorSide = lens.indices[surface + 1];
    if constexpr (heading == Heading::toScene) return {sensorSide, sceneSide, 1.0, 1.0};
    return {sceneSide, sensorSide, 1.0, 1.0};
}

/// How a direction is bent: direction * ratio + normal * along.
struct Bend {
    double ratio, along;
};

/// Snell's law. `normal` is of unit length and points toward the scene. Empty: total reflection.
template <Heading heading>
std::optional<Bend> bendOf(const Vector3<double>& normal, const Vector3<double>& direction,
                           Refraction& refraction) {
    const double ratio = refraction.indexFrom / refraction.indexTo;
    const double along = dot(direction, normal);  // positive toward the scene
    const double radicand = 1.0 - ratio * ratio * (1.0 - along * along);
    if (!(radicand > 0.0)) return {};
    refraction.cosFrom = std::abs(along);
    refraction.cosTo = std::sqrt(radicand);
    const double leaving = heading == Heading::toScene ? refraction.cosTo : -refraction.cosTo;
    return Bend{ratio, leaving - ratio * along};
}

/// False: total reflection.
template <Heading heading>
bool refract(const Vector3<double>& normal, Refraction& refraction, Vector3<double>& direction) {
    const std::optional<Bend> bend = bendOf<heading>(normal, direction, refraction);
    if (!bend) return false;
    direction = direction * bend->ratio + normal * bend->along;
    return true;
}

template <Heading heading, int N>
bool refract(const Vector3<Dual<N>>& normal, Refraction& refraction, Vector3<Dual<N>>& direction) {
    const Vector3<double> n = valueOf(normal), d = valueOf(direction);
    const std::optional<Bend> bend = bendOf<heading>(n, d, refraction);
    if (!bend) return false;
    const auto [ratio, along] = *bend;
    const Vector3<double> bent = d * ratio + n * along;
    // ∂ of what is left of the cosine, by that of the cosine before.
    const double leaving = dot(bent, n),
                 alongByCosine = ratio * (ratio * dot(d, n) / leaving - 1.0);
    for (std::size_t i = 0; i < N; ++i) {
        const Vector3<double> dn = partialsOf(normal, i), dd = partialsOf(direction, i);
        const double alongBy = alongByCosine * (dot(dd, n) + dot(d, dn));
        setPartials(direction, i, dd * ratio + dn * along + n * alongBy);
    }
    direction.x.value = bent.x;
    direction.y.value = bent.y;
    direction.z.value = bent.z;
    return true;
}

inline double transmittanceOf(const MonochromaticSystem& lens, const TracedSurface& surface,
                              const Refraction& refraction) {
    return 1.0 - (surface.coating ? reflectance(refraction, *surface.coating, lens.wavelengthNm)
                                  : reflectance(refraction));
}

/// Which rim, if any, stops light at this point.
inline TraceStatus statusAt(const OpticalSystem& system, std::size_t index, double x, double y) {
    if (index == system.stop)
        return system.aperture.contains({x, y}) ? TraceStatus::passed : TraceStatus::blockedByStop;
    const double rim = system.surfaces[index].semiApertureMm;
    return x * x + y * y <= rim * rim ? TraceStatus::passed : TraceStatus::blockedBySurface;
}

}  // namespace detail

/// Carries `ray`, whose direction has unit length, across surface `index`; at the end its origin
/// lies there. False: it does not pass, and `passage` says why.
template <Heading heading, TraceMode mode, class T>
[[gnu::flatten]] bool crossSurface(const MonochromaticSystem& lens, std::size_t index,
                                   LensRay<T>& ray, Passage& passage) {
    const auto stopped = [&](TraceStatus status) {
        passage.status = status;
        passage.surface = index;
        return false;
    };
    const TracedSurface& surface = lens.system.surfaces[index];
    const LensRay<T> local{{ray.origin.x, ray.origin.y, ray.origin.z - surface.vertexZMm},
                           ray.direction};
    const std::optional<double> t =
        intersect(surface.shape, surface.semiApertureMm, valueOf(local.origin),
                  valueOf(local.direction), heading);
    if (!t) return stopped(TraceStatus::missedSurface);
    const Vector3<T> point = pointOnSurface(surface.shape, local, *t);
    ray.origin = {point.x, point.y, point.z + surface.vertexZMm};
    if constexpr (mode == TraceMode::light) {
        const TraceStatus status =
            detail::statusAt(lens.system, index, valueOf(point.x), valueOf(point.y));
        if (status != TraceStatus::passed) return stopped(status);
    }
    Refraction refraction = detail::refractionAt<heading>(lens, index);
    if (refraction.indexFrom == refraction.indexTo) return true;
    Vector3<T> normal = gradient(surface.shape, point);
    if (!surface.shape.isSphereOrPlane()) normal = normalized(normal);
    if (!detail::refract<heading>(normal, refraction, ray.direction))
        return stopped(TraceStatus::totalInternalReflection);
    if constexpr (mode == TraceMode::light)
        passage.transmittance *= detail::transmittanceOf(lens, surface, refraction);
    return true;
}

/// Across the surfaces end − 1 … begin, in that order, toward the scene. `visit(index, point)` is
/// called at each surface that the ray passes.
template <TraceMode mode, class T, class Visitor>
Passage carryToScene(const MonochromaticSystem& lens, std::size_t begin, std::size_t end,
                     LensRay<T>& ray, Visitor&& visit) {
    Passage passage;
    for (std::size_t index = end; index-- > begin;) {
        if (!crossSurface<Heading::toScene, mode>(lens, index, ray, passage)) break;
        visit(index, ray.origin);
    }
    return passage;
}

/// Across the surfaces begin … end − 1 toward the sensor.
template <TraceMode mode, class T, class Visitor>
Passage carryToSensor(const MonochromaticSystem& lens, std::size_t begin, std::size_t end,
                      LensRay<T>& ray, Visitor&& visit) {
    Passage passage;
    for (std::size_t index = begin; index < end; ++index) {
        if (!crossSurface<Heading::toSensor, mode>(lens, index, ray, passage)) break;
        visit(index, ray.origin);
    }
    return passage;
}

}  // namespace etendue
