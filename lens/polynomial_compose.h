// From sums over monomials to outputs and their derivatives: what evaluating a polynomial at one
// input and at several side by side have in common. Number is a Pack. As pack.h, for code of any
// register width: no Eigen here.
#pragma once

#include <array>

#include "lens/pack.h"

namespace etendue {

constexpr int mostVectors = 2;

/// How scaled inputs grow with inputs: s by `sensor`, p by `second`, and p with s by `coupled`.
template <class T>
struct InputFactors {
    T sensor, second, coupled[2];
};

/// By how many of the outermost levels' variables sums are to be derived for derivatives by
/// `inputs` inputs.
constexpr int derivedLevels(int levels, int inputs) { return inputs == 4 ? levels - 1 : inputs; }

/// The variables of the levels: ρ κ σ w of the axial basis' four, else the scaled inputs.
template <int Levels, class Number>
[[gnu::always_inline]] inline std::array<Number, Levels> levelVariables(const Number (&in)[5]) {
    if constexpr (Levels == 4)
        return {fma(in[0], in[0], in[1] * in[1]), fma(in[0], in[2], in[1] * in[3]),
                fma(in[2], in[2], in[3] * in[3]), in[4]};
    else
        return {in[0], in[1], in[2], in[3], in[4]};
}

/// Derivatives by the scaled inputs to those by the inputs. Those by s alone are for inputs that
/// are not coupled.
template <int Inputs, class Number, class T>
[[gnu::always_inline]] inline void unscale(const InputFactors<T>& factors,
                                           Number (&slopes)[Inputs]) {
    for (int j = 0; j < 2; ++j) {
        slopes[j] = slopes[j] * Number::all(factors.sensor);
        if constexpr (Inputs == 4) {
            slopes[j] = fma(slopes[2 + j], Number::all(factors.coupled[j]), slopes[j]);
            slopes[2 + j] = slopes[2 + j] * Number::all(factors.second);
        }
    }
}

/// Outputs that are sums themselves: store(0, value), store(1 + j, derivative by input j). Of the
/// parts of a sum, as in HornerSums, [0] is the value and [By − l] the derivative by the variable
/// of level l.
template <int Inputs, class Number, int Parts, class T, class Store>
[[gnu::always_inline]] inline void composeComponent(const Number (&sum)[Parts],
                                                    const InputFactors<T>& factors,
                                                    const Store& store) {
    store(0, sum[0]);
    if constexpr (Inputs > 0) {
        Number slopes[Inputs];
        for (int j = 0; j < Inputs; ++j) slopes[j] = sum[Parts - 1 - j];
        unscale<Inputs>(factors, slopes);
        for (int j = 0; j < Inputs; ++j) store(1 + j, slopes[j]);
    }
}

/// The vector b s + c p, likewise: store(i, 0, component i) and so on.
template <int Inputs, class Number, int Parts, class T, class Store>
[[gnu::always_inline]] inline void composeVector(const Number (&b)[Parts], const Number (&c)[Parts],
                                                 const Number (&in)[5],
                                                 const InputFactors<T>& factors,
                                                 const Store& store) {
    for (int i = 0; i < 2; ++i) store(i, 0, fma(b[0], in[i], c[0] * in[2 + i]));
    if constexpr (Inputs > 0) {
        constexpr int rho = Parts - 1, kappa = Parts - 2, sigma = Parts - 3;
        Number slopes[2][Inputs];
        for (int j = 0; j < Inputs; ++j) {
            // ρ grows with s by 2 s and σ with p by 2 p; κ with s by p and with p by s.
            const bool second = j >= 2;
            const int square = second ? sigma : rho;
            const Number twice = in[j] + in[j], other = in[second ? j - 2 : j + 2];
            const Number bSlope = fma(b[square], twice, b[kappa] * other);
            const Number cSlope = fma(c[square], twice, c[kappa] * other);
            for (int i = 0; i < 2; ++i) slopes[i][j] = fma(bSlope, in[i], cSlope * in[2 + i]);
            slopes[j % 2][j] = slopes[j % 2][j] + (second ? c[0] : b[0]);
        }
        for (int i = 0; i < 2; ++i) {
            unscale<Inputs>(factors, slopes[i]);
            for (int j = 0; j < Inputs; ++j) store(i, 1 + j, slopes[i][j]);
        }
    }
}

}  // namespace etendue
