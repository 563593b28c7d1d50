// PolynomialEvaluator: a SparsePolynomial made ready to be evaluated millions of times, at one
// input or at several side by side, with exact derivatives.
//
// Nested Horner schemes (horner.h) sum the terms. At one input a register holds the coefficients of
// several outputs; side by side, each output in turn, it holds the inputs.
#pragma once

#include "lens/horner.h"
#include "lens/polynomial_basis.h"

namespace etendue {

constexpr int mostVectors = 2, mostOutputs = 10;

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

/// How scaled inputs grow with inputs: s by `sensor`, p by `second`, and p with s by `coupled`.
template <class T>
struct InputFactors {
    T sensor, second, coupled[2];
};

/// T is float or double; the scaling of a single input is done in double all the same.
template <class T>
class PolynomialEvaluator {
public:
    /// Throws std::invalid_argument for more than mostOutputs outputs or mostVectors vectors.
    explicit PolynomialEvaluator(const SparsePolynomial& polynomial);

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
        bool hasVectors;
        std::array<int, 4> components;  // outputs of the first slots, or -1; not axial
        int firstScalar, scalars;
        HornerScheme<T> scheme;
    };

    Group compile(const TermGroup& group) const;

    template <int Inputs>
    void evaluateOne(const PolynomialInput& input, PolynomialValues<T>& values,
                     PolynomialSlopes<T, Inputs>& slopes) const;
    template <int Inputs, int Levels>
    void evaluateGroup(const Group& group, const std::array<T, 5>& scaled,
                       PolynomialValues<T>& values, PolynomialSlopes<T, Inputs>& slopes) const;
    template <int Inputs, int Levels, int Size>
    void evaluateGroup(const Group& group, const BatchInput<T, Size>& input, int first,
                       PolynomialValues<Batch<T, Size>>& values,
                       PolynomialSlopes<Batch<T, Size>, Inputs>& slopes) const;
    template <int Inputs, int Size>
    void evaluateBatch(const BatchInput<T, Size>& input, PolynomialValues<Batch<T, Size>>& values,
                       PolynomialSlopes<Batch<T, Size>, Inputs>& slopes) const;

    PolynomialBasis basis_;
    OutputCount outputs_;
    InputScaling scaling_;
    InputFactors<T> factors_;
    std::vector<Group> groups_;
};

}  // namespace etendue
