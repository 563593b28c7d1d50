// The evaluation of a BatchTask, for the sources that compile it for their registers. The lanes are
// inputs, and slots come one after another, so that a sum stays in registers.
#pragma once

#include "lens/polynomial_batch.h"

namespace etendue {

/// As scaledInput().
template <class Number, class T, int Size>
[[gnu::always_inline]] inline void scaledInputs(const BatchTask<T>& task, int first,
                                                Number (&scaled)[5]) {
    Number in[5];  // s, p, λ
    for (int i = 0; i < 5; ++i) in[i] = Number::load(task.inputs + i * Size + first);
    for (int i = 0; i < 2; ++i) {
        scaled[i] = in[i] * Number::all(task.factors.sensor);
        scaled[2 + i] =
            fma(Number::all(task.coupling[i]), in[i], in[2 + i]) * Number::all(task.factors.second);
    }
    const Number perMicrometre = Number::all(T(1e3)) / in[4];
    scaled[4] = fma(perMicrometre, perMicrometre, Number::all(-task.waveOffset)) *
                Number::all(task.waveScale);
}

/// The inputs from `first` on that fit in a Number.
template <class Number, class T, int Size, int Inputs, int Levels>
void evaluateLanes(const BatchTask<T>& task, int first) {
    constexpr int by = derivedLevels(Levels, Inputs);
    // Slots whose sums fit, with a scalar's, in 32 registers of 64 bytes; groups that are not axial
    // may have but one.
    constexpr bool areMany = Levels == 4 && Number::registerBytes == 64;
    constexpr int together = !areMany ? 1 : by > 2 ? 2 : 4;
    Number in[5];
    scaledInputs<Number, T, Size>(task, first, in);
    const std::array<Number, Levels> variables = levelVariables<Levels>(in);
    const auto store = [&](int output, int column, const Number& number) {
        T* const row = column > 0 ? task.slopes + (output * Inputs + column - 1) * Size
                                  : task.values + output * Size;
        number.store(row + first);
    };
    const SlotUse& use = task.use;
    Number sums[4][1 + by];
    int scalar = 0;  // the next
    const auto sweep = [&]<int Jets, int Values>(std::integral_constant<int, Jets>,
                                                 std::integral_constant<int, Values>, int slot) {
        constexpr int derived = Jets == 0 ? 0 : by;
        const auto part = HornerSweep<Lanes::points, Number, Jets, Values, derived, Levels>(
                              task.terms, slot, variables)
                              .run();
        if constexpr (Jets > 0) std::memcpy(sums[slot], part.jets, sizeof(part.jets));
        if constexpr (Values > 0) store(use.firstScalar + scalar++, 0, part.values[0]);
    };
    constexpr std::integral_constant<int, 0> none;
    constexpr std::integral_constant<int, 1> one;
    constexpr std::integral_constant<int, together> some;
    if (use.vectorSlots > 0) {
        int slot = 0;
        for (; slot + together < use.vectorSlots; slot += together) sweep(some, none, slot);
        if (areMany && use.scalars > 0)
            sweep(some, one, slot);
        else
            sweep(some, none, slot);
        if constexpr (Levels == 4) {
            for (int v = 0; v < task.vectors; ++v)
                composeVector<Inputs>(sums[v], sums[mostVectors + v], in, task.factors,
                                      [&](int i, int column, const Number& number) {
                                          store(2 * v + i, column, number);
                                      });
        } else {
            for (int i = 0; i < use.vectorSlots; ++i)
                composeComponent<Inputs>(sums[i], task.factors,
                                         [&](int column, const Number& number) {
                                             store(use.components[i], column, number);
                                         });
        }
    }
    const int firstSlot = use.vectorSlots > 0 ? 4 : 0;
    while (scalar < use.scalars) sweep(none, one, firstSlot + scalar);
}

template <int RegisterBytes, class T, int Size, int Inputs>
void evaluateInRegisters(const BatchTask<T>& task) {
    constexpr int most = 64 / static_cast<int>(sizeof(T));  // two registers at the least width
    using Number = Pack<T, (Size < most ? Size : most), RegisterBytes>;
    for (int first = 0; first < Size; first += Number::lanes) {
        if (task.axial)
            evaluateLanes<Number, T, Size, Inputs, 4>(task, first);
        else
            evaluateLanes<Number, T, Size, Inputs, 5>(task, first);
    }
}

}  // namespace etendue
