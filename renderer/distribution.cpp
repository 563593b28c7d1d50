#include "renderer/distribution.h"

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
}

std::optional<DiscreteSample> Distribution1D::sample(double u) const {
    assert(u >= 0.0 && u < 1.0);
    if (totalWeight_ <= 0.0) return {};
    // The last bound at or below u begins a share that contains u, hence one that is not empty.
    // Searched without a branch, for its outcome would be guessed wrong half of the time.
    std::size_t index = 0;
    for (std::size_t left = size(); left > 1;) {
        const std::size_t half = left / 2;
        index += half * static_cast<std::size_t>(cumulative_[index + half] <= u);
        left -= half;
    }
    const double share = probability(index);
    constexpr double oneBelowOne = 1.0 - 0x1p-53;
    return DiscreteSample{index, share, std::min((u - cumulative_[index]) / share, oneBelowOne)};
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
