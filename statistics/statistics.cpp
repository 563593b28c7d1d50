#include "statistics/statistics.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <vector>

namespace etendue {

Summary summarize(std::span<const double> values) {
    Summary s;
    s.count = values.size();
    if (values.empty()) return s;
    const auto n = static_cast<double>(values.size());
    s.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    if (values.size() < 2) return s;
    double sum = 0.0;
    for (const double v : values) sum += (v - s.mean) * (v - s.mean);
    s.variance = sum / (n - 1.0);
    s.standardError = std::sqrt(s.variance / n);
    return s;
}

double sidakLevel(double level, std::size_t tests) {
    return -std::expm1(std::log1p(-level) / static_cast<double>(std::max<std::size_t>(tests, 1)));
}

double studentTwoSidedP(double t, double degreesOfFreedom) {
    const boost::math::students_t distribution(degreesOfFreedom);
    return 2.0 * boost::math::cdf(boost::math::complement(distribution, std::abs(t)));
}

double studentQuantile(double confidence, double degreesOfFreedom) {
    const boost::math::students_t distribution(degreesOfFreedom);
    return boost::math::quantile(boost::math::complement(distribution, 0.5 * (1.0 - confidence)));
}

double normalTwoSidedP(double z) {
    return 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), std::abs(z)));
}

WelchResult welchTest(std::span<const double> a, std::span<const double> b) {
    const Summary sa = summarize(a), sb = summarize(b);
    const double va = sa.variance / static_cast<double>(sa.count);
    const double vb = sb.variance / static_cast<double>(sb.count);
    WelchResult result;
    result.difference = sa.mean - sb.mean;
    result.standardError = std::sqrt(va + vb);
    if (result.standardError == 0.0) {
        result.pValue = result.difference == 0.0 ? 1.0 : 0.0;
        return result;
    }
    // Welch–Satterthwaite.
    result.degreesOfFreedom =
        (va + vb) * (va + vb) /
        (va * va / static_cast<double>(sa.count - 1) + vb * vb / static_cast<double>(sb.count - 1));
    result.pValue =
        studentTwoSidedP(result.difference / result.standardError, result.degreesOfFreedom);
    return result;
}

ChiSquareResult chiSquareTest(std::span<const double> observed, std::span<const double> expected) {
    ChiSquareResult result;
    double pooledObserved = 0.0, pooledExpected = 0.0;
    int cells = 0;
    const auto add = [&](double o, double e) {
        result.statistic += (o - e) * (o - e) / e;
        ++cells;
    };
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (expected[i] <= 0.0) {
            result.countInEmptyCells += observed[i];
        } else if (expected[i] < 5.0) {
            pooledObserved += observed[i];
            pooledExpected += expected[i];
        } else {
            add(observed[i], expected[i]);
        }
    }
    if (pooledExpected > 0.0) add(pooledObserved, pooledExpected);
    result.degreesOfFreedom = cells - 1;
    if (cells > 1) {
        const boost::math::chi_squared distribution(result.degreesOfFreedom);
        result.pValue = boost::math::cdf(boost::math::complement(distribution, result.statistic));
    }
    return result;
}

}  // namespace etendue
