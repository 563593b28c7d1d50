// A latitude-longitude image at infinity.
//
// In the light's own space, seen from inside by an upright viewer: the image's top row is +y (up),
// its bottom row −y, its centre column +z (ahead), and columns to the right of it lie to the right,
// towards −x; the left and right edges meet behind, at −z. At x across the image (0 left, 1 right)
// and y down it (0 top, 1 bottom), with longitude φ = 2π (x − ½) and polar angle θ = π y, the
// direction is
//
//     (−sin θ sin φ, cos θ, sin θ cos φ).
//
// Radiance is bilinear between the centres of texels, across the edges behind, and constant in θ
// between a pole and the centres next to it. A texel is drawn in proportion to the light that this
// interpolant sends through it; within the texel directions are uniform in solid angle.
#include <limits>
#include <string>

#include "config/config.h"
#include "renderer/distribution.h"
#include "renderer/emission_disc.h"
#include "renderer/light.h"

namespace etendue {
namespace {

using Vec2d = Vec2T<double>;

/// Solid angle of a row, and the parts of it by which the rows above, at and below it count in the
/// integral of the interpolant over it; per radian of longitude.
struct RowWeights {
    double above, self, below;
};

RowWeights rowWeights(int y, int height) {
    // Over half a row, [c − q, c + q], the weight of the neighbour on that side falls linearly from
    // 1/2 at the border to 0 at the centre, so the integral of weight · sin θ is
    // (sin c sin q ∓ cos c (sin q / q − cos q)) / 2, with c − q or c + q at the border.
    const double q = std::numbers::pi / (4.0 * height);
    const double slope = std::sin(q) / q - std::cos(q);
    const auto neighbour = [&](double c, double side) {
        return 0.5 * (std::sin(c) * std::sin(q) + side * std::cos(c) * slope);
    };
    const double above = neighbour((4 * y + 1) * q, -1.0), below = neighbour((4 * y + 3) * q, 1.0);
    const double whole = 2.0 * std::sin((4 * y + 2) * q) * std::sin(2.0 * q);
    return {above, whole - above - below, below};
}

/// For every texel, row by row: the integral over its solid angle of the interpolated brightness.
/// Throws InputError for light that is negative or past the range of a float.
std::vector<double> texelWeights(const Texture& image, float scale) {
    const int width = image.width(), height = image.height();
    const auto at = [width](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    };
    std::vector<double> texels(at(0, height)), averages(texels.size()), weights(texels.size());
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Spectrum value = image.texel(x, y) * scale;
            for (int lane = 0; lane < Spectrum::lanes; ++lane)
                if (!(value[lane] >= 0.0f && std::isfinite(value[lane])))
                    throw InputError("environment image: texel (" + std::to_string(x) + ", " +
                                     std::to_string(y) +
                                     "): expected radiance from 0 to 3e38, scale included");
            texels[at(x, y)] = brightness(value);
        }
        // Across a texel's width the interpolant averages to these parts of it and its neighbours.
        for (int x = 0; x < width; ++x)
            averages[at(x, y)] =
                0.75 * texels[at(x, y)] +
                0.125 * (texels[at((x + width - 1) % width, y)] + texels[at((x + 1) % width, y)]);
    }
    const double texelLongitude = 2.0 * std::numbers::pi / width;
    for (int y = 0; y < height; ++y) {
        const RowWeights row = rowWeights(y, height);
        const int above = std::max(y - 1, 0), below = std::min(y + 1, height - 1);
        for (int x = 0; x < width; ++x)
            weights[at(x, y)] = texelLongitude * (row.above * averages[at(x, above)] +
                                                  row.self * averages[at(x, y)] +
                                                  row.below * averages[at(x, below)]);
    }
    return weights;
}

class EnvironmentLight final : public Light {
public:
    EnvironmentLight(std::shared_ptr<const Texture> image, float scale,
                     const Transform& worldFromLight, BoundingSphere scene)
        : image_(std::move(image)),
          scale_(scale),
          worldFromLight_(worldFromLight),
          lightFromWorld_(worldFromLight.inverse()),
          scene_(scene),
          texels_(image_->width(), image_->height(), texelWeights(*image_, scale)) {
        const int height = image_->height();
        const double halfRow = std::numbers::pi / (2.0 * height);
        for (int y = 0; y <= height; ++y) rowCosines_.push_back(std::cos(2 * y * halfRow));
        // Within a row the map from the unit square to the sphere is linear in cos θ and in φ; the
        // difference of the cosines is written so that none of it cancels near the poles.
        for (int y = 0; y < height; ++y)
            solidAnglePerSquare_.push_back(4.0 * std::numbers::pi * height *
                                           std::sin((2 * y + 1) * halfRow) * std::sin(halfRow));
    }

    float power() const override {
        return static_cast<float>(texels_.totalWeight() * emissionDiscArea(scene_));
    }

    std::optional<LightSample> sample(Vec3, Vec2 u) const override {
        const auto direction = sampleDirection(u);
        if (!direction) return {};
        LightSample result{};
        result.direction = *direction;
        result.distance = std::numeric_limits<float>::infinity();
        result.normal = -result.direction;
        const Vec2d point = imagePoint(result.direction);
        result.radiance = radianceAt(point);
        result.pdfSolidAngle = pdfSolidAngleAt(point);
        if (result.pdfSolidAngle == 0.0f) return {};
        return result;
    }

