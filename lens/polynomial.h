// PolynomialEvaluator: a SparsePolynomial made ready to be evaluated millions of times, one input
// at a time or several side by side; value and exact derivatives in one sweep over the monomials.
//
// Powers of the basis' variables are tabulated once per input. Each entry of a table holds the
// power and its derivative, so that the product of one entry per variable is the monomial beside
// all of its partial derivatives.
#pragma once

#include "lens/polynomial_basis.h"

namespace etendue {

constexpr int mostVectors = 2, mostOutputs = 10;

/// `Lanes` numbers side by side.
template <class T, int Lanes>
using Batch = Eigen::Array<T, Lanes, 1>;

template <class T, int Lanes>
struct BatchInput {
    Batch<T, Lanes> sx, sy, px, py, wavelengthNm;
};

/// Number is float, double or a Batch of them. Only the polynomial's own outputs are filled.
template <class Number>
using PolynomialValues = std::array<Number, mostOutputs>;

/// Besides the values, the derivatives of the vectors' components by s.x and s.y, p held fixed.
template <class Number>
struct PolynomialBySensor {
    PolynomialValues<Number> values;
    std::array<std::array<Number, 2>, 2 * mostVectors> bySensor;
};

/// Besides the values, the derivatives of the vectors' components by s.x, s.y, p.x, p.y.
template <class Number>
struct PolynomialResult {
    PolynomialValues<Number> values;
    std::array<std::array<Number, 4>, 2 * mostVectors> jacobian;
};

/// How the inputs move what the axial basis is made of, as far as that depends on scaling alone.
/// Rows of derivatives by s.x, s.y, p.x, p.y.
template <class T>
struct AxialChain {
    using Row = Batch<T, 4>;
    explicit AxialChain(const InputScaling& scaling);

    Row even, odd;             // masks: x lanes, y lanes
    Row sByInputs, pByInputs;  // of scaled s and p, whichever component the lane moves
    std::array<Row, 2> s, p;   // of their x and y
};

template <class T>
class PolynomialEvaluator {
public:
    /// Throws std::invalid_argument for more than mostOutputs outputs or mostVectors vectors.
    explicit PolynomialEvaluator(const SparsePolynomial& polynomial);

    PolynomialValues<T> values(const PolynomialInput& input) const;
    PolynomialBySensor<T> evaluateBySensor(const PolynomialInput& input) const;
    PolynomialResult<T> evaluate(const PolynomialInput& input) const;
    /// Lanes is 8 or 16. The axial basis only.
    template <int Lanes>
    PolynomialBySensor<Batch<T, Lanes>> evaluateBySensor(const BatchInput<T, Lanes>& input) const;

    OutputCount outputs() const { return outputs_; }

private:
    struct Group {
        std::vector<int> outputs;
        std::vector<Exponents> terms;
        std::vector<T> coefficients;  // [term][output]
    };

    template <int Lanes, int Parts>
    PolynomialBySensor<Batch<T, Lanes>> evaluateParts(const BatchInput<T, Lanes>& input) const;

    PolynomialBasis basis_;
    OutputCount outputs_;
    InputScaling scaling_;
    AxialChain<T> chain_;
    Exponents highest_{};  // power of each variable
    std::vector<Group> groups_;
};

}  // namespace etendue
