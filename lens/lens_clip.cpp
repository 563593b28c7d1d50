#include "lens/lens_clip.h"

#include <algorithm>
#include <limits>

#include "lens/parallel.h"
#include "lens/polynomial.h"
#include "lens/sparse_fit.h"

namespace etendue {

namespace {

using Eigen::Index;

constexpr std::uint64_t selectionSeed = 11, trainingSeed = 12;

/// How far a ray is from the axis on each surface, rims ignored.
struct RimRay {
    FitQuery query;
    bool passes = false;                 // rims and stop, exactly
    std::vector<double> squaredHeights;  // in units of the semi-apertures; infinite if not reached
};

RimRay traceRims(const TracedLens& lens, const FitQuery& query) {
    const OpticalSystem& system = lens.system();
    const std::size_t count = system.surfaces.size();
    RimRay result{query, false,
                  std::vector<double>(count, std::numeric_limits<double>::infinity())};
    const std::optional<MonochromaticLens> at = lens.at(query.wavelengthNm);
    const auto slope = at ? at->slopeThrough(query.sensor, query.aperture) : std::nullopt;
    if (!slope) return result;
    const SensorState start{query.sensor.mm.x(), query.sensor.mm.y(), slope->x(), slope->y()};
    LensRay<double> ray = rayOf(start, lens.sensorZMm());
    result.passes = true;
    const auto visit = [&](std::size_t index, const Vector3<double>& point) {
        const double rim = system.surfaces[index].semiApertureMm;
        const double squared = (point.x * point.x + point.y * point.y) / (rim * rim);
        result.squaredHeights[index] = squared;
        if (index != system.stop && squared > 1.0) result.passes = false;
    };
    const Passage passage = carryToScene<TraceMode::geometry>(at->system(), 0, count, ray, visit);
    if (passage.status != TraceStatus::passed) result.passes = false;
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

bool passes(const RimRay& ray, const std::vector<std::size_t>& surfaces) {
    return std::ranges::all_of(surfaces,
                               [&](std::size_t index) { return ray.squaredHeights[index] <= 1.0; });
}

std::vector<std::size_t> clippingSurfaces(const TracedLens& lens, const std::vector<RimRay>& rays) {
    const std::size_t count = lens.system().surfaces.size(), stop = lens.system().stop;
    std::vector<std::size_t> chosen;
    for (const std::size_t always : {std::size_t{0}, count - 1})
        if (always != stop && std::ranges::find(chosen, always) == chosen.end())
            chosen.push_back(always);
    while (chosen.size() < mostOutputs) {
        std::vector<std::size_t> blocks(count, 0);
        std::size_t accepted = 0, wrongly = 0;
        for (const RimRay& ray : rays) {
            if (!passes(ray, chosen)) continue;
            ++accepted;
            if (ray.passes) continue;
            ++wrongly;
            for (std::size_t i = 0; i < count; ++i)
                if (i != stop && ray.squaredHeights[i] > 1.0) ++blocks[i];
        }
        if (wrongly * 2000 <= accepted) break;
        const auto most = std::ranges::max_element(blocks);
        if (*most == 0) break;  // total reflection alone
        chosen.push_back(static_cast<std::size_t>(most - blocks.begin()));
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
    clip.surfaces = clippingSurfaces(lens, rays);
    std::vector<RimRay> training;
    for (std::uint64_t round = 0; training.size() < settings.rays && round < 20; ++round) {
        for (RimRay& ray : rays)
            if (training.size() < settings.rays &&
                std::ranges::all_of(clip.surfaces, [&](std::size_t index) {
                    return ray.squaredHeights[index] <= highest;
                }))
                training.push_back(std::move(ray));
        if (training.size() < settings.rays)
            rays = drawRimRays(lens, domain, 20'000, trainingSeed + round);
    }
    const Index count = static_cast<Index>(clip.surfaces.size());
    Eigen::MatrixXd targets(static_cast<Index>(training.size()), count);
    std::vector<PolynomialInput> inputs;
    for (std::size_t i = 0; i < training.size(); ++i) {
        const FitQuery& query = training[i].query;
        inputs.push_back({query.sensor.mm, query.aperture.mm, query.wavelengthNm});
        for (Index c = 0; c < count; ++c)
            targets(static_cast<Index>(i), c) =
                training[i].squaredHeights[clip.surfaces[static_cast<std::size_t>(c)]];
    }
    const OutputCount outputs{0, static_cast<int>(count)};
    clip.squaredHeights = fitSparse(basis, outputs, candidateTerms(basis, settings.degree, outputs),
                                    scalingFor(basis, inputs, Coupling::none), inputs, targets,
                                    Eigen::VectorXd::Ones(count), {settings.terms, 1});
    return clip;
}

ClipErrors measureClip(const ClipFit& clip, const TracedLens& lens, const FitDomain& domain,
                       std::size_t rays, std::uint64_t seed) {
    const PolynomialEvaluator<double> evaluator(clip.squaredHeights);
    std::size_t accepted = 0, passed = 0, wronglyAccepted = 0, wronglyBlocked = 0;
    for (const RimRay& ray : drawRimRays(lens, domain, rays, seed)) {
        const PolynomialValues<double> heights =
            evaluator.values({ray.query.sensor.mm, ray.query.aperture.mm, ray.query.wavelengthNm});
        const bool fitted = passesRims({heights.data(), clip.surfaces.size()});
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
