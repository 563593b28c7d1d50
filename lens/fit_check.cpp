#include "lens/fit_check.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

using Fault = std::optional<std::string>;

bool isTermOf(PolynomialBasis basis, const Exponents& exponents) {
    const bool inRange = std::ranges::all_of(exponents, [](int e) { return e <= mostPower; });
    return inRange && (basis != PolynomialBasis::axial || exponents.back() == 0);
}

Fault groupFault(PolynomialBasis basis, const TermGroup& group) {
    if (!std::ranges::all_of(group.terms,
                             [&](const Exponents& term) { return isTermOf(basis, term); }))
        return "a term is none of the basis";
    if (group.coefficients.rows() != static_cast<Eigen::Index>(group.outputs.size()) ||
        group.coefficients.cols() != static_cast<Eigen::Index>(group.terms.size()))
        return "coefficients are missing";
    if (!group.coefficients.allFinite()) return "a coefficient is not finite";
    return {};
}

bool isFinite(const InputScaling& scaling) {
    return std::isfinite(scaling.sensorScale) && std::isfinite(scaling.secondScale) &&
           scaling.coupling.allFinite() && std::isfinite(scaling.waveScale) &&
           std::isfinite(scaling.waveOffset);
}

Fault domainFault(const FitDomain& d) {
    const bool isSound =
        d.sensorHalfSizeMm.allFinite() && d.sensorHalfSizeMm.minCoeff() > 0.0 &&
        d.imageRadiusMm > 0.0 && std::isfinite(d.sensorDistanceMm) && d.apertureRadiusMm > 0.0 &&
        std::isfinite(d.apertureRadiusMm) && d.shortestWavelengthNm > 0.0 &&
        d.shortestWavelengthNm <= d.longestWavelengthNm && std::isfinite(d.longestWavelengthNm) &&
        d.sensorTravelMm >= 0.0 && std::isfinite(d.sensorTravelMm);
    if (!isSound) return "domain: it is empty";
    return {};
}

}  // namespace

Fault findFault(const SparsePolynomial& polynomial) {
    const auto [vectors, scalars] = polynomial.outputs;
    if (vectors < 0 || scalars < 0) return "a number of outputs is negative";
    if (!isFinite(polynomial.scaling)) return "the scaling is not finite";
    if (polynomial.outputs.total() == 0 && polynomial.groups.empty()) return {};
    const std::vector<TermGroup> model = candidateTerms(polynomial.basis, 1, polynomial.outputs);
    if (!std::ranges::equal(polynomial.groups, model, {}, &TermGroup::outputs, &TermGroup::outputs))
        return "its outputs are not each in one group, in order";
    for (const TermGroup& group : polynomial.groups)
        if (Fault fault = groupFault(polynomial.basis, group)) return fault;
    return {};
}

Fault findFault(const LensFit& fit) {
    if (Fault fault = domainFault(fit.domain)) return fault;
    const bool isSensorState = fit.settings.form == FitForm::sensorState;
    const bool isMoved = fit.domain.sensorTravelMm > 0.0;
    struct Part {
        const char* name;
        const SparsePolynomial& polynomial;
        OutputCount outputs;
    };
    const Part parts[]{
        {"exit", fit.exit, exitOutputs},
        {"aperture", fit.aperture, isSensorState ? apertureOutputs : OutputCount{0, 0}},
        {"clip", fit.clip.squares, {0, static_cast<int>(fit.clip.count())}},
        {"start", fit.start.sensor, startOutputs},
        {"slope", fit.slope, isMoved ? slopeOutputs : OutputCount{0, 0}}};
    for (const auto& [name, polynomial, outputs] : parts) {
        if (polynomial.outputs != outputs)
            return std::string(name) + ": expected " + std::to_string(outputs.vectors) +
                   " vectors and " + std::to_string(outputs.scalars) + " scalars";
        if (const Fault fault = findFault(polynomial)) return std::string(name) + ": " + *fault;
    }
    return {};
}

}  // namespace etendue
