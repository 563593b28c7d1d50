#include "lens/polynomial.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace etendue {

namespace {

/// powers[v][i]: the power i of variable v in every lane but lane 1 + v, which holds its
/// derivative; the last variable, the wavelength, has no such lane.
template <class T, int Lanes, int Variables>
using PowerTables = std::array<std::array<Batch<T, Lanes>, mostPower + 1>, Variables>;

/// 1 in lane `lane`, 0 elsewhere; built by no single element, for a vector read after that waits.
template <class T, int Lanes>
Batch<T, Lanes> unitLane(int lane) {
    return (Batch<T, Lanes>::LinSpaced(T(0), T(Lanes - 1)) == static_cast<T>(lane))
        .template cast<T>();
}

template <class T, int Lanes, int Variables>
struct UnitLanes {
    std::array<Batch<T, Lanes>, Variables> derivative, power;
    UnitLanes() {
        for (int v = 0; v < Variables; ++v) {
            Batch<T, Lanes> unit = Batch<T, Lanes>::Zero();
            if (v + 1 < Variables) unit = unitLane<T, Lanes>(1 + v);
            derivative[static_cast<std::size_t>(v)] = unit;
            power[static_cast<std::size_t>(v)] = T(1) - unit;
        }
    }
};

template <class T, int Lanes, int Variables>
void tabulate(const T* variables, const Exponents& highest,
              PowerTables<T, Lanes, Variables>& powers) {
    static const UnitLanes<T, Lanes, Variables> start;
    for (std::size_t v = 0; v < Variables; ++v) {
        const Batch<T, Lanes> derivative = start.derivative[v];
        Batch<T, Lanes> power = start.power[v];
        powers[v][0] = power;
        T value = T(1);
        for (std::size_t i = 1; i <= highest[v]; ++i) {
            power = power * variables[v] + derivative * value;
            value *= variables[v];
            powers[v][i] = power;
        }
    }
}

/// sums[o] += Σ coefficient × monomial, in every lane.
template <int Outputs, class T, int Lanes, int Variables>
void sweep(const std::vector<Exponents>& terms, const T* coefficients,
           const PowerTables<T, Lanes, Variables>& powers, Batch<T, Lanes>* sums) {
    std::array<Batch<T, Lanes>, Outputs> local;
    local.fill(Batch<T, Lanes>::Zero());
    for (const Exponents& e : terms) {
        Batch<T, Lanes> monomial = powers[0][e[0]] * powers[1][e[1]];
        Batch<T, Lanes> rest = powers[2][e[2]] * powers[3][e[3]];
        if constexpr (Variables == 5) rest *= powers[4][e[4]];
        monomial *= rest;
        for (std::size_t o = 0; o < Outputs; ++o) local[o] += coefficients[o] * monomial;
        coefficients += Outputs;
    }
    std::copy(local.begin(), local.end(), sums);
}

/// sweep<count>.
template <class T, int Lanes, int Variables>
void sweepAny(std::size_t count, const std::vector<Exponents>& terms, const T* coefficients,
              const PowerTables<T, Lanes, Variables>& powers, Batch<T, Lanes>* sums) {
    using Sweep = void (*)(const std::vector<Exponents>&, const T*,
                           const PowerTables<T, Lanes, Variables>&, Batch<T, Lanes>*);
    static constexpr auto sweeps = []<std::size_t... i>(std::index_sequence<i...>) {
        return std::array<Sweep, sizeof...(i)>{
            &sweep<static_cast<int>(i + 1), T, Lanes, Variables>...};
    }
    (std::make_index_sequence<mostOutputs>());
    sweeps[count - 1](terms, coefficients, powers, sums);
}

/// From derivatives by the scaled inputs to those by the inputs.
template <class T>
void unscale(const InputScaling& scaling, std::array<T, 4>& row) {
    for (std::size_t i = 0; i < 2; ++i) {
        row[2 + i] *= static_cast<T>(scaling.secondScale);
        row[i] = row[i] * static_cast<T>(scaling.sensorScale) +
                 row[2 + i] * static_cast<T>(scaling.coupling[static_cast<Eigen::Index>(i)]);
    }
}

/// Vectors B s + C p and scalars of the axial basis from their coefficient functions, whose lanes
/// are the value and the derivatives by ρ, σ and κ.
template <class T>
void composeAxial(const Batch<T, 4>* sums, OutputCount outputs, const AxialChain<T>& chain,
                  const T* in, PolynomialResult<T>& result) {
    using Row = Batch<T, 4>;
    const Row s = in[0] * chain.even + in[1] * chain.odd;
    const Row p = in[2] * chain.even + in[3] * chain.odd;
    const Row rho = T(2) * s * chain.sByInputs, sigma = T(2) * p * chain.pByInputs;
    const Row kappa = p * chain.sByInputs + s * chain.pByInputs;
    const auto gradient = [&](const Row& sum) -> Row {
        return sum[1] * rho + sum[2] * sigma + sum[3] * kappa;
    };
    const auto store = [&](std::size_t row, const Row& derivatives) {
        Eigen::Map<Row>(result.jacobian[row].data()) = derivatives;
    };
    for (int v = 0; v < outputs.vectors; ++v) {
        const Row &b = sums[2 * v], &c = sums[2 * v + 1];
        const Row bGradient = gradient(b), cGradient = gradient(c);
        for (std::size_t i = 0; i < 2; ++i) {
            const std::size_t row = static_cast<std::size_t>(2 * v) + i;
            result.values[row] = b[0] * in[i] + c[0] * in[2 + i];
            store(row, bGradient * in[i] + cGradient * in[2 + i] + b[0] * chain.s[i] +
                           c[0] * chain.p[i]);
        }
    }
    for (int u = 2 * outputs.vectors; u < outputs.total(); ++u)
        result.values[static_cast<std::size_t>(u)] = sums[u][0];
}

/// The scaled inputs of a batch, and w.
template <class T, int Lanes>
std::array<Batch<T, Lanes>, 5> scaledBatch(const InputScaling& scaling,
                                           const BatchInput<T, Lanes>& in) {
    const T ks = static_cast<T>(scaling.sensorScale), kp = static_cast<T>(scaling.secondScale);
    const T cx = static_cast<T>(scaling.coupling.x()), cy = static_cast<T>(scaling.coupling.y());
    const Batch<T, Lanes> inverse = T(1e3) / in.wavelengthNm;
    return {in.sx * ks, in.sy * ks, (in.px + cx * in.sx) * kp, (in.py + cy * in.sy) * kp,
            (inverse * inverse - static_cast<T>(scaling.waveOffset)) *
                static_cast<T>(scaling.waveScale)};
}

/// A monomial, or a sum of them, and its derivatives by ρ, by κ and, if p is coupled to s, by σ:
/// what derivatives by s need.
template <class T, int Lanes, int Parts>
using Parted = std::array<Batch<T, Lanes>, Parts>;

template <class T, int Lanes>
using BatchPowers = std::array<std::array<Batch<T, Lanes>, mostPower + 1>, 4>;

template <class T, int Lanes, int Parts>
Parted<T, Lanes, Parts> monomialBatch(const Exponents& e, const BatchPowers<T, Lanes>& powers,
                                      const BatchPowers<T, Lanes>& derivatives) {
    using Pack = Batch<T, Lanes>;
    const Pack sw = powers[1][e[1]] * powers[3][e[3]];
    Parted<T, Lanes, Parts> m;
    m[0] = powers[0][e[0]] * powers[2][e[2]];
    m[1] = derivatives[0][e[0]] * powers[2][e[2]] * sw;
    m[2] = powers[0][e[0]] * derivatives[2][e[2]] * sw;
    if constexpr (Parts == 4) m[3] = m[0] * derivatives[1][e[1]] * powers[3][e[3]];
    m[0] *= sw;
    return m;
}

/// sums[o] += Σ coefficient × monomial for `Outputs` outputs, in registers; the first `Wanted`
/// parts.
template <int Outputs, int Wanted, class T, int Lanes, int Parts>
void addUp(const Parted<T, Lanes, Parts>* monomials, std::size_t terms, const T* coefficients,
           std::size_t stride, Parted<T, Lanes, Parts>* sums) {
    std::array<Parted<T, Lanes, Wanted>, Outputs> local;
    for (std::size_t o = 0; o < Outputs; ++o)
        std::copy_n(sums[o].begin(), Wanted, local[o].begin());
    for (std::size_t t = 0; t < terms; ++t)
        for (std::size_t o = 0; o < Outputs; ++o)
            for (std::size_t i = 0; i < Wanted; ++i)
                local[o][i] += coefficients[t * stride + o] * monomials[t][i];
    for (std::size_t o = 0; o < Outputs; ++o)
        std::copy(local[o].begin(), local[o].end(), sums[o].begin());
}

template <class T, int Lanes, int Parts>
void sweepBatch(const std::array<Batch<T, Lanes>, 4>& variables, const Exponents& highest,
                const std::vector<Exponents>& terms, const T* coefficients, std::size_t vectorRows,
                std::size_t outputs, std::array<Parted<T, Lanes, Parts>, mostOutputs>& sums) {
    BatchPowers<T, Lanes> powers, derivatives;
    for (std::size_t v = 0; v < 4; ++v) {
        powers[v][0].setOnes();
        derivatives[v][0].setZero();
        for (std::size_t i = 1; i <= highest[v]; ++i) {
            powers[v][i] = powers[v][i - 1] * variables[v];
            derivatives[v][i] = powers[v][i - 1] * static_cast<T>(i);
        }
    }
    for (std::size_t o = 0; o < outputs; ++o)
        for (Batch<T, Lanes>& part : sums[o]) part.setZero();
    constexpr std::size_t chunk = 32;  // of terms, so that they stay in the nearest cache
    std::array<Parted<T, Lanes, Parts>, chunk> monomials;
    for (std::size_t begin = 0; begin < terms.size(); begin += chunk) {
        const std::size_t count = std::min(chunk, terms.size() - begin);
        for (std::size_t t = 0; t < count; ++t)
            monomials[t] = monomialBatch<T, Lanes, Parts>(terms[begin + t], powers, derivatives);
        const T* first = coefficients + begin * outputs;
        for (std::size_t o = 0; o < vectorRows; o += 2)
            addUp<2, Parts, T, Lanes, Parts>(monomials.data(), count, first + o, outputs,
                                             sums.data() + o);
        for (std::size_t o = vectorRows; o < outputs; ++o)
            addUp<1, 1, T, Lanes, Parts>(monomials.data(), count, first + o, outputs,
                                         sums.data() + o);
    }
}

}  // namespace

