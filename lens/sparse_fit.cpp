#include "lens/sparse_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "lens/parallel.h"

namespace etendue {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A column counts as a combination of others once this share of its square is left.
constexpr double dependentShare = 1e-12;

/// The monomials over all inputs, never stored as a whole: there may be thousands of either.
class MonomialTable {
public:
    MonomialTable(std::vector<Exponents> terms, const MatrixXd& variables)
        : terms_(std::move(terms)), variables_(variables) {}

    Index termCount() const { return static_cast<Index>(terms_.size()); }
    Index inputCount() const { return variables_.rows(); }

    VectorXd column(Index term) const {
        return block({terms_[static_cast<std::size_t>(term)]}, 0, inputCount());
    }

    /// Σ over inputs of (monomial, or its square) × right: terms × columns of `right`.
    template <bool squared = false>
    MatrixXd project(const MatrixXd& right) const {
        constexpr Index rowsPerBlock = 64;
        const Index blocks = (inputCount() + rowsPerBlock - 1) / rowsPerBlock;
        // A number of parts that no machine decides, added up in order: always the same bits.
        const Index parts = std::min<Index>(blocks, 16);
        std::vector<MatrixXd> sums(static_cast<std::size_t>(parts));
        parallelFor(static_cast<std::size_t>(parts), [&](std::size_t number) {
            const Index part = static_cast<Index>(number);
            MatrixXd sum = MatrixXd::Zero(termCount(), right.cols());
            for (Index b = part * blocks / parts; b < (part + 1) * blocks / parts; ++b) {
                const Index begin = b * rowsPerBlock;
                const Index rows = std::min(rowsPerBlock, inputCount() - begin);
                MatrixXd monomials = block(terms_, begin, rows);
                if constexpr (squared) monomials = monomials.cwiseAbs2().eval();
                sum.noalias() += monomials.transpose() * right.middleRows(begin, rows);
            }
            sums[number] = std::move(sum);
        });
        MatrixXd total = std::move(sums.front());
        for (std::size_t part = 1; part < sums.size(); ++part) total += sums[part];
        return total;
    }

private:
    /// Candidates come in nested loops over their powers: neighbours share most of their product.
    MatrixXd block(const std::vector<Exponents>& terms, Index begin, Index rows) const {
        MatrixXd result(rows, static_cast<Index>(terms.size()));
        std::array<Eigen::ArrayXd, 6> prefix;  // of the first i variables
        prefix.fill(Eigen::ArrayXd::Ones(rows));
        Exponents before{};
        for (std::size_t t = 0; t < terms.size(); ++t) {
            std::size_t v = 0;
            while (t > 0 && v < before.size() && terms[t][v] == before[v]) ++v;
            for (; v < before.size(); ++v) {
                prefix[v + 1] = prefix[v];
                const auto x = variables_.col(static_cast<Index>(v)).segment(begin, rows).array();
                for (int power = 0; power < terms[t][v]; ++power) prefix[v + 1] *= x;
            }
            result.col(static_cast<Index>(t)) = prefix.back();
            before = terms[t];
        }
        return result;
    }

    std::vector<Exponents> terms_;
    const MatrixXd& variables_;
};

/// Outputs to which a term contributes in the same way: as m times each of `multipliers`, which for
/// vectors of the axial basis are s and p, x above y, and 1 for everything else.
struct Family {
    std::vector<VectorXd> multipliers;
    std::vector<std::vector<Index>> rows;  // [output][multiplier]: its row of coefficients
    MatrixXd targets;                      // weighted
};

/// The columns chosen in one family, orthogonalised (X = Q R), and what they leave of the targets.
class OrthogonalColumns {
public:
    explicit OrthogonalColumns(const MatrixXd& targets) : residual_(targets) {}

