// Triangles that emit the same radiance in all directions, from their front or from both sides.
#include <limits>

#include "renderer/distribution.h"
#include "renderer/frame.h"
#include "renderer/light.h"
#include "renderer/sampling.h"

namespace etendue {
namespace {

constexpr float largestFloat = std::numeric_limits<float>::max();

/// Twice the area, along the normal of the front side.
Vec3d areaVector(const EmissiveTriangle& t) {
    return cross(toDouble(t.b) - toDouble(t.a), toDouble(t.c) - toDouble(t.a));
}

/// Rounding of the position to float, and of the triangle inside the intersector: a few roundings
/// of its largest coordinate, whatever the axis, because they tilt its plane.
float positionErrorOf(const EmissiveTriangle& t) {
    constexpr float roundings = 8.0f, epsilon = 0x1p-24f;
    return roundings * epsilon * maxComponent(max(max(abs(t.a), abs(t.b)), abs(t.c)));
}

/// What sampling asks of a triangle.
struct Emitter {
    explicit Emitter(const EmissiveTriangle& t)
        : corner(toDouble(t.a)),
          edgeB(toDouble(t.b) - corner),
          edgeC(toDouble(t.c) - corner),
          normal(toFloat(normalize(areaVector(t)))),
          positionError(positionErrorOf(t)) {}

    Vec3d corner, edgeB, edgeC;
    Vec3 normal;  // meaningless without area; such a triangle is never chosen
    float positionError;
};

Distribution1D distributionByArea(const std::vector<EmissiveTriangle>& triangles) {
    std::vector<double> areas;
    areas.reserve(triangles.size());
    for (const EmissiveTriangle& t : triangles) areas.push_back(0.5 * length(areaVector(t)));
    return Distribution1D(areas);
}

class AreaLight final : public Light {
public:
    AreaLight(const std::vector<EmissiveTriangle>& triangles, Spectrum radiance, bool isTwoSided)
        : emitters_(triangles.begin(), triangles.end()),
          byArea_(distributionByArea(triangles)),
          inverseArea_(1.0 / byArea_.totalWeight()),
          radiance_(radiance),
          isTwoSided_(isTwoSided),
          smallestPdf_(
              std::max(std::numeric_limits<float>::min(), maxLane(radiance) / largestFloat)) {}

    float power() const override {
        return static_cast<float>(std::numbers::pi * (isTwoSided_ ? 2.0 : 1.0) * area() *
                                  brightness(radiance_));
    }

    std::optional<LightSample> sample(Vec3 receiver, Vec2 u) const override;
    Spectrum radiance(const EmitterHit& hit) const override {
        return emissionCosine(hit) > 0.0f ? radiance_ : Spectrum();
    }
    float pdfSolidAngle(const EmitterHit& hit) const override;
    std::optional<EmittedRay> emit(Vec2 uPosition, Vec2 uDirection) const override;
    EmissionPdf emissionPdf(const EmitterHit& hit) const override;
    bool isInfinite() const override { return false; }

private:
    struct SurfaceSample {
        Vec3d position;
        Vec3 positionError;
        Vec3 normal;
    };
    std::optional<SurfaceSample> sampleSurface(Vec2 u) const;

    double area() const { return byArea_.totalWeight(); }

    /// Between the normal and the light that leaves against `hit.direction`; zero on the dark side.
    float emissionCosine(const EmitterHit& hit) const {
        const float cosine = -dot(hit.direction, hit.normal);
        return isTwoSided_ ? std::abs(cosine) : std::max(cosine, 0.0f);
    }

    /// A density that floats cannot carry on (itself, or the radiance divided by it) counts as 0,
    /// for the light can then not be sampled: nearer than about 1e-19 or farther than 1e19 times
    /// its size.
    float representable(double pdf) const {
        return pdf >= smallestPdf_ && pdf <= largestFloat ? static_cast<float>(pdf) : 0.0f;
    }

    std::vector<Emitter> emitters_;
    Distribution1D byArea_;
    double inverseArea_;  // 1/m²
    Spectrum radiance_;
    bool isTwoSided_;
    float smallestPdf_;
};

std::optional<AreaLight::SurfaceSample> AreaLight::sampleSurface(Vec2 u) const {
    // Choosing one of n triangles uses up log2 n of the 24 bits of u.x: of a million triangles each
    // would be left with some sixteen lines of positions. The low twelve bits of u.y, finer than
    // any feature of the position along y, therefore continue u.x.
    const double fineY = 0x1p12 * u.y;
    const double x = u.x + 0x1p-24 * (fineY - std::floor(fineY));
    const auto chosen = byArea_.sample(x);
    if (!chosen) return {};
    const Emitter& e = emitters_[chosen->index];
    const Vec2 b = sampleTriangle({unitFloat(chosen->remainder), u.y});
    const Vec3d position = e.corner + e.edgeB * double{b.x} + e.edgeC * double{b.y};
    return SurfaceSample{position, {e.positionError, e.positionError, e.positionError}, e.normal};
}

std::optional<LightSample> AreaLight::sample(Vec3 receiver, Vec2 u) const {
    const auto surface = sampleSurface(u);
    if (!surface) return {};
    const Vec3d toLight = surface->position - toDouble(receiver);
    const double distance = length(toLight);
    if (distance == 0.0) return {};

    const Vec3 direction = toFloat(toLight * (1.0 / distance));
    const float pdf = pdfSolidAngle({direction, static_cast<float>(distance), surface->normal});
    if (pdf == 0.0f) return {};
    return LightSample{.direction = direction,
                       .distance = static_cast<float>(distance),
                       .position = toFloat(surface->position),
                       .positionError = surface->positionError,
                       .normal = surface->normal,
                       .radiance = radiance_,
                       .pdfSolidAngle = pdf};
}

float AreaLight::pdfSolidAngle(const EmitterHit& hit) const {
    const double cosine = emissionCosine(hit), distance = hit.distance;
    return cosine > 0.0 ? representable(distance * distance * inverseArea_ / cosine) : 0.0f;
}

std::optional<EmittedRay> AreaLight::emit(Vec2 uPosition, Vec2 uDirection) const {
    const auto surface = sampleSurface(uPosition);
    if (!surface) return {};
    EmittedRay ray;
    ray.origin = toFloat(surface->position);
    ray.originError = surface->positionError;
    ray.normal = surface->normal;
    if (isTwoSided_) {
        const bool isBack = uDirection.x >= 0.5f;
        uDirection.x = 2.0f * uDirection.x - (isBack ? 1.0f : 0.0f);
        if (isBack) ray.normal = -ray.normal;
    }
    ray.direction = Frame::fromZ(ray.normal).worldFromLocal(sampleCosineHemisphere(uDirection));
    ray.radiance = radiance_;
    ray.cosTheta = dot(ray.direction, ray.normal);
    ray.pdf = emissionPdf({-ray.direction, 0.0f, ray.normal});
    if (ray.cosTheta <= 0.0f || ray.pdf.pdfArea == 0.0f) return {};
    return ray;
}

EmissionPdf AreaLight::emissionPdf(const EmitterHit& hit) const {
    const float sides = isTwoSided_ ? 0.5f : 1.0f;
    return {representable(inverseArea_),
            sides * cosineHemispherePdfSolidAngle(emissionCosine(hit))};
}

}  // namespace

std::unique_ptr<Light> makeAreaLight(std::vector<EmissiveTriangle> triangles, Spectrum radiance,
                                     bool isTwoSided) {
    return std::make_unique<AreaLight>(triangles, radiance, isTwoSided);
}

}  // namespace etendue
