#include "renderer/distribution.h"

#include <bit>
#include <cassert>

namespace etendue {

Distribution1D::Distribution1D(std::span<const double> weights) {
    cumulative_.reserve(weights.size() + 1);
    cumulative_.push_back(0.0);
    for (const double weight : weights) {
        assert(weight >= 0.0);
        totalWeight_ += weight;
        cumulative_.push_back(totalWeight_);
    }
    if (totalWeight_ > 0.0)
        for (double& c : cumulative_) c /= totalWeight_;
    makeGuides();
}

void Distribution1D::makeGuides() {
    // Twice as many as indices: a search then mostly ends where it begins. A power of two, so that
    // a guide's place is exact.
    guides_.resize(std::bit_ceil(2 * std::max<std::size_t>(size(), 1)));
    std::uint32_t index = 0;
    for (std::size_t i = 0; i < guides_.size(); ++i) {
        const double u = static_cast<double>(i) / static_cast<double>(guides_.size());
        while (index + 1 < size() && cumulative_[index + 1] <= u) ++index;
        guides_[i] = index;
    }
}

Distribution2D::Distribution2D(int width, int height, std::span<const double> weights)
    : cellCount_(static_cast<double>(width) * height) {
    assert(static_cast<double>(weights.size()) == cellCount_);
    const auto rowSize = static_cast<std::size_t>(width);
    std::vector<double> rowWeights;
    for (std::size_t first = 0; first < weights.size(); first += rowSize) {
        cellsOfRow_.emplace_back(weights.subspan(first, rowSize));
        rowWeights.push_back(cellsOfRow_.back().totalWeight());
    }
    rows_ = Distribution1D(rowWeights);
}

std::optional<CellSample> Distribution2D::sample(Vec2T<double> u) const {
    const auto row = rows_.sample(u.y);
    if (!row) return {};
    const auto cell = cellsOfRow_[row->index].sample(u.x);
    if (!cell) return {};
    return CellSample{static_cast<int>(cell->index),
                      static_cast<int>(row->index),
                      {cell->remainder, row->remainder},
                      row->probability * cell->probability * cellCount_};
}

double Distribution2D::density(int x, int y) const {
    const auto row = static_cast<std::size_t>(y);
    return rows_.probability(row) * cellsOfRow_[row].probability(static_cast<std::size_t>(x)) *
           cellCount_;
}

}  // namespace etendue