    /// Adds a column; returns its new direction, zero if it depends on those before.
    VectorXd add(VectorXd column) {
        const Index count = static_cast<Index>(directions_.size());
        const double squaredBefore = column.squaredNorm();
        VectorXd along = VectorXd::Zero(count + 1);
        for (int pass = 0; pass < 2; ++pass)  // twice is enough (Kahan and Parlett)
            for (Index i = 0; i < count; ++i) {
                const VectorXd& direction = directions_[static_cast<std::size_t>(i)];
                const double share = direction.dot(column);
                column -= share * direction;
                along[i] += share;
            }
        const double length = column.norm();
        if (length * length > dependentShare * squaredBefore) {
            column /= length;
            along[count] = length;
        } else {  // a column of no use: its coefficient comes out as zero
            column.setZero();
            along.setZero();
            along[count] = 1.0;
        }
        directions_.push_back(column);
        triangle_.push_back(along);
        shares_.push_back(column.transpose() * residual_);
        residual_.noalias() -= column * shares_.back();
        return column;
    }

    const Eigen::RowVectorXd& lastShares() const { return shares_.back(); }
    double residualSquared() const { return residual_.squaredNorm(); }

    /// R, and Qᵀ targets.
    MatrixXd triangle() const {
        const Index count = static_cast<Index>(triangle_.size());
        MatrixXd result = MatrixXd::Zero(count, count);
        for (Index i = 0; i < count; ++i)
            result.col(i).head(i + 1) = triangle_[static_cast<std::size_t>(i)];
        return result;
    }
    MatrixXd shares() const {
        MatrixXd result(static_cast<Index>(shares_.size()), residual_.cols());
        for (std::size_t i = 0; i < shares_.size(); ++i)
            result.row(static_cast<Index>(i)) = shares_[i];
        return result;
    }

private:
    std::vector<VectorXd> directions_, triangle_;
    std::vector<Eigen::RowVectorXd> shares_;
    MatrixXd residual_;
};

/// What every candidate could still do for one family: the Gram matrix of its columns and their
/// products with the targets, once what the chosen columns span is taken out.
struct Prospects {
    MatrixXd gram;         // terms × (1 or 3): first, mixed, second
    MatrixXd gramAtStart;  // for telling dependent columns
    MatrixXd products;     // terms × (outputs × multipliers), multipliers fastest

    double gain(Index t, Index outputs, bool paired) const {
        const auto useful = [&](double left, Index column) {
            return left > dependentShare * gramAtStart(t, column);
        };
        double sum = 0.0;
        if (!paired) {
            if (useful(gram(t, 0), 0)) sum = products.row(t).squaredNorm() / gram(t, 0);
            return sum;
        }
        const bool first = useful(gram(t, 0), 0);
        const double mixed = first ? gram(t, 1) / gram(t, 0) : 0.0;
        const double second = gram(t, 2) - mixed * gram(t, 1);
        for (Index o = 0; o < outputs; ++o) {
            const double a = products(t, 2 * o), b = products(t, 2 * o + 1) - mixed * a;
            if (first) sum += a * a / gram(t, 0);
            if (useful(second, 2)) sum += b * b / second;
        }
        return sum;
    }
};

/// Orthogonal matching pursuit on one group of outputs.
class Pursuit {
public:
    Pursuit(const MonomialTable& table, const std::vector<Family>& families)
        : table_(table), families_(families) {
        for (const Family& family : families_) atStart_.push_back(prospects(family));
        restart({});
    }

    void growTo(std::size_t count) {
        while (support_.size() < count) {
            const std::optional<Index> best = mostUseful();
            if (!best) return;
            append(*best);
        }
    }

    /// Backward elimination: drops whichever term costs least, one at a time.
    void pruneTo(std::size_t count) {
        if (support_.size() <= count) return;
        std::vector<MatrixXd> columns, targets;
        for (const OrthogonalColumns& chosen : chosen_) {
            columns.push_back(chosen.triangle());
            targets.push_back(chosen.shares());
        }
        std::vector<Index> left = support_;
        while (left.size() > count) {
            const std::size_t victim = leastUseful(columns, targets, left.size());
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(victim));
            for (std::size_t f = 0; f < families_.size(); ++f)
                removeColumns(columns[f], victim, families_[f].multipliers.size());
        }
        restart(left);
    }

    void restart(const std::vector<Index>& support) {
        support_.clear();
        chosen_.clear();
        for (const Family& family : families_) chosen_.emplace_back(family.targets);
        prospects_ = atStart_;
        for (const Index term : support) append(term);
    }

    const std::vector<Index>& support() const { return support_; }
    double residualSquared() const {
        double sum = 0.0;
        for (const OrthogonalColumns& chosen : chosen_) sum += chosen.residualSquared();
        return sum;
    }

