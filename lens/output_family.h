// OutputFamily: the outputs of a polynomial to which a term contributes in the same way.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace etendue {

/// A term's monomial m contributes as m times each of `multipliers`: for vectors of the axial basis
/// s and p, x above y, and 1 for everything else.
struct OutputFamily {
    std::vector<Eigen::VectorXd> multipliers;     // one or two
    std::vector<std::vector<Eigen::Index>> rows;  // [output][multiplier]: its row of coefficients
    Eigen::MatrixXd targets;                      // weighted

    Eigen::Index multiplierCount() const { return static_cast<Eigen::Index>(multipliers.size()); }

    /// `perInput` (a number an input) times a multiplier: a column beside the targets.
    Eigen::VectorXd multiplied(const Eigen::VectorXd& perInput, Eigen::Index multiplier) const {
        const Eigen::VectorXd& factor = multipliers[static_cast<std::size_t>(multiplier)];
        return perInput.replicate(factor.size() / perInput.size(), 1).cwiseProduct(factor);
    }

    /// The other way round: each of `columns` times each multiplier, multipliers fastest, x and y
    /// of an input added. Its product with a monomial is that of the columns with the monomial's.
    Eigen::MatrixXd perInput(const Eigen::MatrixXd& columns, Eigen::Index inputs) const {
        const Eigen::Index count = multiplierCount();
        Eigen::MatrixXd result(inputs, columns.cols() * count);
        for (Eigen::Index c = 0; c < columns.cols(); ++c)
            for (Eigen::Index i = 0; i < count; ++i) {
                const Eigen::VectorXd product =
                    multipliers[static_cast<std::size_t>(i)].cwiseProduct(columns.col(c));
                result.col(c * count + i) =
                    product.reshaped(inputs, product.size() / inputs).rowwise().sum();
            }
        return result;
    }
};

}  // namespace etendue