template <class T>
AxialChain<T>::AxialChain(const InputScaling& scaling) {
    const T ks = static_cast<T>(scaling.sensorScale), kp = static_cast<T>(scaling.secondScale);
    const T kc = static_cast<T>(scaling.secondScale * scaling.coupling.x());
    even << 1, 0, 1, 0;
    odd << 0, 1, 0, 1;
    sByInputs << ks, ks, 0, 0;
    pByInputs << kc, kc, kp, kp;
    s = {sByInputs * even, sByInputs * odd};
    p = {pByInputs * even, pByInputs * odd};
}

template <class T>
PolynomialEvaluator<T>::PolynomialEvaluator(const SparsePolynomial& polynomial)
    : basis_(polynomial.basis),
      outputs_(polynomial.outputs),
      scaling_(polynomial.scaling),
      chain_(polynomial.scaling) {
    if (outputs_.total() > mostOutputs || outputs_.vectors > mostVectors)
        throw std::invalid_argument("polynomial: more outputs than can be evaluated together");
    for (const TermGroup& group : polynomial.groups) {
        Group packed{group.outputs, group.terms, {}};
        for (Eigen::Index t = 0; t < group.coefficients.cols(); ++t)
            for (Eigen::Index o = 0; o < group.coefficients.rows(); ++o)
                packed.coefficients.push_back(static_cast<T>(group.coefficients(o, t)));
        for (const Exponents& e : group.terms)
            for (std::size_t v = 0; v < e.size(); ++v) highest_[v] = std::max(highest_[v], e[v]);
        groups_.push_back(std::move(packed));
    }
}

