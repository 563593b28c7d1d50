#include "renderer/quadrature.h"

#include <cmath>
#include <numbers>

namespace etendue {

QuadratureRule gaussLegendre(int count) {
    QuadratureRule rule;
    for (int i = 0; i < count; ++i) {
        // Newton's iteration on the Legendre polynomial, from the asymptotic place of its root.
        double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
        double slope = 1.0;
        for (double step = 1.0; std::abs(step) > 1e-15;) {
            double previous = 1.0, value = x;
            for (int k = 2; k <= count; ++k) {
                const double next = ((2 * k - 1) * x * value - (k - 1) * previous) / k;
                previous = value;
                value = next;
            }
            slope = count * (x * value - previous) / (x * x - 1.0);
            step = value / slope;
            x -= step;
        }
        rule.nodes.push_back(0.5 * (1.0 - x));
        rule.weights.push_back(1.0 / ((1.0 - x * x) * slope * slope));
    }
    return rule;
}

QuadratureRule gaussLegendreForRootEnds(int count) {
    QuadratureRule rule = gaussLegendre(count);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const double x = rule.nodes[i];
        rule.nodes[i] = x * x * (3.0 - 2.0 * x);
        rule.weights[i] *= 6.0 * x * (1.0 - x);
    }
    return rule;
}

}  // namespace etendue
