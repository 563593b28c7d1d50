// Evaluation at several inputs side by side.
#include "lens/polynomial.h"
#include "lens/polynomial_batch_kernel.h"

namespace etendue {

VectorRegisters widestRegisters() {
#ifdef ETENDUE_WIDE_REGISTERS
    if (__builtin_cpu_supports("avx512f")) return VectorRegisters::wide;
#endif
    return VectorRegisters::narrow;
}

template <class T>
template <int Inputs, int Size>
void PolynomialEvaluator<T>::evaluateBatch(const BatchInput<T, Size>& input,
                                           PolynomialValues<Batch<T, Size>>& values,
                                           PolynomialSlopes<Batch<T, Size>, Inputs>& slopes) const {
    static_assert(sizeof(input) == 5 * Size * sizeof(T) &&
                  sizeof(values) == mostOutputs * Size * sizeof(T));
    static_assert(Inputs == 0 || sizeof(slopes) == 2 * mostVectors * Inputs * Size * sizeof(T));
    for (const Group& group : groups_) {
        const BatchTask<T> task{
            group.use,
            group.scheme.terms(),
            basis_ == PolynomialBasis::axial,
            outputs_.vectors,
            factors_,
            {static_cast<T>(scaling_.coupling.x()), static_cast<T>(scaling_.coupling.y())},
            static_cast<T>(scaling_.waveScale),
            static_cast<T>(scaling_.waveOffset),
            reinterpret_cast<const T*>(&input),
            reinterpret_cast<T*>(&values),
            reinterpret_cast<T*>(&slopes)};
#ifdef ETENDUE_WIDE_REGISTERS
        if (registers_ == VectorRegisters::wide) {
            evaluateWide<T, Size, Inputs>(task);
            continue;
        }
#endif
        evaluateInRegisters<32, T, Size, Inputs>(task);
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
