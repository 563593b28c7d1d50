#include "lens/polynomial_basis.h"

namespace etendue {

namespace {

std::vector<int> range(int begin, int end, int stride = 1) {
    std::vector<int> result;
    for (int i = begin; i < end; i += stride) result.push_back(i);
    return result;
}

std::vector<Exponents> axialTerms(int degree) {
    std::vector<Exponents> terms;
    for (int invariants = 0; 2 * invariants + 1 <= degree; ++invariants)
        for (int i = invariants; i >= 0; --i)
            for (int j = invariants - i; j >= 0; --j)
                for (int l = 0; 2 * invariants + 1 + l <= degree; ++l)
                    terms.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j),
                                     static_cast<std::uint8_t>(invariants - i - j),
                                     static_cast<std::uint8_t>(l), 0});
    return terms;
}

/// Whether a power is allowed in x and px together, and in y and py together.
enum class Parity { any, even, odd };

bool fits(Parity parity, int power) {
    return parity == Parity::any || (parity == Parity::odd) == (power % 2 == 1);
}

std::vector<Exponents> cartesianTerms(int degree, Parity inX, Parity inY) {
    std::vector<Exponents> terms;
    Exponents e{};
    const auto fill = [&](const auto& self, std::size_t variable, int left) -> void {
        if (variable == e.size()) {
            if (fits(inX, e[0] + e[2]) && fits(inY, e[1] + e[3])) terms.push_back(e);
            return;
        }
        for (int power = 0; power <= left; ++power) {
            e[variable] = static_cast<std::uint8_t>(power);
            self(self, variable + 1, left - power);
        }
        e[variable] = 0;
    };
    fill(fill, 0, degree);
    return terms;
}

double monomial(const Exponents& exponents, const Eigen::Matrix<double, 5, 1>& variables) {
    double product = 1.0;
    for (std::size_t i = 0; i < exponents.size(); ++i)
        for (int power = 0; power < exponents[i]; ++power)
            product *= variables[static_cast<Eigen::Index>(i)];
    return product;
}

}  // namespace

std::string_view basisName(PolynomialBasis basis) {
    switch (basis) {
        case PolynomialBasis::axial:
            return "axial";
        case PolynomialBasis::twoPlane:
            return "two-plane";
        case PolynomialBasis::cartesian:
            return "cartesian";
        case PolynomialBasis::none:
            return "none";
    }
    return "";
}

std::vector<TermGroup> candidateTerms(PolynomialBasis basis, int degree, OutputCount outputs) {
    const int vectorEnd = 2 * outputs.vectors, end = outputs.total();
    switch (basis) {
        case PolynomialBasis::axial:
            return {{range(0, end), axialTerms(degree), {}}};
        case PolynomialBasis::none:
            return {{range(0, end), cartesianTerms(degree, Parity::any, Parity::any), {}}};
        case PolynomialBasis::twoPlane:
        case PolynomialBasis::cartesian:
            break;
    }
    std::vector<TermGroup> groups{
        {range(0, vectorEnd, 2), cartesianTerms(degree, Parity::odd, Parity::even), {}},
        {range(1, vectorEnd, 2), cartesianTerms(degree, Parity::even, Parity::odd), {}},
        {range(vectorEnd, end), cartesianTerms(degree, Parity::even, Parity::even), {}}};
    std::erase_if(groups, [](const TermGroup& group) { return group.outputs.empty(); });
    if (basis == PolynomialBasis::twoPlane) return groups;
    std::vector<TermGroup> single;
    for (const TermGroup& group : groups)
        for (const int output : group.outputs) single.push_back({{output}, group.terms, {}});
    return single;
}

Eigen::Matrix<double, 5, 1> basisVariables(PolynomialBasis basis, const ScaledInput& input) {
    if (basis != PolynomialBasis::axial) return input;
    const Eigen::Vector2d s = input.segment<2>(0), p = input.segment<2>(2);
    return {s.squaredNorm(), p.squaredNorm(), s.dot(p), input[4], 0.0};
}

Eigen::VectorXd evaluateNaively(const SparsePolynomial& polynomial, const PolynomialInput& input) {
    const ScaledInput scaled = scaledInput(polynomial.scaling, input);
    const Eigen::Matrix<double, 5, 1> variables = basisVariables(polynomial.basis, scaled);
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(polynomial.outputs.total());
    for (const TermGroup& group : polynomial.groups)
        for (std::size_t t = 0; t < group.terms.size(); ++t) {
            const double m = monomial(group.terms[t], variables);
            for (std::size_t i = 0; i < group.outputs.size(); ++i)
                sums[group.outputs[i]] += m * group.coefficients(static_cast<Eigen::Index>(i),
                                                                 static_cast<Eigen::Index>(t));
        }
    if (polynomial.basis == PolynomialBasis::axial)
        for (int v = 0; v < polynomial.outputs.vectors; ++v) {
            const Eigen::Vector2d vector =
                sums[2 * v] * scaled.segment<2>(0) + sums[2 * v + 1] * scaled.segment<2>(2);
            sums.segment<2>(2 * v) = vector;
        }
    return sums;
}

int multiplyAdds(const SparsePolynomial& polynomial) {
    int count = 0;
    for (const TermGroup& group : polynomial.groups)
        count += static_cast<int>(group.terms.size() * (1 + group.outputs.size()));
    if (polynomial.basis == PolynomialBasis::axial) count += 4 * polynomial.outputs.vectors;
    return count;
}

}  // namespace etendue