template <class T>
PolynomialResult<T> PolynomialEvaluator<T>::evaluate(const PolynomialInput& input) const {
    PolynomialResult<T> result;
    const Eigen::Matrix<T, 5, 1> in = scaledInput(scaling_, input).template cast<T>();
    if (basis_ == PolynomialBasis::axial) {
        const std::array<T, 4> variables{in[0] * in[0] + in[1] * in[1],
                                         in[2] * in[2] + in[3] * in[3],
                                         in[0] * in[2] + in[1] * in[3], in[4]};
        PowerTables<T, 4, 4> powers;
        tabulate<T, 4, 4>(variables.data(), highest_, powers);
        std::array<Batch<T, 4>, mostOutputs> sums;
        const Group& group = groups_.front();
        sweepAny<T, 4, 4>(group.outputs.size(), group.terms, group.coefficients.data(), powers,
                          sums.data());
        composeAxial(sums.data(), outputs_, chain_, in.data(), result);
    } else {
        PowerTables<T, 8, 5> powers;
        tabulate<T, 8, 5>(in.data(), highest_, powers);
        std::array<Batch<T, 8>, mostOutputs> sums;
        for (const Group& group : groups_) {
            sweepAny<T, 8, 5>(group.outputs.size(), group.terms, group.coefficients.data(), powers,
                              sums.data());
            for (std::size_t o = 0; o < group.outputs.size(); ++o) {
                const std::size_t row = static_cast<std::size_t>(group.outputs[o]);
                result.values[row] = sums[o][0];
                if (row >= 2 * static_cast<std::size_t>(outputs_.vectors)) continue;
                for (std::size_t j = 0; j < 4; ++j)
                    result.jacobian[row][j] = sums[o][static_cast<Eigen::Index>(j + 1)];
                unscale(scaling_, result.jacobian[row]);
            }
        }
    }
    return result;
}

