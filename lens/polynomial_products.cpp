#include "lens/polynomial_products.h"

#include <algorithm>

namespace etendue {

namespace {

using Slots = Pack<double, 4>;

/// Σ coefficients · first · second. Four sums side by side, so that none waits for itself.
template <class Terms>
Slots sumOf(const Terms& terms, const double* coefficients, const double* first,
            const double* second) {
    constexpr std::size_t lanes = Slots::lanes, together = 4;
    const std::size_t count = terms.size();
    const auto product = [&](std::size_t t) {
        return Slots::all(first[terms[t].first] * second[terms[t].second]);
    };
    const auto coefficient = [&](std::size_t t) { return Slots::load(coefficients + lanes * t); };
    Slots a = Slots::all(0.0), b = a, c = a, d = a;
    std::size_t t = 0;
    for (; t + together <= count; t += together) {
        a = fma(coefficient(t), product(t), a);
        b = fma(coefficient(t + 1), product(t + 1), b);
        c = fma(coefficient(t + 2), product(t + 2), c);
        d = fma(coefficient(t + 3), product(t + 3), d);
    }
    for (; t < count; ++t) a = fma(coefficient(t), product(t), a);
    return (a + b) + (c + d);
}

}  // namespace

std::size_t MonomialPairs::place(int powerOfX, int powerOfP) {
    const auto found = std::find(powers_.begin(), powers_.end(), Power{powerOfX, powerOfP});
    if (found != powers_.end()) return static_cast<std::size_t>(found - powers_.begin());
    // From the even halves up, chains of products would be shorter; most are short anyway.
    const bool byP = powerOfP > 0;
    const std::size_t from = place(powerOfX - (byP ? 0 : 1), powerOfP - (byP ? 1 : 0));
    powers_.push_back({powerOfX, powerOfP});
    steps_.push_back({static_cast<std::uint16_t>(from), byP});
    return steps_.size();
}

void MonomialPairs::evaluate(double x, double p, double* monomials) const {
    monomials[0] = 1.0;
    double* next = monomials + 1;
    for (const Step& step : steps_) *next++ = monomials[step.from] * (step.byP ? p : x);
}

ValueEvaluator::ValueEvaluator(const SparsePolynomial& polynomial) : scaling_(polynomial.scaling) {
    nested_.emplace(polynomial);  // the checks are its
    if (polynomial.basis == PolynomialBasis::axial) return;
    nested_.reset();
    for (const TermGroup& group : polynomial.groups)
        for (std::size_t output = 0; output < group.outputs.size(); output += lanes)
            compile(group, output);
}

void ValueEvaluator::compile(const TermGroup& group, std::size_t firstOutput) {
    const std::size_t count = std::min(lanes, group.outputs.size() - firstOutput);
    Group compiled;
    for (std::size_t i = 0; i < count; ++i)
        compiled.outputs.push_back(group.outputs[firstOutput + i]);
    std::size_t mostW = 0;
    for (const Exponents& term : group.terms) mostW = std::max<std::size_t>(mostW, term[4]);
    compiled.runs.resize(mostW + 1);
    for (std::size_t t = 0; t < group.terms.size(); ++t) {
        const Exponents& term = group.terms[t];
        Run& run = compiled.runs[mostW - term[4]];
        run.terms.push_back({static_cast<std::uint16_t>(first_.place(term[0], term[2])),
                             static_cast<std::uint16_t>(second_.place(term[1], term[3]))});
        for (std::size_t lane = 0; lane < lanes; ++lane)
            run.coefficients.push_back(
                lane < count ? group.coefficients(static_cast<Eigen::Index>(firstOutput + lane),
                                                  static_cast<Eigen::Index>(t))
                             : 0.0);
    }
    groups_.push_back(std::move(compiled));
}

PolynomialValues<double> ValueEvaluator::productValues(const PolynomialInput& input) const {
    // Of a polynomial of degree d at most: (d + 1) (d + 2) / 2.
    constexpr std::size_t most = (mostPower + 1) * (mostPower + 1);
    double first[most], second[most];
    const ScaledInput scaled = scaledInput(scaling_, input);
    first_.evaluate(scaled[0], scaled[2], first);
    second_.evaluate(scaled[1], scaled[3], second);
    const Slots w = Slots::all(scaled[4]);
    PolynomialValues<double> result;
    for (const Group& group : groups_) {
        Slots sum = Slots::all(0.0);
        for (const Run& run : group.runs)
            sum = fma(sum, w, sumOf(run.terms, run.coefficients.data(), first, second));
        for (std::size_t i = 0; i < group.outputs.size(); ++i)
            result[static_cast<std::size_t>(group.outputs[i])] = sum[static_cast<int>(i)];
    }
    return result;
}

}  // namespace etendue
