#include "lens/prospects.h"

#include "lens/orthogonal_columns.h"

namespace etendue {

using Eigen::Index;
using Eigen::MatrixXd;

Prospects::Prospects(const MonomialTable& table, const OutputFamily& family)
    : outputs_(family.targets.cols()), paired_(family.multiplierCount() == 2) {
    const Index inputs = table.inputCount();
    const MatrixXd first = family.perInput(family.multipliers.front(), inputs);
    if (!paired_) {
        gram_ = table.projectSquares(first);
    } else {
        const MatrixXd second = family.perInput(family.multipliers.back(), inputs);
        MatrixXd products(inputs, 3);
        products << first, second.col(1);
        gram_ = table.projectSquares(products);
    }
    gramAtStart_ = gram_;
    products_ = table.project(family.perInput(family.targets, inputs));
}

double Prospects::gain(Index t) const {
    const auto useful = [&](double left, Index column) {
        return left > dependentShare * gramAtStart_(t, column);
    };
    const bool first = useful(gram_(t, 0), 0);
    if (!paired_) return first ? products_.row(t).squaredNorm() / gram_(t, 0) : 0.0;
    const double mixed = first ? gram_(t, 1) / gram_(t, 0) : 0.0;
    const double second = gram_(t, 2) - mixed * gram_(t, 1);
    double sum = 0.0;
    for (Index o = 0; o < outputs_; ++o) {
        const double a = products_(t, 2 * o), b = products_(t, 2 * o + 1) - mixed * a;
        if (first) sum += a * a / gram_(t, 0);
        if (useful(second, 2)) sum += b * b / second;
    }
    return sum;
}

void Prospects::deflate(const MatrixXd& along, const Eigen::RowVectorXd& shares) {
    const Index multipliers = along.cols();
    gram_.col(0) -= along.col(0).cwiseAbs2();
    if (paired_) {
        gram_.col(1) -= along.col(0).cwiseProduct(along.col(1));
        gram_.col(2) -= along.col(1).cwiseAbs2();
    }
    for (Index o = 0; o < outputs_; ++o)
        for (Index i = 0; i < multipliers; ++i)
            products_.col(o * multipliers + i) -= shares[o] * along.col(i);
}

}  // namespace etendue