    Spectrum radiance(const EmitterHit& hit) const override {
        return radianceAt(imagePoint(hit.direction));
    }
    float pdfSolidAngle(const EmitterHit& hit) const override {
        return pdfSolidAngleAt(imagePoint(hit.direction));
    }

    std::optional<EmittedRay> emit(Vec2 uPosition, Vec2 uDirection) const override {
        const auto towardsLight = sampleDirection(uDirection);
        if (!towardsLight) return {};
        EmittedRay ray;
        ray.direction = -*towardsLight;
        ray.origin = sampleEmissionDisc(scene_, ray.direction, uPosition);
        ray.normal = ray.direction;
        const Vec2d point = imagePoint(*towardsLight);
        ray.radiance = radianceAt(point);
        ray.pdf = {emissionDiscPdfArea(scene_), pdfSolidAngleAt(point)};
        if (ray.pdf.pdfSolidAngle == 0.0f) return {};
        return ray;
    }

    EmissionPdf emissionPdf(const EmitterHit& hit) const override {
        return {emissionDiscPdfArea(scene_), pdfSolidAngleAt(imagePoint(hit.direction))};
    }

    bool isInfinite() const override { return true; }

private:
    /// In texels: x from 0 to the image's width, y down from 0 to its height.
    Vec2d imagePoint(Vec3 direction) const;
    /// Towards the light. Rounding to float may carry it over the border of the texel drawn, so
    /// radiance and density are asked of the direction and not of the texel.
    std::optional<Vec3> sampleDirection(Vec2 u) const;
    Spectrum radianceAt(Vec2d p) const;
    float pdfSolidAngleAt(Vec2d p) const;

    std::shared_ptr<const Texture> image_;
    float scale_;
    Transform worldFromLight_, lightFromWorld_;
    BoundingSphere scene_;
    Distribution2D texels_;
    std::vector<double> rowCosines_;           // at the rows' borders, from the top
    std::vector<double> solidAnglePerSquare_;  // of each row, per area of the unit square
};

Vec2d EnvironmentLight::imagePoint(Vec3 direction) const {
    const Vec3 d = toFloat(lightFromWorld_.vector(toDouble(direction)));
    const float longitude = std::atan2(-d.x, d.z);
    // Not the arc cosine of y, which cannot tell directions near a pole apart.
    const float theta = std::atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y);
    // Float angles may round past π; the image ends there.
    return {std::clamp(0.5 + longitude * (0.5 * std::numbers::inv_pi), 0.0, 1.0) * image_->width(),
            std::min(theta * std::numbers::inv_pi, 1.0) * image_->height()};
}

std::optional<Vec3> EnvironmentLight::sampleDirection(Vec2 u) const {
    const auto texel = texels_.sample({u.x, u.y});
    if (!texel) return {};
    const double phi =
        2.0 * std::numbers::pi * ((texel->x + texel->remainder.x) / image_->width() - 0.5);
    const auto row = static_cast<std::size_t>(texel->y);
    const double cosTheta =
        rowCosines_[row] + texel->remainder.y * (rowCosines_[row + 1] - rowCosines_[row]);
    const double sinTheta = std::sqrt(std::max(0.0, (1.0 - cosTheta) * (1.0 + cosTheta)));
    return toFloat(
        worldFromLight_.vector({-sinTheta * std::sin(phi), cosTheta, sinTheta * std::cos(phi)}));
}

Spectrum EnvironmentLight::radianceAt(Vec2d p) const {
    const int width = image_->width(), height = image_->height();
    const double left = std::floor(p.x - 0.5), top = std::floor(p.y - 0.5);
    const auto towardsRight = static_cast<float>(p.x - 0.5 - left);
    const auto towardsBottom = static_cast<float>(p.y - 0.5 - top);
    const int x0 = (static_cast<int>(left) + width) % width, x1 = (x0 + 1) % width;
    const int y0 = std::max(static_cast<int>(top), 0);
    const int y1 = std::min(static_cast<int>(top) + 1, height - 1);
    // Equal values interpolate to exactly that value.
    const auto mix = [](Spectrum a, Spectrum b, float t) { return a + (b - a) * t; };
    const auto row = [&](int y) {
        return mix(image_->texel(x0, y), image_->texel(x1, y), towardsRight);
    };
    return mix(row(y0), row(y1), towardsBottom) * scale_;
}

float EnvironmentLight::pdfSolidAngleAt(Vec2d p) const {
    const int width = image_->width(), height = image_->height();
    const int x = static_cast<int>(p.x) % width, y = std::min(static_cast<int>(p.y), height - 1);
    return static_cast<float>(texels_.density(x, y) /
                              solidAnglePerSquare_[static_cast<std::size_t>(y)]);
}

}  // namespace

std::unique_ptr<Light> makeEnvironmentLight(std::shared_ptr<const Texture> image, float scale,
                                            const Transform& worldFromLight, BoundingSphere scene) {
    return std::make_unique<EnvironmentLight>(std::move(image), scale, worldFromLight, scene);
}

}  // namespace etendue
