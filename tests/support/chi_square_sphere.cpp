#include "tests/support/chi_square_sphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace etendue {

namespace {

constexpr double pi64 = std::numbers::pi;

// Gauss–Legendre with four nodes on [0, 1].
constexpr std::array nodes{0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                           0.93056815579702629};
constexpr std::array weights{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                             0.17392742256872693};

struct Rectangle {
    double rowFrom, rowTo, columnFrom, columnTo;  // in units of rows and columns
};

class CellIntegrator {
public:
    CellIntegrator(const SphereGrid& grid, const DirectionFunction& f) : grid_(grid), f_(f) {}

    double integrate(const Rectangle& r) const { return refine(r, estimate(r), 0); }

private:
    double estimate(const Rectangle& r) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const double row = (r.rowFrom + (r.rowTo - r.rowFrom) * nodes[i]) / grid_.rows;
            const double theta = pi64 * std::pow(row, grid_.power);
            const double measure = std::sin(theta) * pi64 * grid_.power *
                                   std::pow(row, grid_.power - 1.0) / grid_.rows;
            for (std::size_t j = 0; j < nodes.size(); ++j) {
                const double column = r.columnFrom + (r.columnTo - r.columnFrom) * nodes[j];
                sum += weights[i] * weights[j] * measure * f_(direction(theta, column));
            }
        }
        return sum * (r.rowTo - r.rowFrom) * (r.columnTo - r.columnFrom) * 2.0 * pi64 /
               grid_.columns;
    }

    double refine(const Rectangle& r, double coarse, int depth) const {
        const double row = 0.5 * (r.rowFrom + r.rowTo), column = 0.5 * (r.columnFrom + r.columnTo);
        const std::array<Rectangle, 4> parts{Rectangle{r.rowFrom, row, r.columnFrom, column},
                                             Rectangle{r.rowFrom, row, column, r.columnTo},
                                             Rectangle{row, r.rowTo, r.columnFrom, column},
                                             Rectangle{row, r.rowTo, column, r.columnTo}};
        std::array<double, 4> value{};
        std::transform(parts.begin(), parts.end(), value.begin(),
                       [this](const Rectangle& part) { return estimate(part); });
        const double fine = std::accumulate(value.begin(), value.end(), 0.0);
        if (depth == deepest || std::abs(fine - coarse) <= 1e-7 + 1e-5 * std::abs(fine))
            return fine;
        double sum = 0.0;
        for (std::size_t i = 0; i < parts.size(); ++i) sum += refine(parts[i], value[i], depth + 1);
        return sum;
    }
    static constexpr int deepest = 7;

    Vec3 direction(double theta, double column) const {
        const double phi = 2.0 * pi64 * column / grid_.columns;
        return grid_.frame.worldFromLocal(toFloat(Vec3d{
            std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}));
    }

    const SphereGrid& grid_;
    const DirectionFunction& f_;
};

}  // namespace

std::size_t SphereGrid::cellOf(Vec3 world) const {
    const Vec3 d = frame.localFromWorld(world);
    // atan2 keeps its precision near the poles, where the cells may be narrow.
    const double theta = std::atan2(std::hypot(double{d.x}, double{d.y}), double{d.z});
    const double turns = std::atan2(double{d.y}, double{d.x}) / (2.0 * pi64);
    const double row = std::pow(theta / pi64, 1.0 / power) * rows;
    const double column = (turns < 0.0 ? turns + 1.0 : turns) * columns;
    return static_cast<std::size_t>(std::min(static_cast<int>(row), rows - 1) * columns +
                                    std::min(static_cast<int>(column), columns - 1));
}

std::vector<double> integrateCells(const SphereGrid& grid, const DirectionFunction& f) {
    const CellIntegrator integrator(grid, f);
    std::vector<double> cells;
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column)
            cells.push_back(integrator.integrate(
                {static_cast<double>(row), row + 1.0, static_cast<double>(column), column + 1.0}));
    return cells;
}

double integrateSphere(const SphereGrid& grid, const DirectionFunction& f) {
    const std::vector<double> cells = integrateCells(grid, f);
    return std::accumulate(cells.begin(), cells.end(), 0.0);
}

DirectionTest testDirections(const SphereGrid& grid, std::uint32_t count, std::uint64_t seed,
                             const std::function<std::optional<Vec3>(RandomStream&)>& draw,
                             const DirectionFunction& density) {
    DirectionTest test;
    std::vector<double> observed(grid.size() + 1), expected = integrateCells(grid, density);
    for (std::uint32_t i = 0; i < count; ++i) {
        RandomStream random(seed, i, 0, RandomDomain::test);
        const std::optional<Vec3> direction = draw(random);
        ++observed[direction ? grid.cellOf(*direction) : grid.size()];
        if (direction && !(density(*direction) > 0.0)) ++test.drawsWhereZero;
    }
    test.integral = std::accumulate(expected.begin(), expected.end(), 0.0);
    // One more cell for the draws that come back empty.
    expected.push_back(1.0 - test.integral);
    // A cell whose sliver of density no quadrature node met is not impossible, but one to be
    // pooled.
    for (double& e : expected) e = std::max(e, 1e-9) * count;
    test.chiSquare = chiSquareTest(observed, expected);
    return test;
}

}  // namespace etendue
