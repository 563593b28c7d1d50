// Evaluation at one input. The lanes of a register are slots: what four of them need of a term is
// one multiply-add.
#include <type_traits>

#include "lens/polynomial.h"

namespace etendue {

namespace {

/// The first four slots' sums and their derivatives, `jet`, to the vectors that they stand for.
template <int Inputs, int Levels, class T, std::size_t Columns, class Jet>
[[gnu::always_inline]] inline void storeVectors(
    const Jet& jet, const Pack<T, 4> (&in)[5], const InputFactors<T>& factors, const SlotUse& use,
    PolynomialValues<T>& values, std::array<std::array<T, Columns>, 2 * mostVectors>& slopes) {
    using Slots = Pack<T, 4>;
    constexpr int by = derivedLevels(Levels, Inputs);
    const auto entry = [&](int row, int column) -> T& {
        if constexpr (Inputs > 0)
            if (column > 0)
                return slopes[static_cast<std::size_t>(row)][static_cast<std::size_t>(column - 1)];
        return values[static_cast<std::size_t>(row)];
    };
    if constexpr (Levels == 4) {
        Slots c[1 + by];
        for (int part = 0; part <= by; ++part) c[part] = jet[part].exchanged();
        composeVector<Inputs>(jet, c, in, factors, [&](int i, int column, const Slots& component) {
            // A second vector where there is one; else scalars overwrite it.
            for (int v = 0; v < mostVectors; ++v) entry(2 * v + i, column) = component[v];
        });
    } else {
        composeComponent<Inputs>(jet, factors, [&](int column, const Slots& component) {
            for (int slot = 0; slot < 4; ++slot) {
                const int row = use.components[slot];
                if (row >= 0) entry(row, column) = component[slot];
            }
        });
    }
}

}  // namespace

template <class T>
PolynomialValues<T> PolynomialEvaluator<T>::values(const PolynomialInput& input) const {
    PolynomialValues<T> result;
    PolynomialSlopes<T, 0> none;
    evaluateOne<0>(input, result, none);
    return result;
}

template <class T>
PolynomialBySensor<T> PolynomialEvaluator<T>::evaluateBySensor(const PolynomialInput& input) const {
    PolynomialBySensor<T> result;
    if (scaling_.coupling.isZero(0.0)) {
        evaluateOne<2>(input, result.values, result.bySensor);
        return result;
    }
    return bySensorOf(evaluate(input));
}

template <class T>
PolynomialResult<T> PolynomialEvaluator<T>::evaluate(const PolynomialInput& input) const {
    PolynomialResult<T> result;
    evaluateOne<4>(input, result.values, result.jacobian);
    return result;
}

template <class T>
template <int Inputs>
void PolynomialEvaluator<T>::evaluateOne(const PolynomialInput& input, PolynomialValues<T>& values,
                                         PolynomialSlopes<T, Inputs>& slopes) const {
    const ScaledInput inDouble = scaledInput(scaling_, input);
    std::array<T, 5> scaled;
    for (std::size_t i = 0; i < scaled.size(); ++i)
        scaled[i] = static_cast<T>(inDouble[static_cast<Eigen::Index>(i)]);
    for (const Group& group : groups_) {
        if (basis_ == PolynomialBasis::axial)
            evaluateGroup<Inputs, 4>(group, scaled, values, slopes);
        else
            evaluateGroup<Inputs, 5>(group, scaled, values, slopes);
    }
}

template <class T>
template <int Inputs, int Levels>
void PolynomialEvaluator<T>::evaluateGroup(const Group& group, const std::array<T, 5>& scaled,
                                           PolynomialValues<T>& values,
                                           PolynomialSlopes<T, Inputs>& slopes) const {
    using Slots = Pack<T, 4>;
    const SlotUse& use = group.use;
    constexpr int by = derivedLevels(Levels, Inputs);
    Slots in[5];
    for (std::size_t i = 0; i < scaled.size(); ++i) in[i] = Slots::all(scaled[i]);
    const std::array<Slots, Levels> variables = levelVariables<Levels>(in);
    const auto storeScalars = [&](int first, const Slots& sums) {
        for (int lane = 0; lane < 4; ++lane)
            if (first + lane < use.scalars)
                values[static_cast<std::size_t>(use.firstScalar + first + lane)] = sums[lane];
    };
    const auto store = [&](const auto& jet) {
        storeVectors<Inputs, Levels>(jet, in, factors_, use, values, slopes);
    };
    const auto sweep = [&]<int Jets, int Values>(std::integral_constant<int, Jets>,
                                                 std::integral_constant<int, Values>, int slot) {
        constexpr int derived = Jets == 0 ? 0 : by;
        return HornerSweep<Lanes::slots, Slots, Jets, Values, derived, Levels>(group.scheme.terms(),
                                                                               slot, variables)
            .run();
    };
    constexpr std::integral_constant<int, 0> none;
    constexpr std::integral_constant<int, 1> one;
    constexpr std::integral_constant<int, 2> two;
    int slot = 0, scalar = 0;
    if (use.vectorSlots > 0 && use.scalars > 0) {
        const auto sums = sweep(one, one, slot);
        store(sums.jets[0]);
        storeScalars(scalar, sums.values[0]);
        slot += 8;
        scalar += 4;
    } else if (use.vectorSlots > 0) {
        store(sweep(one, none, slot).jets[0]);
    }
    for (; scalar + 4 < use.scalars; slot += 8, scalar += 8) {
        const auto sums = sweep(none, two, slot);
        storeScalars(scalar, sums.values[0]);
        storeScalars(scalar + 4, sums.values[1]);
    }
    if (scalar < use.scalars) storeScalars(scalar, sweep(none, one, slot).values[0]);
}

// Members alone: the class is instantiated where its constructor is.
template PolynomialValues<float> PolynomialEvaluator<float>::values(const PolynomialInput&) const;
template PolynomialValues<double> PolynomialEvaluator<double>::values(const PolynomialInput&) const;
template PolynomialBySensor<float> PolynomialEvaluator<float>::evaluateBySensor(
    const PolynomialInput&) const;
template PolynomialBySensor<double> PolynomialEvaluator<double>::evaluateBySensor(
    const PolynomialInput&) const;
template PolynomialResult<float> PolynomialEvaluator<float>::evaluate(const PolynomialInput&) const;
template PolynomialResult<double> PolynomialEvaluator<double>::evaluate(
    const PolynomialInput&) const;

}  // namespace etendue
