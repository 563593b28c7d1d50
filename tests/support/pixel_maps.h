// Maps of one number a pixel, and what several noisy ones have in common.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace etendue {

/// Row by row.
using PixelMap = std::vector<double>;

inline double innerProduct(const PixelMap& a, const PixelMap& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

inline PixelMap difference(PixelMap a, const PixelMap& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
    return a;
}

inline std::vector<PixelMap> differences(const std::vector<PixelMap>& a,
                                         const std::vector<PixelMap>& b) {
    std::vector<PixelMap> result;
    for (std::size_t i = 0; i < a.size(); ++i) result.push_back(difference(a[i], b[i]));
    return result;
}

inline PixelMap meanOf(const std::vector<PixelMap>& maps) {
    PixelMap mean(maps.front().size());
    for (const PixelMap& map : maps)
        for (std::size_t i = 0; i < mean.size(); ++i)
            mean[i] += map[i] / static_cast<double>(maps.size());
    return mean;
}

inline double rms(const PixelMap& map) {
    return std::sqrt(innerProduct(map, map) / static_cast<double>(map.size()));
}

inline double meanAbsolute(const PixelMap& map) {
    double sum = 0.0;
    for (const double v : map) sum += std::abs(v);
    return sum / static_cast<double>(map.size());
}

inline double largest(const PixelMap& map) {
    double most = 0.0;
    for (const double v : map) most = std::max(most, std::abs(v));
    return most;
}

/// The rms of what independent noisy maps share: in the mean, noise adds nothing to its square.
inline double sharedRms(const std::vector<PixelMap>& maps) {
    const auto n = static_cast<double>(maps.size());
    const PixelMap mean = meanOf(maps);
    double own = 0.0;
    for (const PixelMap& map : maps) own += innerProduct(map, map);
    const double square = (n * n * innerProduct(mean, mean) - own) / (n * (n - 1.0));
    return std::sqrt(std::max(0.0, square) / static_cast<double>(mean.size()));
}

/// How much of `pattern` each map holds: least squares' factor.
inline std::vector<double> factorsOf(const PixelMap& pattern, const std::vector<PixelMap>& maps) {
    std::vector<double> factors;
    for (const PixelMap& map : maps)
        factors.push_back(innerProduct(map, pattern) / innerProduct(pattern, pattern));
    return factors;
}

}  // namespace etendue
