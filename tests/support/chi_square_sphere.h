// Sampled directions against their density: cells of the sphere, integrated adaptively, and
// Pearson's χ² over them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "renderer/frame.h"
#include "renderer/random.h"
#include "renderer/vec.h"
#include "statistics/statistics.h"

namespace etendue {

/// Cells around frame.z: `rows` intervals of the angle θ to it, whose ends are π (i / rows)^power,
/// by `columns` equal intervals of azimuth. A power above 1 makes the cells finer round frame.z,
/// for narrow lobes. With power 1 and an even number of rows the horizon is a border.
struct SphereGrid {
    int rows = 0, columns = 0;
    Frame frame;
    double power = 1.0;

    std::size_t size() const { return static_cast<std::size_t>(rows * columns); }
    std::size_t cellOf(Vec3 direction) const;
};

/// Value per steradian in a direction.
using DirectionFunction = std::function<double(Vec3)>;

/// ∫ over each cell, to about 1e-7 + 1e-5 of the value where `f` is continuous; adaptive, down to
/// 1/256 of a cell's width.
std::vector<double> integrateCells(const SphereGrid& grid, const DirectionFunction& f);

/// ∫ over the sphere.
double integrateSphere(const SphereGrid& grid, const DirectionFunction& f);

struct DirectionTest {
    ChiSquareResult chiSquare;
    std::uint32_t drawsWhereZero =
        0;                  // directions drawn though the density there is zero: an error
    double integral = 0.0;  // of the density; the rest of the draws should come back empty
};

/// `draw` gives a direction or nothing; `density` says with what density it should.
DirectionTest testDirections(const SphereGrid& grid, std::uint32_t count, std::uint64_t seed,
                             const std::function<std::optional<Vec3>(RandomStream&)>& draw,
                             const DirectionFunction& density);

}  // namespace etendue