    /// Coefficient rows × terms in the order of support().
    MatrixXd coefficients(Index rows) const {
        MatrixXd result = MatrixXd::Zero(rows, static_cast<Index>(support_.size()));
        for (std::size_t f = 0; f < families_.size(); ++f) {
            const Index multipliers = static_cast<Index>(families_[f].multipliers.size());
            const MatrixXd solved =
                chosen_[f].triangle().triangularView<Eigen::Upper>().solve(chosen_[f].shares());
            for (std::size_t o = 0; o < families_[f].rows.size(); ++o)
                for (Index k = 0; k < multipliers; ++k)
                    for (Index t = 0; t < result.cols(); ++t)
                        result(families_[f].rows[o][static_cast<std::size_t>(k)], t) =
                            solved(t * multipliers + k, static_cast<Index>(o));
        }
        return result;
    }

private:
    /// Per input, a column of the family times each multiplier, x and y added.
    MatrixXd onInputs(const Family& family, const MatrixXd& columns) const {
        const Index n = table_.inputCount(), k = static_cast<Index>(family.multipliers.size());
        MatrixXd result(n, columns.cols() * k);
        for (Index c = 0; c < columns.cols(); ++c)
            for (Index i = 0; i < k; ++i) {
                const VectorXd product =
                    family.multipliers[static_cast<std::size_t>(i)].cwiseProduct(columns.col(c));
                result.col(c * k + i) = product.reshaped(n, product.size() / n).rowwise().sum();
            }
        return result;
    }

    Prospects prospects(const Family& family) const {
        Prospects result;
        const MatrixXd first = onInputs(family, family.multipliers.front());
        if (family.multipliers.size() == 1) {
            result.gram = table_.project<true>(first);
        } else {
            const MatrixXd second = onInputs(family, family.multipliers.back());
            MatrixXd products(first.rows(), 3);
            products << first, second.col(1);
            result.gram = table_.project<true>(products);
        }
        result.gramAtStart = result.gram;
        result.products = table_.project(onInputs(family, family.targets));
        return result;
    }

    std::optional<Index> mostUseful() const {
        std::optional<Index> best;
        // Below rounding of the targets nothing is left to find.
        double targetsSquared = 0.0, most = 0.0;
        for (const Family& family : families_) targetsSquared += family.targets.squaredNorm();
        if (residualSquared() <= 1e-28 * targetsSquared) return {};
        for (Index t = 0; t < table_.termCount(); ++t) {
            if (std::ranges::find(support_, t) != support_.end()) continue;
            double gain = 0.0;
            for (std::size_t f = 0; f < families_.size(); ++f)
                gain += prospects_[f].gain(t, families_[f].targets.cols(),
                                           families_[f].multipliers.size() == 2);
            if (gain > most) {
                most = gain;
                best = t;
            }
        }
        return best;
    }

    void append(Index term) {
        support_.push_back(term);
        const VectorXd monomial = table_.column(term);
        std::vector<MatrixXd> onFamily;
        std::vector<std::vector<Eigen::RowVectorXd>> shares(families_.size());
        Index total = 0;
        for (std::size_t f = 0; f < families_.size(); ++f) {
            const Family& family = families_[f];
            const Index k = static_cast<Index>(family.multipliers.size());
            MatrixXd directions(family.targets.rows(), k);
            for (Index i = 0; i < k; ++i) {
                const VectorXd& multiplier = family.multipliers[static_cast<std::size_t>(i)];
                directions.col(i) =
                    chosen_[f].add(monomial.replicate(multiplier.size() / monomial.size(), 1)
                                       .cwiseProduct(multiplier));
                shares[f].push_back(chosen_[f].lastShares());
            }
            onFamily.push_back(onInputs(family, directions));
            total += onFamily.back().cols();
        }
        MatrixXd right(table_.inputCount(), total);
        Index begin = 0;
        for (const MatrixXd& part : onFamily) {
            right.middleCols(begin, part.cols()) = part;
            begin += part.cols();
        }
        const MatrixXd projected = table_.project(right);
        begin = 0;
        for (std::size_t f = 0; f < families_.size(); ++f) {
            const Index k = static_cast<Index>(families_[f].multipliers.size());
            for (Index i = 0; i < k; ++i)
                deflate(prospects_[f], projected.middleCols(begin + i * k, k),
                        shares[f][static_cast<std::size_t>(i)]);
            begin += k * k;
        }
    }

