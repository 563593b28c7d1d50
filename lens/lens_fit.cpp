#include "lens/lens_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lens/fitted_map.h"
#include "lens/polynomial.h"
#include "lens/sparse_fit.h"

namespace etendue {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::uint64_t trainingSeed = 1, heldOutSeed = 2;

PolynomialInput inputOf(const FitRay& ray, FitForm form) {
    const Eigen::Vector2d& second = form == FitForm::twoPoint ? ray.query.aperture.mm : ray.slope;
    return {ray.query.sensor.mm, second, ray.query.wavelengthNm};
}

MatrixXd exitTargets(const std::vector<FitRay>& rays, FitForm form) {
    MatrixXd targets(static_cast<Index>(rays.size()), exitOutputs.total());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const PupilState<double>& pupil = rays[i].pupil;
        targets.row(static_cast<Index>(i)) << pupil.x, pupil.y, pupil.directionX, pupil.directionY,
            form == FitForm::twoPoint ? rays[i].throughput : rays[i].transmittance;
    }
    return targets;
}

MatrixXd apertureTargets(const std::vector<FitRay>& rays) {
    MatrixXd targets(static_cast<Index>(rays.size()), apertureOutputs.total());
    for (std::size_t i = 0; i < rays.size(); ++i)
        targets.row(static_cast<Index>(i)) << rays[i].query.aperture.mm.transpose(),
            rays[i].apertureSlope.transpose();
    return targets;
}

/// How much of an output's unit is as bad as one radian of direction: the support is chosen for
/// directions above all, for positions as they look from a distance, for throughput as the eye
/// sees it.
VectorXd exitTolerances(const MatrixXd& targets) {
    const double pupilRadius = std::sqrt(targets.leftCols<2>().rowwise().squaredNorm().maxCoeff());
    const double brightness = targets.col(4).cwiseAbs().mean();
    VectorXd tolerances(exitOutputs.total());
    tolerances << 10.0 * pupilRadius, 10.0 * pupilRadius, 1.0, 1.0, 10.0 * brightness;
    return tolerances;
}

VectorXd apertureTolerances(const MatrixXd& targets) {
    const double radius = std::sqrt(targets.leftCols<2>().rowwise().squaredNorm().maxCoeff());
    const double slope = std::sqrt(targets.rightCols<2>().rowwise().squaredNorm().maxCoeff());
    VectorXd tolerances(apertureOutputs.total());
    tolerances << radius, radius, 10.0 * slope, 10.0 * slope;
    return tolerances;
}

/// The directions once more, in the tangent frame at the *fitted* pupil position: what the position
/// is off by then turns no direction.
MatrixXd atFittedPosition(const SparsePolynomial& exit, const std::vector<FitRay>& rays,
                          std::span<const PolynomialInput> inputs, const PupilSphere& sphere,
                          MatrixXd targets) {
    const PolynomialEvaluator<double> evaluator(exit);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const PolynomialResult<double> fitted = evaluator.evaluate(inputs[i]);
        const std::optional<LensRay<double>> there =
            sphere.ray({fitted.values[0], fitted.values[1], 0.0, 0.0});
        if (!there) continue;  // beyond the equator: as it was
        const auto state =
            sphere.state(LensRay<double>{there->origin, fromEigen(rays[i].direction)});
        if (!state) continue;
        targets(static_cast<Index>(i), 2) = state->directionX;
        targets(static_cast<Index>(i), 3) = state->directionY;
    }
    return targets;
}

std::size_t trainingCount(const std::vector<TermGroup>& candidates, const FitSettings& settings) {
    std::size_t most = 0;
    for (const TermGroup& group : candidates) most = std::max(most, group.terms.size());
    return std::clamp<std::size_t>(most * static_cast<std::size_t>(settings.raysPerCandidate), 4000,
                                   100'000);
}

}  // namespace

LensFit fitLens(const Prescription& prescription, const FitDomain& domain,
                const FitSettings& settings, const FitProgress& progress) {
    const auto tell = [&](double share, std::string_view stage) {
        if (progress) progress(share, stage);
    };
    tell(0.0, "tracing rays");
    const TracedLens lens = lensOf(prescription, domain);
    const PupilSphere sphere(lens.system());
    LensFit fit;
    fit.settings = settings;
    fit.domain = domain;
    fit.prescriptionHash = contentHash(prescription);
    const std::vector<TermGroup> candidates =
        candidateTerms(settings.basis, settings.degree, exitOutputs);
    const FitRays training =
        drawFitRays(lens, domain, trainingCount(candidates, settings), trainingSeed);
    if (training.rays.empty())
        throw std::invalid_argument("lens fit: no ray passes " + prescription.name);
    const Surface& outermost = prescription.surfaces.front();
    if (training.counts.besidePupil > 0 && outermost.semiApertureMm > std::abs(outermost.radiusMm))
        throw std::invalid_argument("lens fit: " + prescription.name +
                                    ": light leaves its first surface farther out than that "
                                    "surface's vertex radius, where the fit has no coordinates");
    fit.training = training.counts;
    std::vector<PolynomialInput> inputs;
    for (const FitRay& ray : training.rays) inputs.push_back(inputOf(ray, settings.form));
    // On an axial lens stop and sensor points are drawn independently, and batches are faster
    // uncoupled; the rims of others leave them related.
    const bool related =
        settings.form == FitForm::sensorState || settings.basis != PolynomialBasis::axial;
    const InputScaling scaling =
        scalingFor(settings.basis, inputs, related ? Coupling::fitted : Coupling::none);
    const bool isSensorState = settings.form == FitForm::sensorState;
    // About how the time is spent.
    constexpr double begin = 0.1, end = 0.7;
    const double half = isSensorState ? 0.5 * (begin + end) : end;
    const auto optionsFor = [&](double from, double to) {
        return SparseFitOptions{settings.terms, settings.refinements, [=, &tell](double share) {
                                    tell(from + share * (to - from), "choosing terms");
                                }};
    };
    const MatrixXd targets = exitTargets(training.rays, settings.form);
    fit.exit = fitSparse(settings.basis, exitOutputs, candidates, scaling, inputs, targets,
                         exitTolerances(targets), optionsFor(begin, half));
    fit.exit =
        refit(fit.exit, inputs, atFittedPosition(fit.exit, training.rays, inputs, sphere, targets));
    if (isSensorState) {
        const MatrixXd apertures = apertureTargets(training.rays);
        fit.aperture =
            fitSparse(settings.basis, apertureOutputs,
                      candidateTerms(settings.basis, settings.degree, apertureOutputs), scaling,
                      inputs, apertures, apertureTolerances(apertures), optionsFor(half, end));
    }
    fit.start = fitConnectStart(training.rays, FittedMap(prescription, fit), lens.system(),
                                !isAnamorphic(prescription));
    if (domain.sensorTravelMm > 0.0)
        fit.slope = fitSensorSlope(training.rays, !isAnamorphic(prescription));
    tell(end, "fitting the rims");
    fit.clip = fitClip(lens, domain, settings.basis, settings.clip);
    tell(0.8, "measuring errors");
    fit.errors = measureErrors(fit, lens, 10'000, heldOutSeed);
    fit.clipErrors = measureClip(fit.clip, lens, domain, 20'000, heldOutSeed);
    tell(1.0, "done");
    return fit;
}

}  // namespace etendue
