#include "lens/sparse_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lens/pursuit.h"

namespace etendue {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<OutputFamily> familiesOf(PolynomialBasis basis, OutputCount outputs,
                                     const std::vector<int>& mine, const MatrixXd& scaled,
                                     const MatrixXd& weighted) {
    const Index n = scaled.rows();
    std::vector<OutputFamily> families;
    OutputFamily scalars{{VectorXd::Ones(n)}, {}, MatrixXd(n, 0)};
    OutputFamily vectors{{VectorXd(2 * n), VectorXd(2 * n)}, {}, MatrixXd(2 * n, 0)};
    vectors.multipliers[0] << scaled.col(0), scaled.col(1);
    vectors.multipliers[1] << scaled.col(2), scaled.col(3);
    const auto addTarget = [](OutputFamily& family, const VectorXd& target) {
        family.targets.conservativeResize(Eigen::NoChange, family.targets.cols() + 1);
        family.targets.rightCols<1>() = target;
    };
    for (std::size_t i = 0; i < mine.size(); ++i) {
        const Index row = static_cast<Index>(i);
        if (basis != PolynomialBasis::axial || mine[i] >= 2 * outputs.vectors) {
            addTarget(scalars, weighted.col(mine[i]));
            scalars.rows.push_back({row});
        } else if (mine[i] % 2 == 0) {
            VectorXd both(2 * n);
            both << weighted.col(mine[i]), weighted.col(mine[i] + 1);
            addTarget(vectors, both);
            vectors.rows.push_back({row, row + 1});
        }
    }
    if (!vectors.rows.empty()) families.push_back(std::move(vectors));
    if (!scalars.rows.empty()) families.push_back(std::move(scalars));
    return families;
}

/// How many terms more than wanted a refinement takes before it drops the least useful.
std::size_t surplus(std::size_t terms) { return (terms + 3) / 4; }

TermGroup fitGroup(const TermGroup& candidates, const std::vector<OutputFamily>& families,
                   const MatrixXd& variables, const SparseFitOptions& options,
                   const std::function<void()>& onTerm) {
    const MonomialTable table(candidates.terms, variables);
    Pursuit pursuit(table, families, onTerm);
    const std::size_t count = static_cast<std::size_t>(options.terms);
    if (count >= candidates.terms.size()) {
        std::vector<Index> all(candidates.terms.size());
        std::iota(all.begin(), all.end(), Index{0});
        pursuit.restart(all);
    } else {
        pursuit.growTo(count);
        for (int i = 0; i < options.refinements && pursuit.support().size() == count; ++i) {
            const std::vector<Index> before = pursuit.support();
            const double residualBefore = pursuit.residualSquared();
            pursuit.growTo(std::min(count + surplus(count), candidates.terms.size()));
            pursuit.pruneTo(count);
            if (pursuit.residualSquared() >= residualBefore) {
                pursuit.restart(before);
                break;
            }
        }
    }
    TermGroup result{candidates.outputs, {}, {}};
    for (const Index term : pursuit.support())
        result.terms.push_back(candidates.terms[static_cast<std::size_t>(term)]);
    result.coefficients = pursuit.coefficients(static_cast<Index>(candidates.outputs.size()));
    return result;
}

}  // namespace

SparsePolynomial fitSparse(PolynomialBasis basis, OutputCount outputs,
                           const std::vector<TermGroup>& candidates, const InputScaling& scaling,
                           std::span<const PolynomialInput> inputs, const MatrixXd& targets,
                           const VectorXd& tolerances, const SparseFitOptions& options) {
    const Index n = static_cast<Index>(inputs.size());
    MatrixXd scaled(n, 5), variables(n, 5);
    for (Index i = 0; i < n; ++i) {
        const ScaledInput input = scaledInput(scaling, inputs[static_cast<std::size_t>(i)]);
        scaled.row(i) = input.transpose();
        variables.row(i) = basisVariables(basis, input).transpose();
    }
    const MatrixXd weighted = targets * tolerances.cwiseInverse().asDiagonal();
    const std::size_t terms = static_cast<std::size_t>(options.terms);
    const double expected =
        static_cast<double>(candidates.size()) *
        static_cast<double>(terms + static_cast<std::size_t>(options.refinements) * surplus(terms));
    double taken = 0.0;
    const auto onTerm = [&] {
        if (options.progress) options.progress(std::min(1.0, ++taken / expected));
    };
    SparsePolynomial result{basis, outputs, scaling, {}};
    for (const TermGroup& group : candidates) {
        const std::vector<OutputFamily> families =
            familiesOf(basis, outputs, group.outputs, scaled, weighted);
        TermGroup fitted = fitGroup(group, families, variables, options, onTerm);
        for (std::size_t i = 0; i < fitted.outputs.size(); ++i)
            fitted.coefficients.row(static_cast<Index>(i)) *= tolerances[fitted.outputs[i]];
        result.groups.push_back(std::move(fitted));
    }
    return result;
}

SparsePolynomial refit(const SparsePolynomial& polynomial, std::span<const PolynomialInput> inputs,
                       const MatrixXd& targets) {
    SparseFitOptions all;
    for (const TermGroup& group : polynomial.groups)
        all.terms = std::max(all.terms, static_cast<int>(group.terms.size()));
    return fitSparse(polynomial.basis, polynomial.outputs, polynomial.groups, polynomial.scaling,
                     inputs, targets, VectorXd::Ones(polynomial.outputs.total()), all);
}

InputScaling scalingFor(PolynomialBasis basis, std::span<const PolynomialInput> inputs,
                        Coupling coupling) {
    InputScaling scaling;
    Eigen::Vector2d products(0.0, 0.0), squares(0.0, 0.0);
    double longestS = 0.0, longestP = 0.0, lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (const PolynomialInput& input : inputs) {
        products += input.p.cwiseProduct(input.s);
        squares += input.s.cwiseAbs2();
        longestS = std::max(longestS, input.s.norm());
        // As scaledInput() has it: one wavelength alone is then w = 0 exactly, and no term has it.
        const double perMicrometre = 1e3 / input.wavelengthNm;
        lowest = std::min(lowest, perMicrometre * perMicrometre);
        highest = std::max(highest, perMicrometre * perMicrometre);
    }
    if (basis == PolynomialBasis::axial) {
        products.setConstant(products.sum());
        squares.setConstant(squares.sum());
    }
    for (int i = 0; i < 2; ++i)
        if (coupling == Coupling::fitted && squares[i] > 0.0)
            scaling.coupling[i] = -products[i] / squares[i];
    for (const PolynomialInput& input : inputs)
        longestP = std::max(longestP, (input.p + scaling.coupling.cwiseProduct(input.s)).norm());
    if (longestS > 0.0) scaling.sensorScale = 1.0 / longestS;
    if (longestP > 0.0) scaling.secondScale = 1.0 / longestP;
    scaling.waveOffset = 0.5 * (lowest + highest);
    if (highest > lowest) scaling.waveScale = 2.0 / (highest - lowest);
    return scaling;
}

}  // namespace etendue
