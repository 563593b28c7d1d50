#include "lens/polynomial.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>

#include "lens/polynomial_products.h"
#include "tests/lens/fitted_lenses.h"

namespace etendue {

namespace {

/// Any polynomial of a basis: every `stride`-th candidate, coefficients at random.
SparsePolynomial somePolynomial(PolynomialBasis basis, OutputCount outputs, std::size_t stride) {
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    SparsePolynomial polynomial{basis, outputs, {0.1, 0.25, {0.3, 0.3}, 0.4, 4.0}, {}};
    for (const TermGroup& candidates : candidateTerms(basis, 7, outputs)) {
        TermGroup group{candidates.outputs, {}, {}};
        for (std::size_t t = 0; t < candidates.terms.size(); t += stride)
            group.terms.push_back(candidates.terms[t]);
        group.coefficients = Eigen::MatrixXd::NullaryExpr(
            static_cast<Eigen::Index>(group.outputs.size()),
            static_cast<Eigen::Index>(group.terms.size()), [&] { return uniform(engine); });
        polynomial.groups.push_back(std::move(group));
    }
    return polynomial;
}

std::vector<PolynomialInput> someInputs(std::size_t count) {
    std::mt19937_64 engine(11);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<PolynomialInput> inputs;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = uniform(engine), y = uniform(engine), px = uniform(engine),
                     py = uniform(engine), w = uniform(engine);
        inputs.push_back({{7.0 * x, 7.0 * y}, {2.0 * px, 2.0 * py}, 550.0 + 150.0 * w});
    }
    return inputs;
}

constexpr PolynomialBasis allBases[] = {PolynomialBasis::axial, PolynomialBasis::twoPlane,
                                        PolynomialBasis::cartesian, PolynomialBasis::none};

/// A bound on the sum of a polynomial's terms, which rounding errors are relative to.
double sizeOf(const SparsePolynomial& polynomial, const PolynomialInput& input) {
    SparsePolynomial positive = polynomial;
    for (TermGroup& group : positive.groups) group.coefficients = group.coefficients.cwiseAbs();
    PolynomialInput outward = input;
    outward.s = input.s.cwiseAbs();
    outward.p = input.p.cwiseAbs();
    outward.wavelengthNm = 400.0;  // where |w| is largest
    return evaluateNaively(positive, outward).cwiseAbs().maxCoeff();
}

Eigen::Matrix2d rotation(double angle) {
    Eigen::Matrix2d matrix;
    matrix << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    return matrix;
}

}  // namespace

TEST_CASE("Candidates: as many as the combinatorics of degree and parity say") {
    // N(11) of five variables; of an axial basis of degree 3, by hand: 1, w, w², ρ, σ, κ.
    CHECK(candidateTerms(PolynomialBasis::none, 11, {2, 1}).front().terms.size() == 4368);
    CHECK(candidateTerms(PolynomialBasis::none, 4, {2, 1}).front().terms.size() == 126);
    CHECK(candidateTerms(PolynomialBasis::axial, 3, {2, 1}).front().terms.size() == 6);
    // What a Taylor expansion of degree 2, 3 and 4 holds for one component.
    const std::size_t taylor[] = {4, 16, 28};
    for (int degree = 2; degree <= 4; ++degree)
        CHECK(candidateTerms(PolynomialBasis::cartesian, degree, {1, 0}).front().terms.size() ==
              taylor[degree - 2]);
    CHECK(candidateTerms(PolynomialBasis::twoPlane, 5, {2, 1}).size() == 3);
    CHECK(candidateTerms(PolynomialBasis::cartesian, 5, {2, 1}).size() == 5);
}

TEST_CASE("PolynomialEvaluator: the values are those of the terms added up one by one") {
    for (const PolynomialBasis basis : allBases) {
        const SparsePolynomial polynomial = somePolynomial(basis, {2, 1}, 5);
        const PolynomialEvaluator<double> inDouble(polynomial);
        const PolynomialEvaluator<float> inFloat(polynomial);
        for (const PolynomialInput& input : someInputs(50)) {
            const Eigen::VectorXd expected = evaluateNaively(polynomial, input);
            const PolynomialResult<double> result = inDouble.evaluate(input);
            const PolynomialResult<float> rounded = inFloat.evaluate(input);
            // A term of degree 7 rounds 20 times at the most, and sums of 200 terms as often.
            const double size = 220.0 * sizeOf(polynomial, input);
            for (int o = 0; o < 5; ++o) {
                const std::size_t i = static_cast<std::size_t>(o);
                CHECK(std::abs(result.values[i] - expected[o]) <= 0x1p-52 * size);
                CHECK(std::abs(static_cast<double>(rounded.values[i]) - expected[o]) <=
                      0x1p-23 * size);
            }
        }
    }
}

