#include "renderer/energy_table.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {

namespace {

/// A function sampled at five equidistant places of [from, to].
struct Panel {
    double from, to;
    std::array<double, 5> value;

    /// Fourth difference: how far the cubic through the other four misses the middle.
    double error() const {
        return std::abs(value[2] - (value[1] + value[3]) * (2.0 / 3.0) +
                        (value[0] + value[4]) * (1.0 / 6.0));
    }
    /// The quartic through the five, in Lagrange's form.
    double at(double s) const {
        const double t = 4.0 * (s - from) / (to - from);
        const double a = t, b = t - 1, c = t - 2, d = t - 3, e = t - 4;
        return value[0] * b * c * d * e / 24.0 - value[1] * a * c * d * e / 6.0 +
               value[2] * a * b * d * e / 4.0 - value[3] * a * b * c * e / 6.0 +
               value[4] * a * b * c * d / 24.0;
    }
};

constexpr int deepestSplit = 9;

/// Appends panels that cover `panel` from left to right, each as good as `tolerance`.
template <class F>
void refine(const Panel& panel, const F& f, int depth, std::vector<Panel>& result) {
    if (depth == deepestSplit || panel.error() < EnergyTable::tolerance) {
        result.push_back(panel);
        return;
    }
    const double middle = 0.5 * (panel.from + panel.to), step = 0.125 * (panel.to - panel.from);
    const auto& v = panel.value;
    refine(
        Panel{
            panel.from, middle, {v[0], f(panel.from + step), v[1], f(panel.from + 3 * step), v[2]}},
        f, depth + 1, result);
    refine(Panel{middle, panel.to, {v[2], f(middle + step), v[3], f(middle + 3 * step), v[4]}}, f,
           depth + 1, result);
}

}  // namespace

EnergyTable::EnergyTable(double alpha, double kink, const std::function<double(double)>& share) {
    // The finest interval is α / 2¹⁶: near grazing the shares behave like μ log μ.
    const int octaves = std::clamp(static_cast<int>(std::ceil(std::log2(256.0 / alpha))), 8, 30);
    offset_ = std::ldexp(1.0f, -octaves);
    scale_ = 1.0f - offset_;
    firstBits_ = std::bit_cast<std::uint32_t>(offset_);
    fill(share, octaves, alpha, kink);
    accumulate();
}

float EnergyTable::xOfNode(std::size_t i) const {
    return std::bit_cast<float>(firstBits_ + (static_cast<std::uint32_t>(i) << fractionBits));
}

double EnergyTable::cosineOfNode(std::size_t i) const {
    return (double{xOfNode(i)} - double{offset_}) / (1.0 - double{offset_});
}

void EnergyTable::fill(const std::function<double(double)>& share, int octaves, double alpha,
                       double kink) {
    // The shares are smoothest as functions of log x.
    const auto cosineOf = [this](double s) {
        return std::clamp((std::exp2(s) - double{offset_}) / (1.0 - double{offset_}), 1e-12, 1.0);
    };
    const auto byLogarithm = [&](double s) { return share(cosineOf(s)); };
    std::vector<double> ends;
    for (int s = 0; s > -octaves; s -= 2) ends.push_back(s);
    ends.push_back(-octaves);
    for (const double cosine : {kink - 4.0 * alpha, kink, kink + 4.0 * alpha})
        if (kink > 0.0 && cosine > 0.0 && cosine < 1.0)
            ends.push_back(std::log2(cosine * (1.0 - double{offset_}) + double{offset_}));
    std::sort(ends.begin(), ends.end());
    std::vector<Panel> panels;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        Panel panel{ends[i], ends[i + 1], {}};
        for (std::size_t k = 0; k < 5; ++k)
            panel.value[k] =
                byLogarithm(panel.from + 0.25 * static_cast<double>(k) * (panel.to - panel.from));
        refine(panel, byLogarithm, 0, panels);
    }
    const std::size_t intervals = static_cast<std::size_t>(octaves) << intervalBits;
    auto panel = panels.begin();
    for (std::size_t i = 0; i <= intervals; ++i) {
        const double s = std::log2(double{xOfNode(i)});
        while (s > panel->to && panel + 1 != panels.end()) ++panel;
        // The quartic may leave [0, 1] by its error.
        values_.push_back(static_cast<float>(std::clamp(panel->at(s), 0.0, 1.0)));
    }
    values_.push_back(values_.back());
}

void EnergyTable::accumulate() {
    // Exact for the interpolant: Simpson's rule on μ times a linear function.
    std::vector<double> sums{0.0};
    for (std::size_t i = 0; i + 2 < values_.size(); ++i) {
        const double a = cosineOfNode(i), b = cosineOfNode(i + 1);
        const double va = double{values_[i]}, vb = double{values_[i + 1]};
        const double middle = 0.25 * (a + b) * (va + vb);
        sums.push_back(sums.back() + (b - a) / 3.0 * (a * va + 4.0 * middle + b * vb));
    }
    average_ = static_cast<float>(sums.back());
    for (const double s : sums)
        cumulative_.push_back(static_cast<float>(sums.back() > 0.0 ? s / sums.back() : 0.0));
}

float EnergyTable::sample(float u) const {
    const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, u);
    const auto i = static_cast<std::size_t>(above - cumulative_.begin()) - 1;
    const double a = cosineOfNode(i), width = cosineOfNode(i + 1) - a;
    const double value = double{values_[i]}, slope = (double{values_[i + 1]} - value) / width;
    // Inside the interval the integral of μ at(μ) is a cubic; Newton's iteration from the chord.
    const double chord = std::clamp(
        double{u - cumulative_[i]} / double{cumulative_[i + 1] - cumulative_[i]}, 0.0, 1.0);
    const auto integral = [&](double y) {
        return y * (a * value + y * ((value + a * slope) / 2.0 + y * slope / 3.0));
    };
    const double target = chord * integral(width);
    double y = chord * width;
    for (int k = 0; k < 3; ++k) {
        const double density = (a + y) * (value + slope * y);
        if (!(density > 0.0)) break;
        y = std::clamp(y - (integral(y) - target) / density, 0.0, width);
    }
    return static_cast<float>(a + y);
}

}  // namespace etendue
