#include "lens/fit_rays.h"

#include "lens/disc_sampling.h"
#include "lens/parallel.h"

namespace etendue {

namespace {

/// SplitMix64 (Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators").
std::uint64_t mixed(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
}

/// In [0, 1).
double uniform(std::uint64_t seed, std::uint64_t index, std::uint64_t dimension) {
    const std::uint64_t bits = mixed(mixed(mixed(seed) + index) + dimension);
    return static_cast<double>(bits >> 11) * 0x1p-53;
}

enum class Fate { passed, blocked, folded, unsolved, besidePupil };

struct Traced {
    Fate fate = Fate::blocked;
    FitRay ray;
};

Traced traceQuery(const TracedLens& lens, const PupilSphere& sphere, const FitQuery& query) {
    Traced result;
    result.ray.query = query;
    const std::optional<MonochromaticLens> at = lens.at(query.wavelengthNm);
    const std::optional<Eigen::Vector2d> slope =
        at ? at->slopeThrough(query.sensor, query.aperture) : std::nullopt;
    if (!slope) {
        result.fate = Fate::unsolved;
        return result;
    }
    const TracedRay traced =
        at->traceToScene({query.sensor.mm.x(), query.sensor.mm.y(), slope->x(), slope->y()});
    if (traced.passage.status != TraceStatus::passed) return result;
    result.fate = Fate::folded;
    FitRay& ray = result.ray;
    ray.slope = *slope;
    ray.apertureSlope = {traced.aperture.slopeX, traced.aperture.slopeY};
    ray.direction = toEigen(traced.ray.direction);
    ray.transmittance = traced.passage.transmittance;
    const std::optional<ExitRay> exit = at->trace(query.sensor, query.aperture);
    const std::optional<PupilState<double>> pupil = sphere.state(traced.ray);
    if (!exit) return result;
    result.fate = Fate::besidePupil;
    if (!pupil) return result;
    ray.pupil = *pupil;
    ray.directionBySensor = exit->directionBySensor;
    ray.throughput = exit->throughput;
    result.fate = Fate::passed;
    return result;
}

}  // namespace

TracedLens lensOf(const Prescription& prescription, const FitDomain& domain) {
    return TracedLens(prescription, Aperture(domain.apertureRadiusMm), domain.sensorDistanceMm);
}

FitQuery drawQuery(const FitDomain& domain, std::uint64_t seed, std::uint64_t index) {
    FitQuery query;
    std::uint64_t dimension = 0;
    const auto next = [&] { return uniform(seed, index, dimension++); };
    // The picture may be a speck on a huge sensor, which draws from all of it would hardly ever
    // hit. Any rectangle that holds the part of the sensor within the picture would do.
    const Eigen::Vector2d half = domain.sensorHalfSizeMm.cwiseMin(2.0 * domain.imageRadiusMm);
    do {
        const double x = 2.0 * next() - 1.0, y = 2.0 * next() - 1.0;
        query.sensor.mm = half.cwiseProduct(Eigen::Vector2d(x, y));
    } while (query.sensor.mm.norm() > domain.imageRadiusMm);
    const double u = next(), v = next();
    query.aperture.mm = domain.apertureRadiusMm * sampleUnitDisc({u, v});
    query.wavelengthNm = domain.shortestWavelengthNm +
                         next() * (domain.longestWavelengthNm - domain.shortestWavelengthNm);
    return query;
}

FitRays drawFitRays(const TracedLens& lens, const FitDomain& domain, std::size_t count,
                    std::uint64_t seed) {
    constexpr std::size_t chunk = 64, chunksAtOnce = 16;
    const PupilSphere sphere(lens.system());
    FitRays result;
    result.rays.reserve(count);
    double light = 0.0, folded = 0.0;
    std::vector<Traced> traced(chunk * chunksAtOnce);
    while (result.rays.size() < count &&
           static_cast<std::size_t>(result.counts.drawn) < 1000 * count) {
        const std::uint64_t first = static_cast<std::uint64_t>(result.counts.drawn);
        parallelFor(chunksAtOnce, [&](std::size_t part) {
            for (std::size_t i = part * chunk; i < (part + 1) * chunk; ++i)
                traced[i] = traceQuery(lens, sphere, drawQuery(domain, seed, first + i));
        });
        for (const Traced& one : traced) {
            if (result.rays.size() == count) break;
            ++result.counts.drawn;
            light += one.ray.transmittance;
            switch (one.fate) {
                case Fate::passed:
                    ++result.counts.passed;
                    result.rays.push_back(one.ray);
                    break;
                case Fate::blocked:
                    ++result.counts.blocked;
                    break;
                case Fate::folded:
                    ++result.counts.folded;
                    folded += one.ray.transmittance;
                    break;
                case Fate::unsolved:
                    ++result.counts.unsolved;
                    break;
                case Fate::besidePupil:
                    ++result.counts.besidePupil;
                    break;
            }
        }
    }
    if (light > 0.0) result.counts.foldedLight = folded / light;
    return result;
}

}  // namespace etendue
