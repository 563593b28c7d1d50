// The monomials from which lens polynomials are chosen, and what a chosen polynomial is.
//
// Inputs are a point s on the sensor (mm), a second pair p (the aperture point in mm, or the slope
// at the sensor) and a wavelength. Outputs are vectors, pairs (x, y) that turn with the lens, and
// scalars: V of the one and U of the other make M = 2V + U outputs, in the order x₁ y₁ x₂ y₂ … u₁
// ….
//
//     basis      variables of a monomial m          terms of an output
//     axial      ρ = s·s, σ = p·p, κ = s·p, w       vector: Σ mₜ (bₜ s + cₜ p), scalar: Σ eₜ mₜ
//     twoPlane   x, y, px, py, w; one support for   Σ eₜ mₜ, of the parity in (x, px) and in
//                all x, one for all y, one for all  (y, py) that the mirror planes xz and yz leave
//                scalars
//     cartesian  the same; a support per output     the same: the published form
//     none       the same; one support for all      all monomials
//
// s and p stand for the scaled inputs of InputScaling, about [-1, 1] over the domain. In the axial
// basis outputs turn with the inputs, to rounding, and mirror with them to the last bit.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace etendue {

enum class PolynomialBasis { axial, twoPlane, cartesian, none };
std::string_view basisName(PolynomialBasis basis);

struct PolynomialInput {
    Eigen::Vector2d s, p;
    double wavelengthNm;
};

/// s sensorScale, (p + coupling s) secondScale, and w = waveScale (1/λ² − waveOffset), λ in µm.
/// The coupling takes out of p what a regression on s predicts (x on x, y on y).
struct InputScaling {
    double sensorScale = 1.0, secondScale = 1.0;
    Eigen::Vector2d coupling = {0.0, 0.0};
    double waveScale = 1.0, waveOffset = 0.0;
};

/// x, y, px, py, w.
using ScaledInput = Eigen::Matrix<double, 5, 1>;
inline ScaledInput scaledInput(const InputScaling& scaling, const PolynomialInput& input) {
    ScaledInput result;
    for (Eigen::Index i = 0; i < 2; ++i) {
        result[i] = input.s[i] * scaling.sensorScale;
        result[2 + i] = (input.p[i] + scaling.coupling[i] * input.s[i]) * scaling.secondScale;
    }
    const double perMicrometre = 1e3 / input.wavelengthNm;
    result[4] = scaling.waveScale * (perMicrometre * perMicrometre - scaling.waveOffset);
    return result;
}

/// Powers of the basis' variables; axial monomials have four and leave the fifth at zero.
using Exponents = std::array<std::uint8_t, 5>;
constexpr int mostPower = 15;

/// V and U.
struct OutputCount {
    int vectors, scalars;
    int total() const { return 2 * vectors + scalars; }
    bool operator==(const OutputCount&) const = default;
};

/// Terms that some outputs share. In the axial basis the coefficient rows 2v and 2v + 1 of vector v
/// are its b and c.
struct TermGroup {
    std::vector<int> outputs;
    std::vector<Exponents> terms;
    Eigen::MatrixXd coefficients;  // outputs × terms; empty for candidates
};

/// What a fit finds.
struct SparsePolynomial {
    PolynomialBasis basis = PolynomialBasis::axial;
    OutputCount outputs{};
    InputScaling scaling;
    std::vector<TermGroup> groups;
};

/// All monomials for outputs of degree up to `degree`, in a fixed order; without coefficients. An
/// axial monomial's degree counts 2 for ρ, σ and κ and 1 for w, and leaves 1 for s or p.
std::vector<TermGroup> candidateTerms(PolynomialBasis basis, int degree, OutputCount outputs);

/// The basis' variables at one input.
Eigen::Matrix<double, 5, 1> basisVariables(PolynomialBasis basis, const ScaledInput& input);

/// The outputs, term by term and without any cleverness: what faster evaluators are tested against.
Eigen::VectorXd evaluateNaively(const SparsePolynomial& polynomial, const PolynomialInput& input);

/// Multiply-adds of an evaluation without derivatives: each coefficient, and each monomial as one
/// product of its parent in a table of powers.
int multiplyAdds(const SparsePolynomial& polynomial);

}  // namespace etendue
