#include "renderer/filter.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

namespace etendue {

namespace {

// Each filter is even; below, x ≥ 0 runs from its centre to its edge at 1, and `mass` is what lies
// between the centre and x, 1 in all.

double boxMass(double x) { return x; }
double boxDensity(double) { return 1.0; }

constexpr double gaussianScale = std::numbers::sqrt2 / 3.0;  // √2 standard deviations

double gaussianMass(double x) {
    static const double whole = std::erf(1.0 / gaussianScale);
    return std::erf(x / gaussianScale) / whole;
}

double gaussianDensity(double x) {
    static const double peak =
        2.0 * std::numbers::inv_sqrtpi / (gaussianScale * std::erf(1.0 / gaussianScale));
    const double t = x / gaussianScale;
    return peak * std::exp(-t * t);
}

// Harris 1978, "On the Use of Windows for Harmonic Analysis with the Discrete Fourier Transform",
// the minimum four-term window: 6e-5 of its peak at the edge, never zero.
constexpr std::array harris = {0.35875, 0.48829, 0.14128, 0.01168};

double blackmanHarrisMass(double x) {
    const double t = std::numbers::pi * x;
    const double sines = harris[1] * std::sin(t) + harris[2] / 2.0 * std::sin(2.0 * t) +
                         harris[3] / 3.0 * std::sin(3.0 * t);
    return x + sines / (std::numbers::pi * harris[0]);
}

double blackmanHarrisDensity(double x) {
    const double c = std::cos(std::numbers::pi * x);
    const double cos2 = 2.0 * c * c - 1.0, cos3 = (4.0 * c * c - 3.0) * c;
    return 1.0 + (harris[1] * c + harris[2] * cos2 + harris[3] * cos3) / harris[0];
}

struct Shape {
    double (*mass)(double);
    double (*density)(double);  // the derivative of mass
    float defaultRadius;
};

const Shape& shapeOf(FilterKind kind) {
    static constexpr Shape shapes[] = {
        {boxMass, boxDensity, 0.5f},
        {gaussianMass, gaussianDensity, 1.5f},
        {blackmanHarrisMass, blackmanHarrisDensity, 1.5f},
    };
    return shapes[static_cast<int>(kind)];
}

}  // namespace

/// The inverse of a shape's mass. Between equidistant places it is the cubic in the mass that fits
/// value and derivative at both ends: off by less than 1.5e-8 in mass, which is finer than a float
/// random number.
struct Filter::Table {
    static constexpr int cells = 128, guides = 256;

    /// The place is ((d r + c) r + b) r + a, r in [0, 1) being the share of the cell's mass.
    struct alignas(64) Cell {
        double begin, end, inverseWhole;  // of the mass
        double a, b, c, d;
    };
    std::array<Cell, cells> cell;
    std::array<std::uint8_t, guides> cellFromMass;  // that in which mass i / guides is reached

    explicit Table(const Shape& shape) {
        for (std::size_t i = 0; i < cells; ++i) {
            const double x = static_cast<double>(i) / cells, width = 1.0 / cells;
            const double begin = shape.mass(x);
            const double end = i + 1 == cells ? 1.0 : shape.mass(x + width), whole = end - begin;
            const double slope = whole / shape.density(x),
                         slopeAtEnd = whole / shape.density(x + width);
            cell[i] = {begin,
                       end,
                       1.0 / whole,
                       x,
                       slope,
                       3.0 * width - 2.0 * slope - slopeAtEnd,
                       slope + slopeAtEnd - 2.0 * width};
        }
        int reached = 0;
        for (std::size_t i = 0; i < guides; ++i) {
            reached = cellAt(static_cast<double>(i) / guides, reached);
            cellFromMass[i] = static_cast<std::uint8_t>(reached);
        }
    }

    /// The cell that holds `m` < 1, which lies in `from` or after it.
    int cellAt(double m, int from) const {
        while (cell[static_cast<std::size_t>(from)].end <= m) ++from;
        return from;
    }

    /// x such that `m` lies between the centre and x; 1 for m = 1.
    double inverse(double m) const {
        if (m >= 1.0) return 1.0;
        const int i = cellAt(m, cellFromMass[static_cast<std::size_t>(m * guides)]);
        const Cell& at = cell[static_cast<std::size_t>(i)];
        const double r = (m - at.begin) * at.inverseWhole;
        return ((at.d * r + at.c) * r + at.b) * r + at.a;
    }
};

float defaultRadius(FilterKind kind) { return shapeOf(kind).defaultRadius; }

Filter::Filter(FilterKind kind, float radius)
    : kind_(kind), radius_(radius), peak_(0.5 / radius), table_(&tableOf(kind)) {
    if (!(radius > 0.0f && std::isfinite(radius)))
        throw std::invalid_argument("the filter's radius must be positive");
}

const Filter::Table& Filter::tableOf(FilterKind kind) {
    static const std::array<Table, 3> tables = {Table(shapeOf(FilterKind::box)),
                                                Table(shapeOf(FilterKind::gaussian)),
                                                Table(shapeOf(FilterKind::blackmanHarris))};
    return tables[static_cast<std::size_t>(kind)];
}

float Filter::sampleAxis(float u) const {
    const double signedMass = 2.0 * u - 1.0;
    const auto x = static_cast<float>(table_->inverse(std::abs(signedMass)));
    return signedMass < 0.0 ? -x * radius_ : x * radius_;
}

double Filter::relativeToBox(float offset) const {
    return shapeOf(kind_).density(std::abs(offset / radius_));
}

Vec2 Filter::sample(Vec2 u) const {
    if (kind_ == FilterKind::box) return (u - Vec2{0.5f, 0.5f}) * (2.0f * radius_);
    return {sampleAxis(u.x), sampleAxis(u.y)};
}

}  // namespace etendue
