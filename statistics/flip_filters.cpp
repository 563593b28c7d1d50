#include "statistics/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <numeric>

namespace etendue {

namespace {

using std::numbers::pi;

/// a₁·√(π/b₁)·exp(−π²d²/b₁) + a₂·√(π/b₂)·exp(−π²d²/b₂), d in degrees.
struct SensitivityConstants {
    double a1, b1, a2, b2;
};

SensitivityConstants constantsOf(OpponentChannel channel) {
    switch (channel) {
        case OpponentChannel::achromatic:
            return {1.0, 0.0047, 0.0, 1e-5};
        case OpponentChannel::redGreen:
            return {1.0, 0.0053, 0.0, 1e-5};
        case OpponentChannel::blueYellow:
            break;
    }
    return {34.1, 0.04, 13.5, 0.025};
}

constexpr double widestSensitivity = 0.04;  // the largest b: one radius serves all channels
constexpr double edgeWidthDegrees = 0.082;  // of human edge detectors, peak to trough

Kernel sampled(int radius, const std::function<double(double x)>& weight) {
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x) kernel.push_back(static_cast<float>(weight(x)));
    return kernel;
}

/// The sum of the weights of one sign, without it.
double sumOf(const Kernel& kernel, float sign) {
    return std::accumulate(kernel.begin(), kernel.end(), 0.0, [sign](double sum, float weight) {
        return sum + std::max(0.0, static_cast<double>(sign * weight));
    });
}

Kernel normalized(Kernel kernel) {
    const double positive = sumOf(kernel, 1.0F), negative = sumOf(kernel, -1.0F);
    for (float& weight : kernel)
        weight = static_cast<float>(weight / (weight < 0.0F ? negative : positive));
    return kernel;
}

int radiusOf(const Kernel& kernel) { return static_cast<int>(kernel.size() / 2); }

void addScaled(float* sums, const float* values, float weight, int count) {
    for (int x = 0; x < count; ++x) sums[x] += weight * values[x];
}

Plane filteredAlongRows(const Plane& plane, const Kernel& kernel) {
    const int radius = radiusOf(kernel);
    Plane result{plane.width, plane.height, std::vector<float>(plane.values.size(), 0.0F)};
    std::vector<float> extended(static_cast<std::size_t>(plane.width + 2 * radius));
    for (int y = 0; y < plane.height; ++y) {
        const float* row = plane.values.data() + std::ptrdiff_t{y} * plane.width;
        std::fill_n(extended.begin(), radius, row[0]);
        std::copy_n(row, plane.width, extended.begin() + radius);
        std::fill_n(extended.end() - radius, radius, row[plane.width - 1]);
        float* sums = result.values.data() + std::ptrdiff_t{y} * plane.width;
        for (std::size_t i = 0; i < kernel.size(); ++i)
            addScaled(sums, extended.data() + i, kernel[i], plane.width);
    }
    return result;
}

Plane filteredAlongColumns(const Plane& plane, const Kernel& kernel) {
    const int radius = radiusOf(kernel);
    Plane result{plane.width, plane.height, std::vector<float>(plane.values.size(), 0.0F)};
    for (int y = 0; y < plane.height; ++y) {
        float* sums = result.values.data() + std::ptrdiff_t{y} * plane.width;
        for (int i = -radius; i <= radius; ++i) {
            const int from = std::clamp(y + i, 0, plane.height - 1);
            addScaled(sums, plane.values.data() + std::ptrdiff_t{from} * plane.width,
                      kernel[static_cast<std::size_t>(i + radius)], plane.width);
        }
    }
    return result;
}

}  // namespace

Plane filtered(const Plane& plane, const Kernel& horizontal, const Kernel& vertical) {
    return filteredAlongColumns(filteredAlongRows(plane, horizontal), vertical);
}

ContrastSensitivity contrastSensitivity(OpponentChannel channel, double pixelsPerDegree) {
    const SensitivityConstants c = constantsOf(channel);
    const int radius = static_cast<int>(
        std::ceil(3.0 * std::sqrt(widestSensitivity / (2.0 * pi * pi)) * pixelsPerDegree));
    const auto gaussian = [&](double b) {
        return sampled(radius, [=](double x) {
            return std::exp(-pi * pi * x * x / (pixelsPerDegree * pixelsPerDegree * b));
        });
    };
    // What each Gaussian weighs in the plane before all is normalised to a sum of 1.
    const auto weightOf = [](double a, double b, const Kernel& kernel) {
        const double sum = sumOf(kernel, 1.0F);
        return a * std::sqrt(pi / b) * sum * sum;
    };
    const Kernel first = gaussian(c.b1), second = gaussian(c.b2);
    const double weight1 = weightOf(c.a1, c.b1, first), weight2 = weightOf(c.a2, c.b2, second);
    return {normalized(first), normalized(second),
            static_cast<float>(weight1 / (weight1 + weight2)),
            static_cast<float>(weight2 / (weight1 + weight2))};
}

Plane filtered(const Plane& plane, const ContrastSensitivity& sensitivity) {
    Plane result = filtered(plane, sensitivity.first, sensitivity.first);
    if (sensitivity.shareOfSecond == 0.0F) return result;
    const Plane other = filtered(plane, sensitivity.second, sensitivity.second);
    for (std::size_t i = 0; i < result.values.size(); ++i)
        result.values[i] = sensitivity.shareOfFirst * result.values[i] +
                           sensitivity.shareOfSecond * other.values[i];
    return result;
}

FeatureKernels featureKernels(double pixelsPerDegree) {
    const double deviation = 0.5 * edgeWidthDegrees * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3.0 * deviation));
    const auto bell = [=](double x) { return std::exp(-x * x / (2.0 * deviation * deviation)); };
    const auto kernel = [&](const auto& factor) {
        return normalized(sampled(radius, [&](double x) { return factor(x) * bell(x); }));
    };
    return {kernel([](double) { return 1.0; }), kernel([](double x) { return -x; }),
            kernel([=](double x) { return x * x / (deviation * deviation) - 1.0; })};
}

}  // namespace etendue
