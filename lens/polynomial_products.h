// ValueEvaluator: a SparsePolynomial's values at one input, where no derivatives are asked for.
//
// In the axial basis it is the nested schemes of PolynomialEvaluator. In the others, of five
// variables, sums within sums are so short that leaving one costs more than the terms in it: there
// each term is the product of a monomial in (x, px) and one in (y, py) from two tables, and its
// coefficients times that are added up in one run for each power of w.
#pragma once

#include <optional>

#include "lens/polynomial.h"

namespace etendue {

/// Monomials x^i p^j of two variables, each a variable times one that comes before it.
class MonomialPairs {
public:
    /// The place of a monomial, which is taken up if it is not there yet.
    std::size_t place(int powerOfX, int powerOfP);
    /// monomials[i] = the value of the one at place i; there is room for size().
    void evaluate(double x, double p, double* monomials) const;
    std::size_t size() const { return steps_.size() + 1; }

private:
    struct Power {
        int x, p;
        bool operator==(const Power&) const = default;
    };
    struct Step {
        std::uint16_t from;
        bool byP;
    };
    std::vector<Power> powers_{{0, 0}};
    std::vector<Step> steps_;  // [place − 1]
};

class ValueEvaluator {
public:
    /// Throws as PolynomialEvaluator does.
    explicit ValueEvaluator(const SparsePolynomial& polynomial);

    PolynomialValues<double> values(const PolynomialInput& input) const {
        return nested_ ? nested_->values(input) : productValues(input);
    }

private:
    static constexpr std::size_t lanes = 4;

    struct Term {
        std::uint16_t first, second;  // places in the tables
    };
    /// Terms of the same power of w.
    struct Run {
        std::vector<Term> terms;
        std::vector<double> coefficients;  // [term][output of the group], to `lanes` of them
    };
    /// Up to `lanes` outputs on one support.
    struct Group {
        std::vector<int> outputs;
        std::vector<Run> runs;  // from the highest power of w down to zero
    };

    void compile(const TermGroup& group, std::size_t firstOutput);
    PolynomialValues<double> productValues(const PolynomialInput& input) const;

    std::optional<PolynomialEvaluator<double>> nested_;
    InputScaling scaling_;
    MonomialPairs first_, second_;
    std::vector<Group> groups_;
};

}  // namespace etendue
