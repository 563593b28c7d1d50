#include "lens/monomial_table.h"

#include <algorithm>

#include "lens/parallel.h"

namespace etendue {

using Eigen::Index;
using Eigen::MatrixXd;

MonomialTable::MonomialTable(std::vector<Exponents> terms, const MatrixXd& variables)
    : terms_(std::move(terms)), variables_(variables) {
    for (const Exponents& e : terms_)
        for (std::size_t v = 0; v < e.size(); ++v) highest_[v] = std::max(highest_[v], e[v]);
}

Eigen::VectorXd MonomialTable::column(Index term) const {
    MatrixXd result;
    fillBlock({terms_[static_cast<std::size_t>(term)]}, 0, inputCount(), result);
    return result;
}

template <bool squared>
MatrixXd MonomialTable::project(const MatrixXd& right) const {
    constexpr Index rowsPerBlock = 64;
    const Index blocks = (inputCount() + rowsPerBlock - 1) / rowsPerBlock;
    // A number of parts that no machine decides, added up in order: always the same bits.
    const Index parts = std::min<Index>(blocks, 16);
    std::vector<MatrixXd> sums(static_cast<std::size_t>(parts));
    parallelFor(static_cast<std::size_t>(parts), [&](std::size_t number) {
        const Index part = static_cast<Index>(number);
        MatrixXd sum = MatrixXd::Zero(termCount(), right.cols());
        MatrixXd monomials;
        for (Index b = part * blocks / parts; b < (part + 1) * blocks / parts; ++b) {
            const Index begin = b * rowsPerBlock;
            const Index rows = std::min(rowsPerBlock, inputCount() - begin);
            fillBlock(terms_, begin, rows, monomials);
            if constexpr (squared) monomials = monomials.cwiseAbs2();
            sum.noalias() += monomials.transpose() * right.middleRows(begin, rows);
        }
        sums[number] = std::move(sum);
    });
    MatrixXd total = std::move(sums.front());
    for (std::size_t part = 1; part < sums.size(); ++part) total += sums[part];
    return total;
}

template MatrixXd MonomialTable::project<false>(const MatrixXd&) const;
template MatrixXd MonomialTable::project<true>(const MatrixXd&) const;

void MonomialTable::fillBlock(const std::vector<Exponents>& terms, Index begin, Index rows,
                              MatrixXd& result) const {
    constexpr std::size_t variables = std::tuple_size_v<Exponents>;
    std::array<Eigen::ArrayXXd, variables> powers;
    for (std::size_t v = 0; v < variables; ++v) {
        const auto x = variables_.col(static_cast<Index>(v)).segment(begin, rows).array();
        powers[v] = Eigen::ArrayXXd::Ones(rows, highest_[v] + 1);
        for (Index i = 1; i <= highest_[v]; ++i) powers[v].col(i) = powers[v].col(i - 1) * x;
    }
    // Candidates come in nested loops over their powers: neighbours share most of their product.
    std::array<Eigen::ArrayXd, variables> prefix;  // of the first i variables
    prefix[0] = Eigen::ArrayXd::Ones(rows);
    result.resize(rows, static_cast<Index>(terms.size()));
    for (std::size_t t = 0; t < terms.size(); ++t) {
        std::size_t v = 0;
        while (t > 0 && v + 1 < variables && terms[t][v] == terms[t - 1][v]) ++v;
        for (; v + 1 < variables; ++v) prefix[v + 1] = prefix[v] * powers[v].col(terms[t][v]);
        result.col(static_cast<Index>(t)) = prefix[v] * powers[v].col(terms[t][v]);
    }
}

}  // namespace etendue
