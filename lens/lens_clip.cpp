#include "lens/lens_clip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lens/parallel.h"
#include "lens/polynomial.h"
#include "lens/sparse_fit.h"

namespace etendue {

namespace {

using Eigen::Index;

constexpr std::uint64_t selectionSeed = 11, trainingSeed = 12;

/// What must be at most 1 for a ray to pass: on each surface its squared height in units of the
/// squared semi-aperture, then on each the squared sine of refraction. Rims are ignored on the way;
/// what the ray does not come to is infinite.
struct RimRay {
    FitQuery query;
    bool passes = false;  // all of them, exactly
    std::vector<double> squares;
};

double squaredSineOfRefraction(const MonochromaticSystem& lens, std::size_t index,
                               const Vector3<double>& point, const Vector3<double>& direction) {
    const TracedSurface& surface = lens.system.surfaces[index];
    const Vector3<double> local{point.x, point.y, point.z - surface.vertexZMm};
    const double along = dot(direction, normalized(gradient(surface.shape, local)));
    const double ratio = lens.indices[index + 1] / lens.indices[index];
    return ratio * ratio * (1.0 - along * along);
}

RimRay traceRims(const TracedLens& lens, const FitQuery& query) {
    const OpticalSystem& system = lens.system();
    const std::size_t count = system.surfaces.size();
    RimRay result{query, false,
                  std::vector<double>(2 * count, std::numeric_limits<double>::infinity())};
    const std::optional<MonochromaticLens> at = lens.at(query.wavelengthNm);
    const auto slope = at ? at->slopeThrough(query.sensor, query.aperture) : std::nullopt;
    if (!slope) return result;
    const MonochromaticSystem view = at->system();
    const SensorState start{query.sensor.mm.x(), query.sensor.mm.y(), slope->x(), slope->y()};
    LensRay<double> ray = rayOf(start, lens.sensorZMm());
    result.passes = true;
    Passage passage;
    for (std::size_t index = count; index-- > 0;) {
        const Vector3<double> before = ray.direction;
        const bool crosses =
            crossSurface<Heading::toScene, TraceMode::geometry>(view, index, ray, passage);
        if (!crosses) result.passes = false;
        if (passage.status == TraceStatus::missedSurface) break;
        const Vector3<double>& point = ray.origin;
        const double rim = system.surfaces[index].semiApertureMm;
        result.squares[index] = (point.x * point.x + point.y * point.y) / (rim * rim);
        result.squares[count + index] = squaredSineOfRefraction(view, index, point, before);
        if (index != system.stop && result.squares[index] > 1.0) result.passes = false;
        if (!crosses) break;
    }
    return result;
}

std::vector<RimRay> drawRimRays(const TracedLens& lens, const FitDomain& domain, std::size_t count,
                                std::uint64_t seed) {
    constexpr std::size_t chunk = 64;
    std::vector<RimRay> rays(count);
    parallelFor((count + chunk - 1) / chunk, [&](std::size_t part) {
        for (std::size_t i = part * chunk; i < std::min(count, (part + 1) * chunk); ++i)
            rays[i] = traceRims(lens, drawQuery(domain, seed, i));
    });
    return rays;
}

/// Indices into RimRay::squares, ascending.
using Bounds = std::vector<std::size_t>;

bool exceeds(const RimRay& ray, std::size_t bound) {
    return ray.squares[bound] > 1.0 && std::isfinite(ray.squares[bound]);
}

/// Where a ray does not come to, a polynomial fitted to those that do may say anything.
bool mayPass(const RimRay& ray, const Bounds& bounds) {
    return std::ranges::none_of(bounds, [&](std::size_t i) { return exceeds(ray, i); });
}

Bounds clippingBounds(const TracedLens& lens, const std::vector<RimRay>& rays) {
    const std::size_t count = lens.system().surfaces.size(), stop = lens.system().stop;
    Bounds chosen;
    for (const std::size_t always : {std::size_t{0}, count - 1})
        if (always != stop && std::ranges::find(chosen, always) == chosen.end())
            chosen.push_back(always);
    while (chosen.size() < mostOutputs) {
        std::vector<std::size_t> ends(2 * count, 0);
        std::size_t accepted = 0, wrongly = 0;
        for (const RimRay& ray : rays) {
            if (!mayPass(ray, chosen)) continue;
            ++accepted;
            if (ray.passes) continue;
            ++wrongly;
            for (std::size_t i = 0; i < ends.size(); ++i)
                if (i != stop && exceeds(ray, i)) ++ends[i];
        }
        if (wrongly * 2000 <= accepted) break;
        const auto most = std::ranges::max_element(ends);
        if (*most == 0) break;
        chosen.push_back(static_cast<std::size_t>(most - ends.begin()));
    }
    std::ranges::sort(chosen);
    return chosen;
}

}  // namespace

ClipFit fitClip(const TracedLens& lens, const FitDomain& domain, PolynomialBasis basis,
                const ClipSettings& settings) {
    // Rays far beyond a rim need no accurate height, only to be known to be beyond.
    constexpr double highest = 1.7;
    ClipFit clip;
    std::vector<RimRay> rays = drawRimRays(lens, domain, 20'000, selectionSeed);
    const Bounds bounds = clippingBounds(lens, rays);
    const std::size_t surfaces = lens.system().surfaces.size();
    for (const std::size_t i : bounds)
        (i < surfaces ? clip.surfaces : clip.reflecting).push_back(i % surfaces);
    std::vector<RimRay> training;
    for (std::uint64_t round = 0; training.size() < settings.rays && round < 20; ++round) {
        for (RimRay& ray : rays)
            if (training.size() < settings.rays && std::ranges::all_of(bounds, [&](std::size_t i) {
                    return ray.squares[i] <= highest;
                }))
                training.push_back(std::move(ray));
        if (training.size() < settings.rays)
            rays = drawRimRays(lens, domain, 20'000, trainingSeed + round);
    }
    const Index count = static_cast<Index>(bounds.size());
    Eigen::MatrixXd targets(static_cast<Index>(training.size()), count);
    std::vector<PolynomialInput> inputs;
    for (std::size_t i = 0; i < training.size(); ++i) {
        const FitQuery& query = training[i].query;
        inputs.push_back({query.sensor.mm, query.aperture.mm, query.wavelengthNm});
        for (Index c = 0; c < count; ++c)
            targets(static_cast<Index>(i), c) =
                training[i].squares[bounds[static_cast<std::size_t>(c)]];
    }
    const OutputCount outputs{0, static_cast<int>(count)};
    clip.squares = fitSparse(basis, outputs, candidateTerms(basis, settings.degree, outputs),
                             scalingFor(basis, inputs, Coupling::none), inputs, targets,
                             Eigen::VectorXd::Ones(count), {settings.terms, 1});
    return clip;
}

ClipErrors measureClip(const ClipFit& clip, const TracedLens& lens, const FitDomain& domain,
                       std::size_t rays, std::uint64_t seed) {
    const PolynomialEvaluator<double> evaluator(clip.squares);
    std::size_t accepted = 0, passed = 0, wronglyAccepted = 0, wronglyBlocked = 0;
    for (const RimRay& ray : drawRimRays(lens, domain, rays, seed)) {
        const PolynomialValues<double> squares =
            evaluator.values({ray.query.sensor.mm, ray.query.aperture.mm, ray.query.wavelengthNm});
        const bool fitted = passesRims({squares.data(), clip.count()});
        accepted += fitted;
        passed += ray.passes;
        wronglyAccepted += fitted && !ray.passes;
        wronglyBlocked += ray.passes && !fitted;
    }
    const auto share = [](std::size_t part, std::size_t whole) {
        return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
    };
    return {share(wronglyAccepted, accepted), share(wronglyBlocked, passed)};
}

}  // namespace etendue
