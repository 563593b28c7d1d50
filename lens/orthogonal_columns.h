// OrthogonalColumns: columns chosen one after another, orthogonalised (X = Q R), and what they
// leave of the targets of a least-squares problem.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace etendue {

/// A column counts as a combination of others once this share of its square is left.
constexpr double dependentShare = 1e-12;

class OrthogonalColumns {
public:
    explicit OrthogonalColumns(const Eigen::MatrixXd& targets) : residual_(targets) {}

    /// Adds a column; returns its new direction, zero if it depends on those before.
    Eigen::VectorXd add(Eigen::VectorXd column);

    /// The new direction's, of the targets.
    const Eigen::RowVectorXd& lastShares() const { return shares_.back(); }
    double residualSquared() const { return residual_.squaredNorm(); }

    Eigen::MatrixXd triangle() const;  // R
    Eigen::MatrixXd shares() const;    // Qᵀ targets

private:
    std::vector<Eigen::VectorXd> directions_, triangle_;
    std::vector<Eigen::RowVectorXd> shares_;
    Eigen::MatrixXd residual_;
};

}  // namespace etendue
