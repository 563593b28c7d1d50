// Evaluation at several inputs side by side. The lanes are inputs, and slots come one after
// another, so that a sum stays in registers.
#include "lens/polynomial.h"
#include "lens/polynomial_compose.h"

namespace etendue {

namespace {

/// Two registers of inputs are swept together.
template <class T, int Size>
using InputPack = Pack<T, std::min(Size, 64 / static_cast<int>(sizeof(T)))>;

/// As scaledInput().
template <class Number, class T, int Size>
void scaledInputs(const InputScaling& scaling, const BatchInput<T, Size>& input, int first,
                  Number (&scaled)[5]) {
    const auto all = [](double value) { return Number::all(static_cast<T>(value)); };
    const auto from = [&](const Batch<T, Size>& batch) {
        return Number::load(batch.data() + first);
    };
    const Number s[2] = {from(input.sx), from(input.sy)};
    const Number p[2] = {from(input.px), from(input.py)};
    for (int i = 0; i < 2; ++i) {
        scaled[i] = s[i] * all(scaling.sensorScale);
        scaled[2 + i] = fma(all(scaling.coupling[i]), s[i], p[i]) * all(scaling.secondScale);
    }
    const Number perMicrometre = all(1e3) / from(input.wavelengthNm);
    scaled[4] =
        fma(perMicrometre, perMicrometre, all(-scaling.waveOffset)) * all(scaling.waveScale);
}

}  // namespace

template <class T>
template <int Inputs, int Levels, int Size>
void PolynomialEvaluator<T>::evaluateGroup(const Group& group, const BatchInput<T, Size>& input,
                                           int first, PolynomialValues<Batch<T, Size>>& values,
                                           PolynomialSlopes<Batch<T, Size>, Inputs>& slopes) const {
    using Number = InputPack<T, Size>;
    constexpr int by = derivedLevels(Levels, Inputs);
    Number in[5];
    scaledInputs(scaling_, input, first, in);
    const std::array<Number, Levels> variables = levelVariables<Levels>(in);
    const auto store = [&](int output, int column, const Number& number) {
        const std::size_t row = static_cast<std::size_t>(output);
        if constexpr (Inputs > 0)
            if (column > 0)
                return number.store(slopes[row][static_cast<std::size_t>(column - 1)].data() +
                                    first);
        number.store(values[row].data() + first);
    };
    const auto sum = [&](int slot) {
        return HornerSweep<Lanes::points, T, Number::lanes, 1, 0, by, Levels>(group.scheme, slot,
                                                                              variables)
            .run();
    };
    if (group.hasVectors && Levels == 4) {
        for (int v = 0; v < outputs_.vectors; ++v) {
            const auto b = sum(v), c = sum(mostVectors + v);
            composeVector<Inputs>(
                b.jets[0], c.jets[0], in, factors_,
                [&](int i, int column, const Number& number) { store(2 * v + i, column, number); });
        }
    } else if (group.hasVectors) {
        for (int slot = 0; slot < 4; ++slot) {
            const int output = group.components[static_cast<std::size_t>(slot)];
            if (output < 0) continue;
            composeComponent<Inputs>(
                sum(slot).jets[0], factors_,
                [&](int column, const Number& number) { store(output, column, number); });
        }
    }
    for (int scalar = 0; scalar < group.scalars; ++scalar)
        store(group.firstScalar + scalar, 0,
              HornerSweep<Lanes::points, T, Number::lanes, 0, 1, 0, Levels>(
                  group.scheme, scalar + (group.hasVectors ? 4 : 0), variables)
                  .run()
                  .values[0]);
}

template <class T>
template <int Inputs, int Size>
void PolynomialEvaluator<T>::evaluateBatch(const BatchInput<T, Size>& input,
                                           PolynomialValues<Batch<T, Size>>& values,
                                           PolynomialSlopes<Batch<T, Size>, Inputs>& slopes) const {
    for (const Group& group : groups_)
        for (int first = 0; first < Size; first += InputPack<T, Size>::lanes) {
            if (basis_ == PolynomialBasis::axial)
                evaluateGroup<Inputs, 4>(group, input, first, values, slopes);
            else
                evaluateGroup<Inputs, 5>(group, input, first, values, slopes);
        }
}

template <class T>
template <int Size>
PolynomialValues<Batch<T, Size>> PolynomialEvaluator<T>::values(
    const BatchInput<T, Size>& input) const {
    PolynomialValues<Batch<T, Size>> result;
    PolynomialSlopes<Batch<T, Size>, 0> none;
    evaluateBatch<0>(input, result, none);
    return result;
}

template <class T>
template <int Size>
PolynomialBySensor<Batch<T, Size>> PolynomialEvaluator<T>::evaluateBySensor(
    const BatchInput<T, Size>& input) const {
    PolynomialBySensor<Batch<T, Size>> result;
    if (scaling_.coupling.isZero(0.0)) {
        evaluateBatch<2>(input, result.values, result.bySensor);
        return result;
    }
    return bySensorOf(evaluate(input));
}

template <class T>
template <int Size>
PolynomialResult<Batch<T, Size>> PolynomialEvaluator<T>::evaluate(
    const BatchInput<T, Size>& input) const {
    PolynomialResult<Batch<T, Size>> result;
    evaluateBatch<4>(input, result.values, result.jacobian);
    return result;
}

#define ETENDUE_INSTANTIATE(T, Size)                                                      \
    template PolynomialValues<Batch<T, Size>> PolynomialEvaluator<T>::values(             \
        const BatchInput<T, Size>&) const;                                                \
    template PolynomialBySensor<Batch<T, Size>> PolynomialEvaluator<T>::evaluateBySensor( \
        const BatchInput<T, Size>&) const;                                                \
    template PolynomialResult<Batch<T, Size>> PolynomialEvaluator<T>::evaluate(           \
        const BatchInput<T, Size>&) const;
ETENDUE_INSTANTIATE(float, 8)
ETENDUE_INSTANTIATE(float, 16)
ETENDUE_INSTANTIATE(double, 8)
ETENDUE_INSTANTIATE(double, 16)

}  // namespace etendue
