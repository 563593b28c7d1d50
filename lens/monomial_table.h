// MonomialTable: the candidate monomials over all inputs of a fit, as columns of a matrix that is
// never stored as a whole: there may be thousands of either.
#pragma once

#include "lens/polynomial_basis.h"

namespace etendue {

class MonomialTable {
public:
    /// `variables`: of each input in a row, kept by reference.
    MonomialTable(std::vector<Exponents> terms, const Eigen::MatrixXd& variables);

    Eigen::Index termCount() const { return static_cast<Eigen::Index>(terms_.size()); }
    Eigen::Index inputCount() const { return variables_.rows(); }

    Eigen::VectorXd column(Eigen::Index term) const;

    /// Σ over inputs of monomial × right: terms × columns of `right`. The same bits for any number
    /// of threads.
    Eigen::MatrixXd project(const Eigen::MatrixXd& right) const { return project<false>(right); }
    /// The same with the monomials' squares.
    Eigen::MatrixXd projectSquares(const Eigen::MatrixXd& right) const {
        return project<true>(right);
    }

private:
    template <bool squared>
    Eigen::MatrixXd project(const Eigen::MatrixXd& right) const;
    /// Inputs × terms, of `rows` inputs.
    void fillBlock(const std::vector<Exponents>& terms, Eigen::Index begin, Eigen::Index rows,
                   Eigen::MatrixXd& result) const;

    std::vector<Exponents> terms_;
    const Eigen::MatrixXd& variables_;
    Exponents highest_{};  // power of each variable
};

}  // namespace etendue