TEST_CASE("PolynomialEvaluator: the Jacobian agrees with central differences") {
    for (const PolynomialBasis basis : allBases) {
        const SparsePolynomial polynomial = somePolynomial(basis, {2, 1}, 5);
        const PolynomialEvaluator<double> evaluator(polynomial);
        for (const PolynomialInput& input : someInputs(20)) {
            const PolynomialResult<double> result = evaluator.evaluate(input);
            const double size = sizeOf(polynomial, input);
            for (int j = 0; j < 4; ++j) {
                const double h = j < 2 ? 1e-2 : 4e-3;  // a thousandth of the scaled unit
                const auto at = [&](double steps) {
                    PolynomialInput moved = input;
                    (j < 2 ? moved.s[j] : moved.p[j - 2]) += steps * h;
                    return evaluateNaively(polynomial, moved);
                };
                // The five-point rule: an error of h⁴/30 of a fifth derivative, (1e-3)⁴ 7!/2!/30 of
                // the size in scaled units, below 1e-9; rounding 1e-16/1e-3.
                const Eigen::VectorXd difference =
                    (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h);
                for (int o = 0; o < 4; ++o)
                    CHECK(std::abs(result.jacobian[static_cast<std::size_t>(o)]
                                                  [static_cast<std::size_t>(j)] -
                                   difference[o]) <= 1e-9 * size / (1e3 * h) * 10.0);
            }
        }
    }
}

TEST_CASE("PolynomialEvaluator: each question has the answer of the one that asks for all") {
    for (const PolynomialBasis basis : allBases)
        for (const double coupling : {0.0, 0.3}) {
            SparsePolynomial polynomial = somePolynomial(basis, {2, 1}, 3);
            polynomial.scaling.coupling = {coupling, coupling};
            const PolynomialEvaluator<double> evaluator(polynomial);
            for (const PolynomialInput& input : someInputs(20)) {
                const PolynomialResult<double> all = evaluator.evaluate(input);
                const PolynomialValues<double> values = evaluator.values(input);
                const PolynomialBySensor<double> some = evaluator.evaluateBySensor(input);
                // The same operations on values; derivatives by s of p coupled to s round alike.
                for (std::size_t o = 0; o < 5; ++o) {
                    CHECK(values[o] == all.values[o]);
                    CHECK(some.values[o] == all.values[o]);
                }
                for (std::size_t o = 0; o < 4; ++o)
                    for (std::size_t j = 0; j < 2; ++j)
                        CHECK(some.bySensor[o][j] == all.jacobian[o][j]);
            }
        }
}

TEST_CASE("PolynomialEvaluator: as many vectors and scalars as there may be are told apart") {
    for (const PolynomialBasis basis : allBases)
        for (const OutputCount outputs :
             {OutputCount{0, 1}, OutputCount{0, 4}, OutputCount{0, 10}, OutputCount{1, 0},
              OutputCount{1, 8}, OutputCount{2, 0}, OutputCount{2, 6}}) {
            const SparsePolynomial polynomial = somePolynomial(basis, outputs, 11);
            const PolynomialEvaluator<double> evaluator(polynomial);
            for (const PolynomialInput& input : someInputs(5)) {
                const Eigen::VectorXd expected = evaluateNaively(polynomial, input);
                const PolynomialValues<double> values = evaluator.values(input);
                const PolynomialResult<double> all = evaluator.evaluate(input);
                const double bound = 0x1p-52 * 220.0 * sizeOf(polynomial, input);
                for (int o = 0; o < outputs.total(); ++o) {
                    CHECK(std::abs(values[static_cast<std::size_t>(o)] - expected[o]) <= bound);
                    CHECK(values[static_cast<std::size_t>(o)] ==
                          all.values[static_cast<std::size_t>(o)]);
                }
            }
        }
    SparsePolynomial tooMany;
    tooMany.outputs = {0, mostOutputs + 1};
    CHECK_THROWS_AS(PolynomialEvaluator<double>{tooMany}, std::invalid_argument);
    tooMany.outputs = {mostVectors + 1, 0};
    CHECK_THROWS_AS(PolynomialEvaluator<double>{tooMany}, std::invalid_argument);
}

