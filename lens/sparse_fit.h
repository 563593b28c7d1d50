// Sparse fitting: which few of many monomials, with which coefficients, come nearest to given
// outputs. Orthogonal matching pursuit over groups (Tropp and Gilbert 2007, "Signal Recovery from
// Random Measurements via Orthogonal Matching Pursuit"; the group form of Lozano, Swirszcz and Abe
// 2009), by the exact criterion: each round takes the monomial that lowers the weighted residual of
// all outputs most once every coefficient is fitted anew (Chen, Billings and Luo 1989, "Orthogonal
// least squares").
#pragma once

#include <functional>
#include <span>

#include "lens/polynomial_basis.h"

namespace etendue {

struct SparseFitOptions {
    int terms = 40;       // of each group; all candidates if not fewer
    int refinements = 3;  // times a quarter more terms are taken and the least useful dropped again
    /// Hears which share of the work is done, on the calling thread, now and then.
    std::function<void(double share)> progress = {};
};

/// The polynomial with at most `options.terms` terms per group of `candidates` that comes nearest
/// to `targets` (inputs × outputs) in least squares, each output divided by its entry in
/// `tolerances`. The same bits for any number of threads.
SparsePolynomial fitSparse(PolynomialBasis basis, OutputCount outputs,
                           const std::vector<TermGroup>& candidates, const InputScaling& scaling,
                           std::span<const PolynomialInput> inputs, const Eigen::MatrixXd& targets,
                           const Eigen::VectorXd& tolerances, const SparseFitOptions& options);

/// The same terms with coefficients fitted to other targets.
SparsePolynomial refit(const SparsePolynomial& polynomial, std::span<const PolynomialInput> inputs,
                       const Eigen::MatrixXd& targets);

/// Whether p is freed of what a regression on s predicts. It pays where the two hang together, as
/// position and direction at the sensor do.
enum class Coupling { none, fitted };

/// Scaling for these inputs: s and p to the unit disc. The axial basis couples x and y alike.
InputScaling scalingFor(PolynomialBasis basis, std::span<const PolynomialInput> inputs,
                        Coupling coupling);

}  // namespace etendue
