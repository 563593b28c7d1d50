#include "lens/monomial_table.h"

#include "lens/parallel.h"

namespace etendue {

using Eigen::Index;
using Eigen::MatrixXd;

Eigen::VectorXd MonomialTable::column(Index term) const {
    return block({terms_[static_cast<std::size_t>(term)]}, 0, inputCount());
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

template MatrixXd MonomialTable::project<false>(const MatrixXd&) const;
template MatrixXd MonomialTable::project<true>(const MatrixXd&) const;

MatrixXd MonomialTable::block(const std::vector<Exponents>& terms, Index begin, Index rows) const {
    MatrixXd result(rows, static_cast<Index>(terms.size()));
    // Candidates come in nested loops over their powers: neighbours share most of their product.
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

}  // namespace etendue