TEST_CASE("ValueEvaluator: the values are those of the terms added up one by one") {
    for (const PolynomialBasis basis : allBases)
        for (const OutputCount outputs : {OutputCount{0, 1}, OutputCount{0, 10}, OutputCount{1, 0},
                                          OutputCount{1, 8}, OutputCount{2, 1}})
            for (const double coupling : {0.0, 0.3}) {
                SparsePolynomial polynomial = somePolynomial(basis, outputs, 11);
                polynomial.scaling.coupling = {coupling, -coupling};
                const ValueEvaluator evaluator(polynomial);
                for (const PolynomialInput& input : someInputs(10)) {
                    const Eigen::VectorXd expected = evaluateNaively(polynomial, input);
                    const PolynomialValues<double> values = evaluator.values(input);
                    const double bound = 0x1p-52 * 220.0 * sizeOf(polynomial, input);
                    for (int o = 0; o < outputs.total(); ++o)
                        CHECK(std::abs(values[static_cast<std::size_t>(o)] - expected[o]) <= bound);
                }
            }
}

/// T and how many side by side.
template <class T, int size>
struct BatchOf {
    using Number = T;
    static constexpr int count = size;
};

template <class T, int size>
BatchInput<T, size> batchOf(const std::vector<PolynomialInput>& inputs) {
    BatchInput<T, size> batch;
    for (int i = 0; i < size; ++i) {
        const PolynomialInput& input = inputs[static_cast<std::size_t>(i)];
        batch.sx[i] = static_cast<T>(input.s.x());
        batch.sy[i] = static_cast<T>(input.s.y());
        batch.px[i] = static_cast<T>(input.p.x());
        batch.py[i] = static_cast<T>(input.p.y());
        batch.wavelengthNm[i] = static_cast<T>(input.wavelengthNm);
    }
    return batch;
}

TEST_CASE_TEMPLATE("PolynomialEvaluator: a batch gives what single evaluations give", Kind,
                   BatchOf<float, 8>, BatchOf<float, 16>, BatchOf<double, 8>, BatchOf<double, 16>) {
    using T = typename Kind::Number;
    constexpr int count = Kind::count;
    for (const PolynomialBasis basis : allBases)
        for (const double coupling : {0.0, 0.3}) {
            SparsePolynomial polynomial = somePolynomial(basis, {2, 2}, 5);
            polynomial.scaling.coupling = {coupling, coupling};
            const PolynomialEvaluator<T> evaluator(polynomial);
            const PolynomialEvaluator<double> exact(polynomial);
            const std::vector<PolynomialInput> inputs = someInputs(count);
            const BatchInput<T, count> batch = batchOf<T, count>(inputs);
            const PolynomialValues<Batch<T, count>> values = evaluator.values(batch);
            const PolynomialBySensor<Batch<T, count>> some = evaluator.evaluateBySensor(batch);
            const PolynomialResult<Batch<T, count>> all = evaluator.evaluate(batch);
            for (int i = 0; i < count; ++i) {
                const PolynomialInput& input = inputs[static_cast<std::size_t>(i)];
                const PolynomialResult<double> single = exact.evaluate(input);
                // As above, and seven times that for a derivative of degree 7; inputs are rounded
                // too. The scaled unit of s is 10 mm, of p 4 mm.
                const double bound = static_cast<double>(std::numeric_limits<T>::epsilon()) *
                                     220.0 * 7.0 * sizeOf(polynomial, input);
                const auto near = [&](T number, double expected) {
                    return std::abs(static_cast<double>(number) - expected) <= bound;
                };
                for (std::size_t o = 0; o < 6; ++o) {
                    CHECK(near(values[o][i], single.values[o]));
                    CHECK(near(some.values[o][i], single.values[o]));
                    CHECK(near(all.values[o][i], single.values[o]));
                    for (std::size_t j = 0; o < 4 && j < 4; ++j) {
                        CHECK(near(all.jacobian[o][j][i], single.jacobian[o][j]));
                        if (j < 2) CHECK(near(some.bySensor[o][j][i], single.jacobian[o][j]));
                    }
                }
            }
        }
}

