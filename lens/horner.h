// HornerScheme: a sparse polynomial as nested Horner schemes, one level for each variable, with its
// derivatives carried along.
//
//     Σᵢ xⁱ (Σⱼ yʲ (Σₖ zᵏ cᵢⱼₖ)),   each sum as (…(a₃ x + a₂) x + a₁) x + a₀
//
// No power and no monomial is ever formed, and a derivative costs one more multiply-add from the
// level of its variable outward: none in the levels within, where most of the terms are. Powers
// that are missing among those of a sum are there with zeros, or skipped (hasGaps).
//
// Several polynomials on one support are summed together. Each has a slot in the coefficients of a
// term.
#pragma once

#include <cstdint>
#include <vector>

#include "lens/horner_sweep.h"
#include "lens/polynomial_basis.h"

namespace etendue {

template <class T>
struct HornerScheme {
    /// `order`: which exponent is whose of the levels, outermost first. `coefficients`: a row for
    /// each slot, a column for each term.
    HornerScheme(const std::vector<Exponents>& terms, const Eigen::MatrixXd& coefficients,
                 const std::vector<std::size_t>& order);

    HornerTerms<T> terms() const { return {counts.data(), coefficients.data(), slots}; }

    std::size_t slots;
    /// Of the powers of each sum, in the order of evaluation. With gaps: after each power, its
    /// distance from the next, or from zero.
    std::vector<std::uint8_t> counts;
    std::vector<T> coefficients;  // [term][slot]
};

}  // namespace etendue
