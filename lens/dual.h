// Dual<N>: a number with its N partial derivatives, for exact derivatives of a ray trace
// (forward-mode automatic differentiation).
#pragma once

#include <array>
#include <cmath>
#include <concepts>

namespace etendue {

template <int N>
struct Dual {
    double value = 0.0;
    std::array<double, N> partials{};

    Dual() = default;
    Dual(double constant) : value(constant) {}  // implicit: a constant has no derivatives
    /// The variable with number `index`.
    static Dual variable(double value, int index) {
        Dual result(value);
        result.partials[static_cast<std::size_t>(index)] = 1.0;
        return result;
    }

    friend Dual operator-(const Dual& a) { return chain(-a.value, -1.0, a); }
    friend Dual operator+(const Dual& a, const Dual& b) {
        return chain(a.value + b.value, 1.0, a, 1.0, b);
    }
    friend Dual operator-(const Dual& a, const Dual& b) {
        return chain(a.value - b.value, 1.0, a, -1.0, b);
    }
    friend Dual operator*(const Dual& a, const Dual& b) {
        return chain(a.value * b.value, b.value, a, a.value, b);
    }
    friend Dual operator/(const Dual& a, const Dual& b) {
        const double inverse = 1.0 / b.value, quotient = a.value * inverse;
        return chain(quotient, inverse, a, -quotient * inverse, b);
    }
    friend Dual operator+(const Dual& a, double b) { return chain(a.value + b, 1.0, a); }
    friend Dual operator+(double a, const Dual& b) { return chain(a + b.value, 1.0, b); }
    friend Dual operator-(const Dual& a, double b) { return chain(a.value - b, 1.0, a); }
    friend Dual operator-(double a, const Dual& b) { return chain(a - b.value, -1.0, b); }
    friend Dual operator*(const Dual& a, double b) { return chain(a.value * b, b, a); }
    friend Dual operator*(double a, const Dual& b) { return chain(a * b.value, a, b); }
    friend Dual operator/(const Dual& a, double b) { return chain(a.value / b, 1.0 / b, a); }
    friend Dual sqrt(const Dual& a) {
        const double root = std::sqrt(a.value);
        return chain(root, 0.5 / root, a);
    }

private:
    /// The value with partials da·∂a (+ db·∂b).
    static Dual chain(double value, double da, const Dual& a) {
        Dual result(value);
        for (std::size_t i = 0; i < N; ++i) result.partials[i] = da * a.partials[i];
        return result;
    }
    static Dual chain(double value, double da, const Dual& a, double db, const Dual& b) {
        Dual result(value);
        for (std::size_t i = 0; i < N; ++i)
            result.partials[i] = da * a.partials[i] + db * b.partials[i];
        return result;
    }
};

inline double valueOf(double number) { return number; }
template <int N>
double valueOf(const Dual<N>& number) {
    return number.value;
}

}  // namespace etendue
