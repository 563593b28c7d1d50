#include "lens/pursuit.h"

#include <Eigen/QR>
#include <algorithm>
#include <utility>

namespace etendue {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A least-squares problem in few rows, its columns those of the terms one after another.
struct Reduced {
    MatrixXd columns, targets;
    Index columnsPerTerm;

    /// What the squared residual grows by if a term goes and the others are fitted anew.
    VectorXd losses() const {
        const Index count = columns.cols();
        const Eigen::HouseholderQR<MatrixXd> qr(columns);
        const MatrixXd inverse = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>().solve(
            MatrixXd::Identity(count, count));
        const MatrixXd solved = qr.solve(targets);
        VectorXd result(count / columnsPerTerm);
        for (Index t = 0; t < result.size(); ++t) {
            const MatrixXd rows = inverse.middleRows(t * columnsPerTerm, columnsPerTerm);
            const MatrixXd mine = solved.middleRows(t * columnsPerTerm, columnsPerTerm);
            result[t] = mine.cwiseProduct((rows * rows.transpose()).ldlt().solve(mine)).sum();
        }
        return result;
    }

    void remove(Index term) {
        const Index begin = term * columnsPerTerm;
        const Index after = columns.cols() - begin - columnsPerTerm;
        columns.middleCols(begin, after) = columns.rightCols(after).eval();
        columns.conservativeResize(Eigen::NoChange, columns.cols() - columnsPerTerm);
    }
};

}  // namespace

Pursuit::Pursuit(const MonomialTable& table, const std::vector<OutputFamily>& families,
                 std::function<void()> onTerm)
    : table_(table), families_(families), onTerm_(std::move(onTerm)) {
    for (const OutputFamily& family : families_) {
        atStart_.emplace_back(table_, family);
        targetsSquared_ += family.targets.squaredNorm();
    }
    restart({});
}

void Pursuit::growTo(std::size_t count) {
    while (support_.size() < count) {
        const std::optional<Index> best = mostUseful();
        if (!best) return;
        take({&*best, 1});
        if (onTerm_) onTerm_();
    }
}

void Pursuit::pruneTo(std::size_t count) {
    if (support_.size() <= count) return;
    std::vector<Reduced> reduced;
    for (std::size_t f = 0; f < families_.size(); ++f)
        reduced.push_back(
            {chosen_[f].triangle(), chosen_[f].shares(), families_[f].multiplierCount()});
    std::vector<Index> left = support_;
    while (left.size() > count) {
        VectorXd losses = VectorXd::Zero(static_cast<Index>(left.size()));
        for (const Reduced& problem : reduced) losses += problem.losses();
        Index victim = 0;
        losses.minCoeff(&victim);
        left.erase(left.begin() + victim);
        for (Reduced& problem : reduced) problem.remove(victim);
    }
    restart(left);
}

void Pursuit::restart(std::span<const Index> support) {
    support_.clear();
    chosen_.clear();
    for (const OutputFamily& family : families_) chosen_.emplace_back(family.targets);
    prospects_ = atStart_;
    take(support);
}

double Pursuit::residualSquared() const {
    double sum = 0.0;
    for (const OrthogonalColumns& chosen : chosen_) sum += chosen.residualSquared();
    return sum;
}

MatrixXd Pursuit::coefficients(Index rows) const {
    MatrixXd result = MatrixXd::Zero(rows, static_cast<Index>(support_.size()));
    for (std::size_t f = 0; f < families_.size(); ++f) {
        const OutputFamily& family = families_[f];
        const Index multipliers = family.multiplierCount();
        const MatrixXd solved =
            chosen_[f].triangle().triangularView<Eigen::Upper>().solve(chosen_[f].shares());
        for (std::size_t o = 0; o < family.rows.size(); ++o)
            for (Index k = 0; k < multipliers; ++k)
                for (Index t = 0; t < result.cols(); ++t)
                    result(family.rows[o][static_cast<std::size_t>(k)], t) =
                        solved(t * multipliers + k, static_cast<Index>(o));
    }
    return result;
}

std::optional<Index> Pursuit::mostUseful() const {
    // Below rounding of the targets nothing is left to find.
    if (residualSquared() <= 1e-28 * targetsSquared_) return {};
    std::optional<Index> best;
    double most = 0.0;
    for (Index t = 0; t < table_.termCount(); ++t) {
        if (std::ranges::find(support_, t) != support_.end()) continue;
        double gain = 0.0;
        for (const Prospects& prospects : prospects_) gain += prospects.gain(t);
        if (gain > most) {
            most = gain;
            best = t;
        }
    }
    return best;
}

void Pursuit::take(std::span<const Index> terms) {
    support_.insert(support_.end(), terms.begin(), terms.end());
    // The directions of all terms are projected on the candidates in one pass over the inputs.
    std::vector<MatrixXd> perInput;
    std::vector<std::vector<Eigen::RowVectorXd>> shares(families_.size());
    Index total = 0;
    for (std::size_t f = 0; f < families_.size(); ++f) {
        const OutputFamily& family = families_[f];
        const Index multipliers = family.multiplierCount();
        MatrixXd directions(family.targets.rows(), multipliers * static_cast<Index>(terms.size()));
        for (std::size_t t = 0; t < terms.size(); ++t) {
            const VectorXd monomial = table_.column(terms[t]);
            for (Index i = 0; i < multipliers; ++i) {
                directions.col(static_cast<Index>(t) * multipliers + i) =
                    chosen_[f].add(family.multiplied(monomial, i));
                shares[f].push_back(chosen_[f].lastShares());
            }
        }
        perInput.push_back(family.perInput(directions, table_.inputCount()));
        total += perInput.back().cols();
    }
    if (static_cast<Index>(support_.size()) == table_.termCount()) return;  // none left to judge
    MatrixXd right(table_.inputCount(), total);
    Index begin = 0;
    for (const MatrixXd& part : perInput) {
        right.middleCols(begin, part.cols()) = part;
        begin += part.cols();
    }
    const MatrixXd projected = table_.project(right);
    begin = 0;
    for (std::size_t f = 0; f < families_.size(); ++f) {
        const Index multipliers = families_[f].multiplierCount();
        for (const Eigen::RowVectorXd& share : shares[f]) {
            prospects_[f].deflate(projected.middleCols(begin, multipliers), share);
            begin += multipliers;
        }
    }
}

}  // namespace etendue
