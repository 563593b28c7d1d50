#include "statistics/flip_filters.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "statistics/flip.h"

namespace etendue {

namespace {

using std::numbers::pi;

Plane planeOf(int width, int height, const auto& value) {
    Plane plane{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) plane.values.push_back(static_cast<float>(value(x, y)));
    return plane;
}

float at(const Plane& plane, int x, int y) {
    const int column = std::clamp(x, 0, plane.width - 1), row = std::clamp(y, 0, plane.height - 1);
    return plane.values[static_cast<std::size_t>(row * plane.width + column)];
}

/// Σ weight(i, j) · plane(x + i, y + j), |i| and |j| up to `radius`.
double byBruteForce(const Plane& plane, int x, int y, int radius, const auto& weight) {
    double sum = 0.0;
    for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i)
            sum += weight(i, j) * static_cast<double>(at(plane, x + i, y + j));
    return sum;
}

/// `weight` multiplied so that all of it sums to 1.
auto normalized(int radius, const auto& weight) {
    double sum = 0.0;
    for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i) sum += weight(i, j);
    return [=](int i, int j) { return weight(i, j) / sum; };
}

double unevenPattern(int x, int y) {
    return std::sin(0.9 * x + 0.2 * y * y) + (x % 5 == y % 3 ? 1.0 : 0.0);
}

void checkEqual(const Plane& plane, const Plane& result, int radius, const auto& weight) {
    for (int y = 0; y < plane.height; ++y)
        for (int x = 0; x < plane.width; ++x) {
            CAPTURE(x);
            CAPTURE(y);
            // Two passes of 21 floats, each rounded to 6e-8 of values up to 2.
            REQUIRE(std::abs(at(result, x, y) - byBruteForce(plane, x, y, radius, weight)) < 1e-5);
        }
}

}  // namespace

TEST_CASE("FLIP filters: contrast sensitivity in two passes is that of the plane") {
    // Wider than high, smaller than the filter: rows and columns, and both edges at once.
    const Plane plane = planeOf(17, 12, unevenPattern);
    const double pixelsPerDegree = flipPixelsPerDegree();
    const auto gaussian = [=](double a, double b, int i, int j) {
        const double degrees2 = (i * i + j * j) / (pixelsPerDegree * pixelsPerDegree);
        return a * std::sqrt(pi / b) * std::exp(-pi * pi * degrees2 / b);
    };
    constexpr int radius = 10;  // ⌈3·√(0.04 / 2π²)·67.02⌉ = ⌈9.05⌉
    const auto check = [&](OpponentChannel channel, const auto& weight) {
        const ContrastSensitivity filter = contrastSensitivity(channel, pixelsPerDegree);
        CHECK(filter.first.size() == 2 * radius + 1);
        checkEqual(plane, filtered(plane, filter), radius, normalized(radius, weight));
    };
    check(OpponentChannel::achromatic, [&](int i, int j) { return gaussian(1.0, 0.0047, i, j); });
    check(OpponentChannel::redGreen, [&](int i, int j) { return gaussian(1.0, 0.0053, i, j); });
    check(OpponentChannel::blueYellow,
          [&](int i, int j) { return gaussian(34.1, 0.04, i, j) + gaussian(13.5, 0.025, i, j); });
}

TEST_CASE("FLIP filters: gratings pass as the contrast sensitivity says, exp(−b f²)") {
    const double pixelsPerDegree = flipPixelsPerDegree();
    for (const double cyclesPerDegree : {2.0, 8.0, 16.0}) {
        // The middle of 81 pixels is a crest, and no filter reaches the edges from there.
        const Plane grating = planeOf(81, 1, [=](int x, int) {
            return std::cos(2.0 * pi * cyclesPerDegree * (x - 40) / pixelsPerDegree);
        });
        CAPTURE(cyclesPerDegree);
        const auto crest = [&](OpponentChannel channel) {
            return at(filtered(grating, contrastSensitivity(channel, pixelsPerDegree)), 40, 0);
        };
        const double f2 = cyclesPerDegree * cyclesPerDegree;
        CHECK(std::abs(crest(OpponentChannel::achromatic) - std::exp(-0.0047 * f2)) < 1e-5);
        CHECK(std::abs(crest(OpponentChannel::redGreen) - std::exp(-0.0053 * f2)) < 1e-5);
    }
}

TEST_CASE("FLIP filters: features in two passes are those of the plane") {
    const Plane plane = planeOf(23, 14, unevenPattern);
    const double deviation = 0.5 * 0.082 * flipPixelsPerDegree();
    constexpr int radius = 9;  // ⌈3·2.75⌉
    const FeatureKernels kernels = featureKernels(flipPixelsPerDegree());
    const auto check = [&](const Kernel& kernel, const auto& weight) {
        REQUIRE(kernel.size() == 2 * radius + 1);
        double positive = 0.0, negative = 0.0;
        for (int j = -radius; j <= radius; ++j)
            for (int i = -radius; i <= radius; ++i)
                (weight(i, j) > 0.0 ? positive : negative) += std::abs(weight(i, j));
        const auto scaled = [=](int i, int j) {
            return weight(i, j) / (weight(i, j) > 0.0 ? positive : negative);
        };
        checkEqual(plane, filtered(plane, kernel, kernels.smooth), radius, scaled);
        checkEqual(plane, filtered(plane, kernels.smooth, kernel), radius,
                   [=](int i, int j) { return scaled(j, i); });
    };
    const auto bell = [=](int i, int j) {
        return std::exp(-(i * i + j * j) / (2.0 * deviation * deviation));
    };
    check(kernels.edge, [=](int i, int j) { return -i * bell(i, j); });
    check(kernels.point,
          [=](int i, int j) { return (i * i / (deviation * deviation) - 1.0) * bell(i, j); });
}

TEST_CASE("FLIP filters: the step from black to white is an edge of 1, an even plane none") {
    const FeatureKernels kernels = featureKernels(flipPixelsPerDegree());
    const Plane step = planeOf(41, 3, [](int x, int) { return x > 20 ? 1.0 : 0.0; });
    CHECK(std::abs(at(filtered(step, kernels.edge, kernels.smooth), 20, 1)) ==
          doctest::Approx(1.0).epsilon(1e-5));
    const Plane even = planeOf(41, 3, [](int, int) { return 0.5; });
    CHECK(std::abs(at(filtered(even, kernels.edge, kernels.smooth), 20, 1)) < 1e-6);
    CHECK(std::abs(at(filtered(even, kernels.smooth, kernels.point), 20, 1)) < 1e-6);
}

}  // namespace etendue
