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
    // Slots whose sums fit in 32 registers of 64 bytes; groups that are not axial may have but one.
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
    if (use.vectorSlots > 0) {
        Number sums[4][1 + by];
        for (int slot = 0; slot < use.vectorSlots; slot += together) {
            const auto part = HornerSweep<Lanes::points, Number, together, 0, by, Levels>(
                                  task.terms, slot, variables)
                                  .run();
            std::memcpy(sums[slot], part.jets, sizeof(part.jets));
        }
        if constexpr (Levels == 4) {
            for (int v = 0; v < task.vectors; ++v)
                composeVector<Inputs>(sums[v], sums[mostVectors + v], in, task.factors,
                                      [&](int i, int column, const Number& number) {
                                          store(2 * v + i, column, number);
                                      });
        } else {
            for (int slot = 0; slot < use.vectorSlots; ++slot)
                composeComponent<Inputs>(sums[slot], task.factors,
                                         [&](int column, const Number& number) {
                                             store(use.components[slot], column, number);
                                         });
        }
    }
    const int firstSlot = use.vectorSlots > 0 ? 4 : 0;
    for (int scalar = 0; scalar < use.scalars; ++scalar)
        store(use.firstScalar + scalar, 0,
              HornerSweep<Lanes::points, Number, 0, 1, 0, Levels>(task.terms, firstSlot + scalar,
                                                                  variables)
                  .run()
                  .values[0]);
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
