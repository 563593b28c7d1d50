#include "renderer/energy_table.h"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <vector>

#include "renderer/random.h"
#include "statistics/statistics.h"

namespace etendue {

namespace {

/// Like the shares in use: a rise at the scale of α, and beyond `kink` a bump of width α.
struct Example {
    double alpha, kink;
    double operator()(double mu) const {
        const double rise = mu / (mu + alpha);
        const double bump = mu > kink ? (mu - kink) / alpha * std::exp(-(mu - kink) / alpha) : 0.0;
        return 0.2 * rise + (kink > 0.0 ? 0.1 * bump : 0.0);
    }
};

}  // namespace

TEST_CASE("EnergyTable: interpolates to its tolerance at every scale") {
    for (const double alpha : {1e-5, 1e-3, 0.03, 1.0})
        for (const double kink : {0.0, 0.745}) {
            const Example share{alpha, kink};
            const EnergyTable table(alpha, kink, share);
            // Between 256 nodes an octave the chord of the bump misses it by up to h² f'' / 8,
            // h = 1/512 at the kink; a bump narrower than the nodes is met at the nodes alone.
            const double h = 1.0 / 512.0, curvature = kink > 0.0 ? 0.2 / (alpha * alpha) : 0.0;
            const double chord = h * h * curvature / 8.0;
            if (chord > 0.05) continue;
            // The rise, in octaves of μ + offset, bends by less than 0.2 · (1/256)² / 8 · 4.
            const double tolerance = 2.0 * EnergyTable::tolerance + 1.6e-6 + chord;
            for (double mu = 1.0; mu > 1e-9; mu *= 0.983)
                CHECK(std::abs(double{table.at(static_cast<float>(mu))} - share(mu)) < tolerance);
        }
}

TEST_CASE("EnergyTable: the ends of the range are inside, and rounding beyond 1 does no harm") {
    const EnergyTable table(0.1, 0.0, [](double mu) { return 0.25 + 0.5 * mu; });
    CHECK(table.at(0.0f) == doctest::Approx(0.25).epsilon(1e-6));
    CHECK(table.at(1e-30f) == doctest::Approx(0.25).epsilon(1e-6));
    CHECK(table.at(1.0f) == doctest::Approx(0.75).epsilon(1e-6));
    CHECK(table.at(1.000002f) == doctest::Approx(0.75).epsilon(1e-5));
}

TEST_CASE("EnergyTable: average is weighted by the cosine") {
    // 2 ∫ (a + b μ) μ dμ = a + 2 b / 3
    const EnergyTable table(0.01, 0.0, [](double mu) { return 0.25 + 0.5 * mu; });
    CHECK(double{table.average()} == doctest::Approx(0.25 + 1.0 / 3.0).epsilon(1e-6));
}

TEST_CASE("EnergyTable: samples have the density μ at(μ)") {
    for (const double alpha : {1e-4, 0.05, 1.0}) {
        const Example share{alpha, alpha < 0.01 ? 0.0 : 0.5};
        const EnergyTable table(alpha, share.kink, share);
        constexpr std::size_t cells = 200, count = 200000;
        std::vector<double> observed(cells), expected(cells);
        for (std::uint32_t i = 0; i < count; ++i) {
            RandomStream random(5, i, 0, RandomDomain::test);
            const auto cell = static_cast<std::size_t>(table.sample(random.next()) * cells);
            ++observed[std::min(cell, cells - 1)];
        }
        for (std::size_t i = 0; i < cells; ++i) {
            constexpr int steps = 500;
            for (int k = 0; k < steps; ++k) {
                const double mu =
                    (static_cast<double>(i) + (k + 0.5) / steps) / static_cast<double>(cells);
                expected[i] += 2.0 * mu * share(mu) / double{table.average()} *
                               static_cast<double>(count) / (steps * static_cast<double>(cells));
            }
        }
        CHECK(chiSquareTest(observed, expected).pValue > sidakLevel(1e-3, 3));
    }
}

TEST_CASE("EnergyTable: the edges of the unit interval give cosines inside") {
    const EnergyTable table(0.1, 0.0, Example{0.1, 0.0});
    for (const float u : {0.0f, 0x1p-32f, 0.5f, 0x1.fffffep-1f}) {
        CHECK(table.sample(u) >= 0.0f);
        CHECK(table.sample(u) <= 1.0f);
    }
}

}  // namespace etendue
