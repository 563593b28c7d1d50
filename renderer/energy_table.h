// EnergyTable: a share of energy as a function of |cosθ|, tabulated while a material loads and read
// in the path tracer's inner loop.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <vector>

namespace etendue {

/// Piecewise linear in the cosine. Every octave of x = cosine + a small offset has the same number
/// of intervals, so that the bits of the float x are the place in the table, and detail near
/// grazing is resolved like any other.
class EnergyTable {
public:
    /// `share` maps a cosine in (0, 1] to [0, 1]; near 0, and at `kink` if that is not 0,
    /// it varies on the scale of `alpha`. It is called some hundred times; the interpolation error
    /// is about `tolerance`.
    EnergyTable(double alpha, double kink, const std::function<double(double)>& share);
    static constexpr double tolerance = 4e-6;

    /// `cosine` in [0, 1], or above it by rounding.
    float at(float cosine) const {
        const std::uint32_t place =
            std::bit_cast<std::uint32_t>(cosine * scale_ + offset_) - firstBits_;
        const float fraction = static_cast<float>(place & fractionMask) * fractionUnit;
        const float low = values_[place >> fractionBits];
        return low + fraction * (values_[(place >> fractionBits) + 1] - low);
    }

    /// The mean over cosine-weighted directions, 2 ∫ at(μ) μ dμ.
    float average() const { return average_; }

    /// A cosine of density 2 μ at(μ) / average().
    float sample(float u) const;

    std::size_t size() const { return values_.size(); }

private:
    static constexpr int intervalBits = 8;  // 256 intervals an octave
    static constexpr int fractionBits = 23 - intervalBits;
    static constexpr std::uint32_t fractionMask = (1u << fractionBits) - 1u;
    static constexpr float fractionUnit = 1.0f / static_cast<float>(1u << fractionBits);

    float xOfNode(std::size_t i) const;
    double cosineOfNode(std::size_t i) const;
    void fill(const std::function<double(double)>& share, int octaves, double alpha, double kink);
    void accumulate();

    float offset_, scale_;  // x = cosine · scale + offset; 2^−octaves at 0, 1 at 1
    std::uint32_t firstBits_;
    std::vector<float> values_;      // at the nodes; the last one stands twice, for cosines above 1
    std::vector<float> cumulative_;  // of the density of sample(), at the nodes
    float average_ = 0.0f;
};

}  // namespace etendue