template <class T>
PolynomialValues<T> PolynomialEvaluator<T>::values(const PolynomialInput& input) const {
    return evaluate(input).values;
}

template <class T>
PolynomialBySensor<T> PolynomialEvaluator<T>::evaluateBySensor(const PolynomialInput& input) const {
    const PolynomialResult<T> all = evaluate(input);
    PolynomialBySensor<T> result;
    result.values = all.values;
    for (std::size_t row = 0; row < all.jacobian.size(); ++row)
        result.bySensor[row] = {all.jacobian[row][0], all.jacobian[row][1]};
    return result;
}

template <class T>
template <int Lanes>
PolynomialBySensor<Batch<T, Lanes>> PolynomialEvaluator<T>::evaluateBySensor(
    const BatchInput<T, Lanes>& input) const {
    if (basis_ != PolynomialBasis::axial)
        throw std::invalid_argument("polynomial: batches are for the axial basis");
    return scaling_.coupling.x() == 0.0 ? evaluateParts<Lanes, 3>(input)
                                        : evaluateParts<Lanes, 4>(input);
}

template <class T>
template <int Lanes, int Parts>
PolynomialBySensor<Batch<T, Lanes>> PolynomialEvaluator<T>::evaluateParts(
    const BatchInput<T, Lanes>& input) const {
    using Pack = Batch<T, Lanes>;
    const std::array<Pack, 5> in = scaledBatch(scaling_, input);
    const std::array<Pack, 4> variables{in[0] * in[0] + in[1] * in[1],
                                        in[2] * in[2] + in[3] * in[3],
                                        in[0] * in[2] + in[1] * in[3], in[4]};
    const Group& group = groups_.front();
    const std::size_t count = group.outputs.size();
    std::array<Parted<T, Lanes, Parts>, mostOutputs> sums;
    const std::size_t vectors = static_cast<std::size_t>(outputs_.vectors);
    sweepBatch<T, Lanes, Parts>(variables, highest_, group.terms, group.coefficients.data(),
                                2 * vectors, count, sums);
    PolynomialBySensor<Batch<T, Lanes>> result;
    const T ks = static_cast<T>(scaling_.sensorScale);
    const T kc = static_cast<T>(scaling_.secondScale * scaling_.coupling.x());
    // How a coefficient function changes with s in millimetres.
    const auto bySensor = [&](const Parted<T, Lanes, Parts>& sum, std::size_t j) -> Pack {
        Pack slope = (T(2) * in[j] * sum[1] + in[2 + j] * sum[2]) * ks;
        if constexpr (Parts == 4) slope += (T(2) * in[2 + j] * sum[3] + in[j] * sum[2]) * kc;
        return slope;
    };
    for (std::size_t v = 0; v < vectors; ++v) {
        const Parted<T, Lanes, Parts>&b = sums[2 * v], &c = sums[2 * v + 1];
        for (std::size_t j = 0; j < 2; ++j) {
            const Pack bByS = bySensor(b, j), cByS = bySensor(c, j);
            for (std::size_t i = 0; i < 2; ++i)
                result.bySensor[2 * v + i][j] = bByS * in[i] + cByS * in[2 + i];
            result.bySensor[2 * v + j][j] += b[0] * ks + c[0] * kc;
            result.values[2 * v + j] = b[0] * in[j] + c[0] * in[2 + j];
        }
    }
    for (std::size_t u = 2 * vectors; u < count; ++u) result.values[u] = sums[u][0];
    return result;
}

template class PolynomialEvaluator<float>;
template class PolynomialEvaluator<double>;
template PolynomialBySensor<Batch<float, 8>> PolynomialEvaluator<float>::evaluateBySensor(
    const BatchInput<float, 8>&) const;
template PolynomialBySensor<Batch<float, 16>> PolynomialEvaluator<float>::evaluateBySensor(
    const BatchInput<float, 16>&) const;
template PolynomialBySensor<Batch<double, 8>> PolynomialEvaluator<double>::evaluateBySensor(
    const BatchInput<double, 8>&) const;

}  // namespace etendue