    /// Takes one new direction out of what the candidates could do. `along`: of each term's
    /// columns.
    static void deflate(Prospects& prospects, const MatrixXd& along,
                        const Eigen::RowVectorXd& shares) {
        const Index k = along.cols();
        prospects.gram.col(0) -= along.col(0).cwiseAbs2();
        if (k == 2) {
            prospects.gram.col(1) -= along.col(0).cwiseProduct(along.col(1));
            prospects.gram.col(2) -= along.col(1).cwiseAbs2();
        }
        for (Index o = 0; o < shares.size(); ++o)
            for (Index i = 0; i < k; ++i)
                prospects.products.col(o * k + i) -= shares[o] * along.col(i);
    }

    /// The term without which the least-squares residual grows least.
    std::size_t leastUseful(const std::vector<MatrixXd>& columns,
                            const std::vector<MatrixXd>& targets, std::size_t terms) const {
        VectorXd losses = VectorXd::Zero(static_cast<Index>(terms));
        for (std::size_t f = 0; f < families_.size(); ++f) {
            const Index k = static_cast<Index>(families_[f].multipliers.size());
            const Eigen::HouseholderQR<MatrixXd> qr(columns[f]);
            const Index count = columns[f].cols();
            const MatrixXd inverse =
                qr.matrixQR().topRows(count).triangularView<Eigen::Upper>().solve(
                    MatrixXd::Identity(count, count));
            const MatrixXd solved = qr.solve(targets[f]);
            for (Index t = 0; t < losses.size(); ++t) {
                const MatrixXd rows = inverse.middleRows(t * k, k);
                const MatrixXd mine = solved.middleRows(t * k, k);
                losses[t] += mine.cwiseProduct((rows * rows.transpose()).ldlt().solve(mine)).sum();
            }
        }
        Index victim = 0;
        losses.minCoeff(&victim);
        return static_cast<std::size_t>(victim);
    }

    static void removeColumns(MatrixXd& columns, std::size_t term, std::size_t multipliers) {
        const Index begin = static_cast<Index>(term * multipliers);
        const Index count = static_cast<Index>(multipliers), after = columns.cols() - begin - count;
        columns.middleCols(begin, after) = columns.rightCols(after).eval();
        columns.conservativeResize(Eigen::NoChange, columns.cols() - count);
    }

    const MonomialTable& table_;
    const std::vector<Family>& families_;
    std::vector<Prospects> atStart_, prospects_;
    std::vector<OrthogonalColumns> chosen_;
    std::vector<Index> support_;
};

std::vector<Family> familiesOf(PolynomialBasis basis, OutputCount outputs,
                               const std::vector<int>& mine, const MatrixXd& scaled,
                               const MatrixXd& weighted) {
    const Index n = scaled.rows();
    std::vector<Family> families;
    Family scalars{{VectorXd::Ones(n)}, {}, MatrixXd(n, 0)};
    Family vectors{{VectorXd(2 * n), VectorXd(2 * n)}, {}, MatrixXd(2 * n, 0)};
    vectors.multipliers[0] << scaled.col(0), scaled.col(1);
    vectors.multipliers[1] << scaled.col(2), scaled.col(3);
    const auto addTarget = [](Family& family, const VectorXd& target) {
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

TermGroup fitGroup(const TermGroup& candidates, const std::vector<Family>& families,
                   const MatrixXd& variables, const SparseFitOptions& options) {
    const MonomialTable table(candidates.terms, variables);
    Pursuit pursuit(table, families);
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
            pursuit.growTo(std::min(count + (count + 3) / 4, candidates.terms.size()));
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
    SparsePolynomial result{basis, outputs, scaling, {}};
    for (const TermGroup& group : candidates) {
        const std::vector<Family> families =
            familiesOf(basis, outputs, group.outputs, scaled, weighted);
        TermGroup fitted = fitGroup(group, families, variables, options);
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
        const double inverse = 1e6 / (input.wavelengthNm * input.wavelengthNm);
        lowest = std::min(lowest, inverse);
        highest = std::max(highest, inverse);
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