TEST_CASE_TEMPLATE("PolynomialEvaluator: registers of either width give the same bits", Kind,
                   BatchOf<float, 8>, BatchOf<float, 16>, BatchOf<double, 8>, BatchOf<double, 16>) {
    using T = typename Kind::Number;
    constexpr int count = Kind::count;
    if (widestRegisters() == VectorRegisters::narrow) {
        MESSAGE("skipped: there are no registers of 64 bytes");
        return;
    }
    for (const PolynomialBasis basis : allBases)
        for (const OutputCount outputs : {OutputCount{2, 2}, OutputCount{1, 8}, OutputCount{0, 10}})
            for (const double coupling : {0.0, 0.3}) {
                SparsePolynomial polynomial = somePolynomial(basis, outputs, 5);
                polynomial.scaling.coupling = {coupling, coupling};
                const PolynomialEvaluator<T> narrow(polynomial, VectorRegisters::narrow);
                const PolynomialEvaluator<T> wide(polynomial, VectorRegisters::wide);
                const BatchInput<T, count> batch = batchOf<T, count>(someInputs(count));
                const auto same = [&](const Batch<T, count>& a, const Batch<T, count>& b) {
                    return std::memcmp(a.data(), b.data(), count * sizeof(T)) == 0;
                };
                const auto values = narrow.values(batch), wideValues = wide.values(batch);
                const auto some = narrow.evaluateBySensor(batch);
                const auto wideSome = wide.evaluateBySensor(batch);
                const auto all = narrow.evaluate(batch), wideAll = wide.evaluate(batch);
                for (std::size_t o = 0; o < static_cast<std::size_t>(outputs.total()); ++o) {
                    CHECK(same(values[o], wideValues[o]));
                    CHECK(same(some.values[o], wideSome.values[o]));
                    CHECK(same(all.values[o], wideAll.values[o]));
                }
                for (std::size_t o = 0; o < static_cast<std::size_t>(2 * outputs.vectors); ++o) {
                    for (std::size_t j = 0; j < 2; ++j)
                        CHECK(same(some.bySensor[o][j], wideSome.bySensor[o][j]));
                    for (std::size_t j = 0; j < 4; ++j)
                        CHECK(same(all.jacobian[o][j], wideAll.jacobian[o][j]));
                }
            }
}

TEST_CASE("PolynomialEvaluator: float loses less than a tenth of a small fit's error") {
    const LensFit fit = fitLens(doubleGauss(), doubleGaussDomain(), smallSettings());
    const PolynomialEvaluator<double> inDouble(fit.exit);
    const PolynomialEvaluator<float> inFloat(fit.exit);
    constexpr int count = 1000;
    double squares = 0.0;  // of the direction's components, which are errors of angle and more
    for (std::uint64_t i = 0; i < count; ++i) {
        const FitQuery query = drawQuery(fit.domain, 31, i);
        const PolynomialInput input{query.sensor.mm, query.aperture.mm, query.wavelengthNm};
        const PolynomialValues<double> exact = inDouble.values(input);
        const PolynomialValues<float> rounded = inFloat.values(input);
        for (const std::size_t o : {std::size_t{2}, std::size_t{3}})
            squares += std::pow(static_cast<double>(rounded[o]) - exact[o], 2.0);
    }
    const double lossMrad = 1e3 * std::sqrt(squares / count);
    CHECK(lossMrad > 0.0);
    CHECK(lossMrad < 0.1 * fit.errors.directionMrad.rms);
}

TEST_CASE("PolynomialEvaluator: in the axial basis vectors turn with the inputs, scalars stay") {
    const SparsePolynomial polynomial = somePolynomial(PolynomialBasis::axial, {2, 1}, 2);
    const PolynomialEvaluator<double> evaluator(polynomial);
    Eigen::Matrix2d mirror = Eigen::Matrix2d::Identity();
    mirror(0, 0) = -1.0;
    for (const PolynomialInput& input : someInputs(20))
        for (const Eigen::Matrix2d& turn : {rotation(0.7), rotation(2.9), mirror}) {
            const PolynomialResult<double> before = evaluator.evaluate(input);
            const PolynomialResult<double> after =
                evaluator.evaluate({turn * input.s, turn * input.p, input.wavelengthNm});
            const double bound = 0x1p-52 * 220.0 * sizeOf(polynomial, input);
            for (std::size_t v = 0; v < 2; ++v) {
                const Eigen::Vector2d expected =
                    turn * Eigen::Vector2d(before.values[2 * v], before.values[2 * v + 1]);
                CHECK(std::abs(after.values[2 * v] - expected.x()) <= bound);
                CHECK(std::abs(after.values[2 * v + 1] - expected.y()) <= bound);
            }
            CHECK(std::abs(after.values[4] - before.values[4]) <= bound);
        }
}

TEST_CASE("PolynomialEvaluator: mirror planes hold to the last bit in the two-plane basis") {
    const SparsePolynomial polynomial = somePolynomial(PolynomialBasis::twoPlane, {1, 1}, 3);
    const PolynomialEvaluator<double> evaluator(polynomial);
    for (const PolynomialInput& input : someInputs(20)) {
        const Eigen::Vector2d mirror(-1.0, 1.0);
        const PolynomialResult<double> before = evaluator.evaluate(input);
        const PolynomialResult<double> after = evaluator.evaluate(
            {input.s.cwiseProduct(mirror), input.p.cwiseProduct(mirror), input.wavelengthNm});
        CHECK(after.values[0] == -before.values[0]);
        CHECK(after.values[1] == before.values[1]);
        CHECK(after.values[2] == before.values[2]);
    }
}

}  // namespace etendue
