// HornerSweep: the evaluation of a HornerScheme (horner.h) over packs of numbers. As pack.h, for
// code of any register width: no Eigen here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lens/pack.h"

namespace etendue {

/// Whether a scheme of so many levels leaves out the powers that are missing: where mirror planes
/// allow every other power only. Axial ones, of four levels, have hardly any.
constexpr bool hasGaps(int levels) { return levels > 4; }

/// Where a scheme's numbers are.
template <class T>
struct HornerTerms {
    const std::uint8_t* counts;
    const T* coefficients;
    std::size_t slots;
};

/// The sums of `Jets` packs of polynomials, each as [0] its value and [By − l] its derivative by
/// the variable of level l for l < By, and of `Values` packs without derivatives.
template <class Pack, int Jets, int Values, int By>
struct HornerSums {
    // Plain arrays: GCC 12 keeps them in registers, std::array not.
    Pack jets[Jets == 0 ? 1 : Jets][1 + By];
    Pack values[Values == 0 ? 1 : Values];
};

/// What the lanes of a pack stand for: slots, at one point, or points, of one slot.
enum class Lanes { slots, points };

/// One evaluation under way. Number is a Pack.
template <Lanes lanes, class Number, int Jets, int Values, int By, int Levels>
class HornerSweep {
public:
    using T = typename Number::Scalar;
    using Sums = HornerSums<Number, Jets, Values, By>;

    /// From slot `slot` on: the jets, then the values.
    HornerSweep(const HornerTerms<T>& terms, int slot, const std::array<Number, Levels>& variables)
        : count_(terms.counts),
          coefficients_(terms.coefficients + slot),
          slots_(terms.slots),
          variables_(variables) {}

    [[gnu::always_inline]] Sums run() {
        Sums result;
        sum<0>(result);
        return result;
    }

private:
    /// Of the sums of a level, how many variables have derivatives: its own and those within.
    static constexpr int derivatives(int level) { return level < By ? By - level : 0; }

    /// Sets the parts that the level has. Inlined, so that sums stay in registers.
    template <int Level>
    [[gnu::always_inline]] void sum(Sums& result) {
        if constexpr (Level == Levels) {
            takeCoefficients(result);
        } else {
            int powers = *count_++;
            sum<Level + 1>(result);
            if constexpr (Level < By)
                for (auto& jet : result.jets) jet[derivatives(Level)] = Number::all(T(0));
            if constexpr (hasGaps(Levels)) {
                int gap = *count_++;
                while (--powers > 0) {
                    for (; gap > 1; --gap) multiply<Level>(result);
                    addNext<Level>(result);
                    gap = *count_++;
                }
                for (; gap > 0; --gap) multiply<Level>(result);
            } else {
                while (--powers > 0) addNext<Level>(result);
            }
        }
    }

    /// result = result × variable + the next term
    template <int Level>
    [[gnu::always_inline]] void addNext(Sums& result) {
        Sums term;
        sum<Level + 1>(term);
        multiplyAdd<Level>(result, term);
    }

    [[gnu::always_inline]] void takeCoefficients(Sums& result) {
        constexpr int stride = lanes == Lanes::slots ? Number::lanes : 1;
        for (int i = 0; i < Jets; ++i) result.jets[i][0] = coefficient(i * stride);
        for (int i = 0; i < Values; ++i) result.values[i] = coefficient((Jets + i) * stride);
        coefficients_ += slots_;
    }
    [[gnu::always_inline]] Number coefficient(int slot) const {
        if constexpr (lanes == Lanes::slots) return Number::load(coefficients_ + slot);
        return Number::all(coefficients_[slot]);
    }

    /// result = result × variable, with derivatives.
    template <int Level>
    [[gnu::always_inline]] void multiply(Sums& result) {
        constexpr int own = derivatives(Level), inner = derivatives(Level + 1);
        const Number& x = variables_[Level];
        for (int i = 0; i < Jets; ++i) {
            auto& jet = result.jets[i];
            if constexpr (own > inner) jet[own] = fma(jet[own], x, jet[0]);
            for (int part = 0; part <= inner; ++part) jet[part] = jet[part] * x;
        }
        for (int i = 0; i < Values; ++i) result.values[i] = result.values[i] * x;
    }

    /// result = result × variable + term, with derivatives.
    template <int Level>
    [[gnu::always_inline]] void multiplyAdd(Sums& result, const Sums& term) {
        constexpr int own = derivatives(Level), inner = derivatives(Level + 1);
        const Number& x = variables_[Level];
        for (int i = 0; i < Jets; ++i) {
            auto& jet = result.jets[i];
            if constexpr (own > inner) jet[own] = fma(jet[own], x, jet[0]);
            for (int part = 0; part <= inner; ++part)
                jet[part] = fma(jet[part], x, term.jets[i][part]);
        }
        for (int i = 0; i < Values; ++i)
            result.values[i] = fma(result.values[i], x, term.values[i]);
    }

    const std::uint8_t* count_;
    const T* coefficients_;
    std::size_t slots_;
    const std::array<Number, Levels>& variables_;
};

}  // namespace etendue
