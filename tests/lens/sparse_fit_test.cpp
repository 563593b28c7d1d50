#include "lens/sparse_fit.h"

#include <doctest/doctest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>

namespace etendue {

namespace {

std::vector<PolynomialInput> someInputs(std::size_t count) {
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<PolynomialInput> inputs;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = uniform(engine), y = uniform(engine), px = uniform(engine),
                     py = uniform(engine), w = uniform(engine);
        inputs.push_back({{9.0 * x, 6.0 * y}, {5.0 * px, 5.0 * py}, 550.0 + 150.0 * w});
    }
    return inputs;
}

Eigen::MatrixXd valuesOf(const SparsePolynomial& polynomial,
                         const std::vector<PolynomialInput>& inputs) {
    Eigen::MatrixXd values(static_cast<Eigen::Index>(inputs.size()), polynomial.outputs.total());
    for (std::size_t i = 0; i < inputs.size(); ++i)
        values.row(static_cast<Eigen::Index>(i)) =
            evaluateNaively(polynomial, inputs[i]).transpose();
    return values;
}

/// Smooth and no polynomial, and as symmetric as the axial basis: two vectors and a scalar.
Eigen::MatrixXd smoothTargets(const std::vector<PolynomialInput>& inputs) {
    Eigen::MatrixXd targets(static_cast<Eigen::Index>(inputs.size()), 5);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Eigen::Vector2d s = inputs[i].s / 9.0, p = inputs[i].p / 5.0;
        const double w = inputs[i].wavelengthNm / 550.0;
        const Eigen::Vector2d first = s / std::sqrt(1.5 + s.dot(p)) + w * p * std::cos(s.dot(s));
        const Eigen::Vector2d second = s * std::exp(0.3 * p.dot(p)) - p / (2.0 + s.dot(p) * w);
        targets.row(static_cast<Eigen::Index>(i)) << first.transpose(), second.transpose(),
            1.0 / (2.0 + s.dot(s) + 0.5 * p.dot(p) * w);
    }
    return targets;
}

SparsePolynomial fitSmooth(PolynomialBasis basis, const std::vector<PolynomialInput>& inputs,
                           const SparseFitOptions& options, int degree = 7) {
    return fitSparse(basis, {2, 1}, candidateTerms(basis, degree, {2, 1}),
                     scalingFor(basis, inputs, Coupling::fitted), inputs, smoothTargets(inputs),
                     Eigen::VectorXd::Ones(5), options);
}

double residual(const SparsePolynomial& polynomial, const std::vector<PolynomialInput>& inputs) {
    return (valuesOf(polynomial, inputs) - smoothTargets(inputs)).norm();
}

}  // namespace

TEST_CASE("Sparse fit: a polynomial that is sparse is found again") {
    const std::vector<PolynomialInput> inputs = someInputs(800);
    for (const PolynomialBasis basis : {PolynomialBasis::axial, PolynomialBasis::twoPlane}) {
        SparsePolynomial truth{basis, {1, 1}, scalingFor(basis, inputs, Coupling::none), {}};
        const std::vector<TermGroup> candidates = candidateTerms(basis, 6, {1, 1});
        for (const TermGroup& group : candidates) {
            TermGroup few{group.outputs, {}, {}};
            for (const std::size_t t : {std::size_t{1}, group.terms.size() / 3,
                                        group.terms.size() / 2, group.terms.size() - 2})
                few.terms.push_back(group.terms[t]);
            few.coefficients = Eigen::MatrixXd(few.outputs.size(), 4);
            for (Eigen::Index i = 0; i < few.coefficients.rows(); ++i)
                few.coefficients.row(i) << 1.0, -0.7, 0.4 + 0.1 * static_cast<double>(i), 2.0;
            truth.groups.push_back(few);
        }
        const SparsePolynomial found =
            fitSparse(basis, {1, 1}, candidates, truth.scaling, inputs, valuesOf(truth, inputs),
                      Eigen::VectorXd::Ones(3), {8, 3});
        for (std::size_t g = 0; g < truth.groups.size(); ++g)
            for (std::size_t t = 0; t < 4; ++t) {
                const auto& terms = found.groups[g].terms;
                const auto place = std::ranges::find(terms, truth.groups[g].terms[t]);
                REQUIRE(place != terms.end());
                // Rounding of the targets times the condition of a few columns.
                const Eigen::VectorXd difference =
                    found.groups[g].coefficients.col(place - terms.begin()) -
                    truth.groups[g].coefficients.col(static_cast<Eigen::Index>(t));
                CHECK(difference.cwiseAbs().maxCoeff() <= 1e-11);
            }
    }
}

TEST_CASE("Sparse fit: the coefficients are those of least squares on the chosen terms") {
    const std::vector<PolynomialInput> inputs = someInputs(600);
    const SparsePolynomial fit = fitSmooth(PolynomialBasis::cartesian, inputs, {12, 2}, 5);
    const Eigen::MatrixXd targets = smoothTargets(inputs);
    for (const TermGroup& group : fit.groups) {
        Eigen::MatrixXd columns(static_cast<Eigen::Index>(inputs.size()), 12);
        for (Eigen::Index t = 0; t < 12; ++t) {
            SparsePolynomial single{PolynomialBasis::none, {0, 1}, fit.scaling, {}};
            single.groups = {
                {{0}, {group.terms[static_cast<std::size_t>(t)]}, Eigen::MatrixXd::Ones(1, 1)}};
            columns.col(t) = valuesOf(single, inputs);
        }
        const Eigen::VectorXd expected =
            columns.householderQr().solve(targets.col(group.outputs.front()));
        // Both solve with an error of rounding times the condition of the columns, about 1e3.
        CHECK((group.coefficients.row(0).transpose() - expected).norm() <= 1e-11 * expected.norm());
    }
}

