#include "statistics/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "statistics/flip_filters.h"

namespace etendue {

namespace {

using Vec = std::array<float, 3>;
using Matrix = std::array<Vec, 3>;

// sRGB primaries, each row divided by its sum: white is (1, 1, 1). The papers' own numbers, whose
// XYZ of white is (0.950428545, 1, 1.088900371).
constexpr Matrix whiteScaledXyzFromRgb{{{0.43389539F, 0.37624237F, 0.18986224F},
                                        {0.21263682F, 0.71518298F, 0.07218020F},
                                        {0.01775242F, 0.10946563F, 0.87278195F}}};

Vec operator*(const Matrix& m, const Vec& v) {
    Vec result{};
    for (std::size_t row = 0; row < 3; ++row)
        result[row] = m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2];
    return result;
}

/// Cramer's rule.
Matrix inverse(const Matrix& m) {
    const auto cofactor = [&](std::size_t row, std::size_t column) {
        const std::size_t r1 = (row + 1) % 3, r2 = (row + 2) % 3;
        const std::size_t c1 = (column + 1) % 3, c2 = (column + 2) % 3;
        return static_cast<double>(m[r1][c1]) * m[r2][c2] -
               static_cast<double>(m[r1][c2]) * m[r2][c1];
    };
    const double determinant =
        m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
    Matrix result{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            result[row][column] = static_cast<float>(cofactor(column, row) / determinant);
    return result;
}

/// Of XYZ divided by that of white; opponent channels, linear in light or (after a cube root)
/// L*a*b*.
Vec opponentOf(const Vec& xyz) {
    return {116.0F * xyz[1] - 16.0F, 500.0F * (xyz[0] - xyz[1]), 200.0F * (xyz[1] - xyz[2])};
}
Vec xyzOf(const Vec& opponent) {
    const float y = (opponent[0] + 16.0F) / 116.0F;
    return {y + opponent[1] / 500.0F, y, y - opponent[2] / 200.0F};
}

float labCurve(float x) {
    constexpr float delta = 6.0F / 29.0F;
    return x > delta * delta * delta ? std::cbrt(x) : x / (3.0F * delta * delta) + 4.0F / 29.0F;
}

/// L*a*b*, less colourful where it is dark (Hunt).
Vec huntAdjustedLab(const Vec& rgb) {
    Vec xyz = whiteScaledXyzFromRgb * rgb;
    for (float& x : xyz) x = labCurve(x);
    Vec lab = opponentOf(xyz);
    lab[1] *= 0.01F * lab[0];
    lab[2] *= 0.01F * lab[0];
    return lab;
}

float hyAb(const Vec& a, const Vec& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// Andersson et al. 2020, equations 8 and 9: what is above 40 % of the greatest distance differs so
/// much that little is left to tell apart.
float colorError(float distance) {
    constexpr float exponent = 0.7F, knee = 0.4F, errorAtKnee = 0.95F;
    static const float greatest = std::pow(
        hyAb(huntAdjustedLab({0.0F, 1.0F, 0.0F}), huntAdjustedLab({0.0F, 0.0F, 1.0F})), exponent);
    const float error = std::pow(distance, exponent), kneeError = knee * greatest;
    if (error < kneeError) return errorAtKnee / kneeError * error;
    return errorAtKnee + (error - kneeError) / (greatest - kneeError) * (1.0F - errorAtKnee);
}

/// What the observer perceives of one picture.
struct Percept {
    std::vector<Vec> colors;  // after the eye's blur, Hunt-adjusted L*a*b*
    std::vector<float> edges, points;
};

std::vector<float> lengths(const Plane& x, const Plane& y) {
    std::vector<float> result(x.values.size());
    std::ranges::transform(x.values, y.values, result.begin(),
                           [](float a, float b) { return std::hypot(a, b); });
    return result;
}

Percept perceive(const Picture& rgb, int width, double pixelsPerDegree) {
    const std::size_t pixels = rgb.size() / 3;
    const Plane empty{width, static_cast<int>(pixels) / width, std::vector<float>(pixels)};
    std::array<Plane, 3> opponent{empty, empty, empty};
    Plane luminance = empty;
    for (std::size_t i = 0; i < pixels; ++i) {
        const Vec xyz = whiteScaledXyzFromRgb * Vec{rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]};
        const Vec channels = opponentOf(xyz);
        for (std::size_t c = 0; c < 3; ++c) opponent[c].values[i] = channels[c];
        luminance.values[i] = xyz[1];
    }

    const std::array channels{OpponentChannel::achromatic, OpponentChannel::redGreen,
                              OpponentChannel::blueYellow};
    for (std::size_t c = 0; c < 3; ++c)
        opponent[c] = filtered(opponent[c], contrastSensitivity(channels[c], pixelsPerDegree));
    static const Matrix rgbFromXyz = inverse(whiteScaledXyzFromRgb);
    Percept percept;
    percept.colors.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        Vec displayed = rgbFromXyz * xyzOf({opponent[0].values[i], opponent[1].values[i],
                                            opponent[2].values[i]});
        for (float& x : displayed) x = std::clamp(x, 0.0F, 1.0F);
        percept.colors[i] = huntAdjustedLab(displayed);
    }

    const FeatureKernels kernels = featureKernels(pixelsPerDegree);
    percept.edges = lengths(filtered(luminance, kernels.edge, kernels.smooth),
                            filtered(luminance, kernels.smooth, kernels.edge));
    percept.points = lengths(filtered(luminance, kernels.point, kernels.smooth),
                             filtered(luminance, kernels.smooth, kernels.point));
    return percept;
}

void requireSameSize(const Picture& a, const Picture& b, int width) {
    if (width < 1 || a.empty() || a.size() != b.size() ||
        a.size() % (std::size_t{3} * static_cast<std::size_t>(width)) != 0)
        throw std::invalid_argument("pictures to compare must have one size");
}

std::vector<double> luminancesOf(const Picture& picture) {
    std::vector<double> luminances;
    for (std::size_t i = 0; i + 2 < picture.size(); i += 3)
        luminances.push_back(0.2126 * std::max(picture[i], 0.0F) +
                             0.7152 * std::max(picture[i + 1], 0.0F) +
                             0.0722 * std::max(picture[i + 2], 0.0F));
    std::ranges::sort(luminances);
    return luminances;
}

double medianOf(std::span<const double> ascending) {
    const std::size_t count = ascending.size();
    return 0.5 * (ascending[(count - 1) / 2] + ascending[count / 2]);
}

// Coefficients of (k₀x² + k₁x) / (k₃x² + k₄x + k₅), x scaled by 0.6, as Narkowicz has it.
constexpr double k0 = 0.6 * 0.6 * 2.51, k1 = 0.6 * 0.03;
constexpr double k3 = 0.6 * 0.6 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;

/// x of which the tone curve makes `y`.
double inverseToneCurve(double y) {
    const double a = k0 - k3 * y, b = k1 - k4 * y, c = -k5 * y;
    return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

Picture toneMapped(const Picture& picture, double exposure) {
    Picture result(picture.size());
    const double scale = std::exp2(exposure);
    std::ranges::transform(picture, result.begin(), [scale](float x) {
        return static_cast<float>(acesToneCurve(scale * static_cast<double>(x)));
    });
    return result;
}

}  // namespace

double flipPixelsPerDegree() { return 0.7 * 3840.0 / 0.7 * std::numbers::pi / 180.0; }

double acesToneCurve(double x) {
    const double positive = std::max(x, 0.0);
    const double y = (k0 * positive + k1) * positive / ((k3 * positive + k4) * positive + k5);
    return std::min(y, 1.0);
}

FlipExposures flipExposures(const Picture& reference) {
    const std::vector<double> luminances = luminancesOf(reference);
    const double brightest = luminances.back();
    if (!(brightest > 0.0)) return {};
    double median = medianOf(luminances);
    if (!(median > 0.0))
        median = medianOf({std::ranges::upper_bound(luminances, 0.0), luminances.end()});
    const double middle = inverseToneCurve(0.85);
    const double start = std::log2(middle / brightest), stop = std::log2(middle / median);
    return {start, stop, std::max(2, static_cast<int>(std::ceil(stop - start)))};
}

std::vector<float> ldrFlip(const Picture& picture, const Picture& reference, int width,
                           double pixelsPerDegree) {
    requireSameSize(picture, reference, width);
    const Percept a = perceive(picture, width, pixelsPerDegree);
    const Percept r = perceive(reference, width, pixelsPerDegree);
    std::vector<float> errors(a.colors.size());
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const float feature =
            std::max(std::abs(a.edges[i] - r.edges[i]), std::abs(a.points[i] - r.points[i]));
        const float featureError =
            std::min(std::sqrt(feature / std::numbers::sqrt2_v<float>), 1.0F);
        errors[i] = std::pow(colorError(hyAb(a.colors[i], r.colors[i])), 1.0F - featureError);
    }
    return errors;
}

std::vector<float> hdrFlip(const Picture& picture, const Picture& reference, int width,
                           double pixelsPerDegree) {
    requireSameSize(picture, reference, width);
    const FlipExposures exposures = flipExposures(reference);
    std::vector<float> greatest(reference.size() / 3, 0.0F);
    for (int i = 0; i < exposures.count; ++i) {
        const double exposure = std::lerp(exposures.start, exposures.stop,
                                          i / static_cast<double>(exposures.count - 1));
        const std::vector<float> errors = ldrFlip(
            toneMapped(picture, exposure), toneMapped(reference, exposure), width, pixelsPerDegree);
        std::ranges::transform(greatest, errors, greatest.begin(),
                               [](float a, float b) { return std::max(a, b); });
    }
    return greatest;
}

double meanHdrFlip(const Picture& picture, const Picture& reference, int width) {
    const std::vector<float> flip = hdrFlip(picture, reference, width);
    return std::accumulate(flip.begin(), flip.end(), 0.0) / static_cast<double>(flip.size());
}

}  // namespace etendue
