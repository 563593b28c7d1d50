// Gauss–Legendre quadrature, for the integrals that are done while a scene loads.
#pragma once

#include <vector>

namespace etendue {

struct QuadratureRule {
    std::vector<double> nodes, weights;

    template <class F>
    double integrate(double from, double to, F&& f) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < nodes.size(); ++i)
            sum += weights[i] * f(from + (to - from) * nodes[i]);
        return (to - from) * sum;
    }
};

/// The rule of `count` nodes on [0, 1]: exact for polynomials of degree 2·count − 1.
QuadratureRule gaussLegendre(int count);

/// The same after the change of variable x → x²(3 − 2x), which makes integrands with square-root
/// singularities at the ends smooth.
QuadratureRule gaussLegendreForRootEnds(int count);

}  // namespace etendue