TEST_CASE("Sparse fit: no other term would have been a better next one") {
    const std::vector<PolynomialInput> inputs = someInputs(500);
    const auto candidates = candidateTerms(PolynomialBasis::axial, 5, {2, 1});
    const SparsePolynomial few = fitSmooth(PolynomialBasis::axial, inputs, {4, 0}, 5);
    const SparsePolynomial more = fitSmooth(PolynomialBasis::axial, inputs, {5, 0}, 5);
    for (const Exponents& term : candidates.front().terms) {
        SparsePolynomial tried = few;
        auto& terms = tried.groups.front().terms;
        if (std::ranges::find(terms, term) != terms.end()) continue;
        terms.push_back(term);
        tried = refit(tried, inputs, smoothTargets(inputs));
        CHECK(residual(tried, inputs) >= residual(more, inputs) * (1.0 - 1e-9));
    }
}

TEST_CASE("Sparse fit: exchanging terms makes the fit better, and again, and so do more terms") {
    const std::vector<PolynomialInput> inputs = someInputs(600);
    for (const PolynomialBasis basis : {PolynomialBasis::axial, PolynomialBasis::twoPlane}) {
        const double greedy = residual(fitSmooth(basis, inputs, {10, 0}), inputs);
        CHECK(residual(fitSmooth(basis, inputs, {10, 3}), inputs) < 0.9999 * greedy);
        CHECK(residual(fitSmooth(basis, inputs, {20, 0}), inputs) < 0.5 * greedy);
    }
    // What a second exchange finds is more than rounding: 1 %.
    const auto exchanged = [&](int times) {
        return residual(fitSmooth(PolynomialBasis::axial, inputs, {20, times}), inputs);
    };
    CHECK(exchanged(1) < 0.9 * exchanged(0));
    CHECK(exchanged(2) < 0.995 * exchanged(1));
}

TEST_CASE("Sparse fit: what the greedy choice took wrongly is exchanged") {
    const std::vector<PolynomialInput> inputs = someInputs(600);
    const OutputCount outputs{0, 1};
    const InputScaling scaling = scalingFor(PolynomialBasis::none, inputs, Coupling::none);
    const Exponents first{1, 0, 0, 0, 0}, third{3, 0, 0, 0, 0}, fifth{5, 0, 0, 0, 0};
    // x³ looks more like x + 2x⁵ than either of its terms does.
    SparsePolynomial truth{PolynomialBasis::none, outputs, scaling, {{{0}, {first, fifth}, {}}}};
    truth.groups.front().coefficients = Eigen::RowVector2d(1.0, 2.0);
    const auto fit = [&](int refinements) {
        return fitSparse(PolynomialBasis::none, outputs, {{{0}, {first, third, fifth}, {}}},
                         scaling, inputs, valuesOf(truth, inputs), Eigen::VectorXd::Ones(1),
                         {2, refinements});
    };
    CHECK(fit(0).groups.front().terms.front() == third);
    std::vector<Exponents> found = fit(1).groups.front().terms;
    std::ranges::sort(found);
    CHECK(found == truth.groups.front().terms);
}

TEST_CASE("Sparse fit: progress grows to the end") {
    double last = 0.0;
    SparseFitOptions options{10, 2};
    options.progress = [&](double share) {
        CHECK(share >= last);
        CHECK(share <= 1.0);
        last = share;
    };
    fitSmooth(PolynomialBasis::twoPlane, someInputs(400), options, 5);
    CHECK(last > 0.5);
}

TEST_CASE("Sparse fit: the same inputs give the same bits") {
    const std::vector<PolynomialInput> inputs = someInputs(700);
    const SparsePolynomial once = fitSmooth(PolynomialBasis::axial, inputs, {12, 3});
    const SparsePolynomial again = fitSmooth(PolynomialBasis::axial, inputs, {12, 3});
    CHECK(once.groups.front().terms == again.groups.front().terms);
    CHECK(once.groups.front().coefficients == again.groups.front().coefficients);
}

TEST_CASE("Sparse fit: all candidates make the complete polynomial") {
    const std::vector<PolynomialInput> inputs = someInputs(800);
    const SparsePolynomial complete = fitSmooth(PolynomialBasis::none, inputs, {1 << 20, 0}, 3);
    CHECK(complete.groups.front().terms.size() == 56);
    CHECK(residual(complete, inputs) <
          residual(fitSmooth(PolynomialBasis::none, inputs, {20, 0}, 3), inputs));
}

TEST_CASE("Input scaling: s, p and w come to lie in the unit disc and in [-1, 1]") {
    const std::vector<PolynomialInput> inputs = someInputs(300);
    for (const Coupling coupling : {Coupling::none, Coupling::fitted}) {
        const InputScaling scaling = scalingFor(PolynomialBasis::axial, inputs, coupling);
        CHECK(scaling.coupling.x() == scaling.coupling.y());
        double s = 0.0, p = 0.0, w = 0.0;
        for (const PolynomialInput& input : inputs) {
            const ScaledInput scaled = scaledInput(scaling, input);
            s = std::max(s, scaled.segment<2>(0).norm());
            p = std::max(p, scaled.segment<2>(2).norm());
            w = std::max(w, std::abs(scaled[4]));
        }
        CHECK(s == doctest::Approx(1.0).epsilon(1e-14));
        CHECK(p == doctest::Approx(1.0).epsilon(1e-14));
        CHECK(w == doctest::Approx(1.0).epsilon(1e-12));
    }
}

}  // namespace etendue
