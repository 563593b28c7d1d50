// Distribution1D, Distribution2D: piecewise-constant densities, sampled by inverting their
// cumulative sums. The sums are kept in double: a float's 24 bits could not tell a million
// triangles apart.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "renderer/vec.h"

namespace etendue {

/// The nearest float in [0, 1) to `u` in [0, 1): rounding never reaches 1.
inline float unitFloat(double u) { return std::min(static_cast<float>(u), 0x1.fffffep-1f); }

struct DiscreteSample {
    std::size_t index;
    double probability;  // of this index; positive
    double remainder;    // in [0, 1): where `u` fell within the index's share; uniform again
};

/// Chooses an index with probability proportional to its weight.
class Distribution1D {
public:
    Distribution1D() = default;
    /// Finite weights, none negative. One that rounding loses in the sum (below 2^-53 of it) has
    /// probability 0.
    explicit Distribution1D(std::span<const double> weights);

    /// `u` in [0, 1). Empty when all weights are zero. O(1) on average over u.
    std::optional<DiscreteSample> sample(double u) const {
        assert(u >= 0.0 && u < 1.0);
        if (totalWeight_ <= 0.0) return {};
        // The last bound at or below u begins a share that contains u, hence one that is not empty.
        std::size_t index =
            guides_[static_cast<std::size_t>(u * static_cast<double>(guides_.size()))];
        while (cumulative_[index + 1] <= u) ++index;
        const double share = probability(index);
        constexpr double oneBelowOne = 1.0 - 0x1p-53;
        return DiscreteSample{index, share,
                              std::min((u - cumulative_[index]) / share, oneBelowOne)};
    }
    /// Exactly the share of [0, 1) for which sample() returns `index`.
    double probability(std::size_t index) const {
        return cumulative_[index + 1] - cumulative_[index];
    }

    double totalWeight() const { return totalWeight_; }
    std::size_t size() const { return cumulative_.empty() ? 0 : cumulative_.size() - 1; }

private:
    void makeGuides();

    std::vector<double>
        cumulative_;  // size() + 1 values from 0 to 1; all 0 if no weight is positive
    /// [i]: where the search for i / size begins, and for what follows up to the next.
    std::vector<std::uint32_t> guides_;
    double totalWeight_ = 0.0;
};

struct CellSample {
    int x, y;
    Vec2T<double> remainder;  // position within the cell, each coordinate uniform in [0, 1)
    double density;           // on the unit square that the image covers; positive
};

/// A density on the unit square, constant in each cell of a grid: first a row is chosen, then a
/// cell of it.
class Distribution2D {
public:
    /// `weights`: width · height cells, row by row, as for Distribution1D.
    Distribution2D(int width, int height, std::span<const double> weights);

    /// `u` in [0, 1)²; u.y chooses the row. Empty when all weights are zero.
    std::optional<CellSample> sample(Vec2T<double> u) const;
    double density(int x, int y) const;

    double totalWeight() const { return rows_.totalWeight(); }

private:
    Distribution1D rows_;
    std::vector<Distribution1D> cellsOfRow_;
    double cellCount_;
};

}  // namespace etendue
