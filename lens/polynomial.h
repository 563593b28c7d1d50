// PolynomialEvaluator: a SparsePolynomial made ready to be evaluated millions of times, at one
// input or at several side by side, with exact derivatives.
//
// Nested Horner schemes (horner.h) sum the terms. At one input a register holds the coefficients of
// several outputs; side by side, each output in turn, it holds the inputs.
#pragma once

#include "lens/horner.h"
#include "lens/polynomial_basis.h"
#include "lens/polynomial_batch.h"
#include "lens/polynomial_compose.h"

namespace etendue {

constexpr int mostOutputs = 10;

/// `Size` numbers side by side.
template <class T, int Size>
using Batch = Eigen::Array<T, Size, 1>;

template <class T, int Size>
struct BatchInput {
    Batch<T, Size> sx, sy, px, py, wavelengthNm;
};

/// Number is float, double or a Batch of them. Only the polynomial's own outputs are filled.
template <class Number>
using PolynomialValues = std::array<Number, mostOutputs>;

/// Derivatives of the vectors' components, [2v] of x and [2v + 1] of y of vector v.
template <class Number, int Inputs>
using PolynomialSlopes = std::array<std::array<Number, Inputs>, 2 * mostVectors>;

template <class Number>
struct PolynomialBySensor {
    PolynomialValues<Number> values;
    PolynomialSlopes<Number, 2> bySensor;  // by s.x and s.y, p held fixed
};

template <class Number>
struct PolynomialResult {
    PolynomialValues<Number> values;
    PolynomialSlopes<Number, 4> jacobian;  // by s.x, s.y, p.x, p.y
};

template <class Number>
PolynomialBySensor<Number> bySensorOf(const PolynomialResult<Number>& all) {
    PolynomialBySensor<Number> result;
    result.values = all.values;
    for (std::size_t row = 0; row < all.jacobian.size(); ++row)
        result.bySensor[row] = {all.jacobian[row][0], all.jacobian[row][1]};
    return result;
}

/// T is float or double; the scaling of a single input is done in double all the same.
template <class T>
class PolynomialEvaluator {
public:
    /// Throws std::invalid_argument for more than mostOutputs outputs or mostVectors vectors, and
    /// for a polynomial with a fault (fit_check.h).
    /// `registers`: for batches; no wider ones than there are.
    explicit PolynomialEvaluator(const SparsePolynomial& polynomial,
                                 VectorRegisters registers = widestRegisters());

    PolynomialValues<T> values(const PolynomialInput& input) const;
    PolynomialBySensor<T> evaluateBySensor(const PolynomialInput& input) const;
    PolynomialResult<T> evaluate(const PolynomialInput& input) const;

    /// Size is 8 or 16.
    template <int Size>
    PolynomialValues<Batch<T, Size>> values(const BatchInput<T, Size>& input) const;
    template <int Size>
    PolynomialBySensor<Batch<T, Size>> evaluateBySensor(const BatchInput<T, Size>& input) const;
    template <int Size>
    PolynomialResult<Batch<T, Size>> evaluate(const BatchInput<T, Size>& input) const;

    OutputCount outputs() const { return outputs_; }

private:
    /// Polynomials on one support. With vectors, slots 0 to 3 are what needs derivatives: in the
    /// axial basis b₁ b₂ c₁ c₂ of the vectors Σ mₜ (bₜ s + cₜ p), else components of vectors. The
    /// scalars, side by side among the outputs, have the slots from then on.
    struct Group {
        SlotUse use;
        HornerScheme<T> scheme;
    };

    Group compile(const TermGroup& group) const;

    template <int Inputs>
    void evaluateOne(const PolynomialInput& input, PolynomialValues<T>& values,
                     PolynomialSlopes<T, Inputs>& slopes) const;
    template <int Inputs, int Levels>
    void evaluateGroup(const Group& group, const std::array<T, 5>& scaled,
                       PolynomialValues<T>& values, PolynomialSlopes<T, Inputs>& slopes) const;
    template <int Inputs, int Size>
    void evaluateBatch(const BatchInput<T, Size>& input, PolynomialValues<Batch<T, Size>>& values,
                       PolynomialSlopes<Batch<T, Size>, Inputs>& slopes) const;

    PolynomialBasis basis_;
    OutputCount outputs_;
    InputScaling scaling_;
    InputFactors<T> factors_;
    std::vector<Group> groups_;
    VectorRegisters registers_;
};

}  // namespace etendue
