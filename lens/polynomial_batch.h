// Evaluation of a polynomial at several inputs side by side, for registers of a given width: what
// PolynomialEvaluator and code for wider registers than the rest of the program may use tell each
// other. As pack.h: no Eigen here.
#pragma once

#include "lens/horner_sweep.h"
#include "lens/polynomial_compose.h"

namespace etendue {

/// The vector registers that a batch is evaluated in. The bits are the same.
enum class VectorRegisters { narrow, wide };  // 32 bytes, 64 bytes

/// The widest that this processor and this build have.
VectorRegisters widestRegisters();

/// What the slots of a group of terms are (PolynomialEvaluator::Group).
struct SlotUse {
    int vectorSlots;    // of the four, or of none, that come first
    int components[4];  // outputs of these, or -1
    int firstScalar, scalars;
};

/// One group of terms at one batch of inputs.
template <class T>
struct BatchTask {
    SlotUse use;
    HornerTerms<T> terms;
    bool axial;
    int vectors;
    InputFactors<T> factors;
    T coupling[2], waveScale, waveOffset;  // InputScaling
    const T* inputs;                       // BatchInput, a row of `Size` for each
    T* values;                             // rows of `Size`: PolynomialValues
    T* slopes;                             // and PolynomialSlopes
};

/// Sets the group's outputs and their derivatives by the first `Inputs` inputs: 0, 2 or 4.
template <class T, int Size, int Inputs>
void evaluateWide(const BatchTask<T>& task);

}  // namespace etendue
