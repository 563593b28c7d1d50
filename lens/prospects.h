// Prospects: what every candidate term could still do for one family of outputs.
#pragma once

#include "lens/monomial_table.h"
#include "lens/output_family.h"

namespace etendue {

/// The Gram matrix of each candidate's columns and their products with the targets, once what the
/// chosen columns span is taken out.
class Prospects {
public:
    Prospects(const MonomialTable& table, const OutputFamily& family);

    /// By how much the squared residual falls if the term is chosen and all coefficients are fitted
    /// anew.
    double gain(Eigen::Index term) const;

    /// Takes out one chosen direction. `along`: of each term's columns, terms × multipliers;
    /// `shares`: of the targets.
    void deflate(const Eigen::MatrixXd& along, const Eigen::RowVectorXd& shares);

private:
    Eigen::Index outputs_;
    bool paired_;                  // two multipliers
    Eigen::MatrixXd gram_;         // terms × (1 or 3): first, mixed, second
    Eigen::MatrixXd gramAtStart_;  // for telling dependent columns
    Eigen::MatrixXd products_;     // terms × (outputs × multipliers), multipliers fastest
};

}  // namespace etendue
