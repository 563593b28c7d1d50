// The same radiance from every direction.
#include <limits>

#include "renderer/emission_disc.h"
#include "renderer/light.h"

namespace etendue {
namespace {

class ConstantLight final : public Light {
public:
    ConstantLight(Spectrum radiance, BoundingSphere scene) : radiance_(radiance), scene_(scene) {}

    float power() const override {
        return brightness(radiance_) * emissionDiscArea(scene_) / uniformSpherePdfSolidAngle;
    }

    std::optional<LightSample> sample(Vec3, Vec2 u) const override {
        const Vec3 direction = sampleUnitSphere(u);
        return LightSample{.direction = direction,
                           .distance = std::numeric_limits<float>::infinity(),
                           .position = {},
                           .positionError = {},
                           .normal = -direction,
                           .radiance = radiance_,
                           .pdfSolidAngle = uniformSpherePdfSolidAngle};
    }

    Spectrum radiance(const EmitterHit&) const override { return radiance_; }
    float pdfSolidAngle(const EmitterHit&) const override { return uniformSpherePdfSolidAngle; }

    std::optional<EmittedRay> emit(Vec2 uPosition, Vec2 uDirection) const override {
        EmittedRay ray;
        ray.direction = sampleUnitSphere(uDirection);
        ray.origin = sampleEmissionDisc(scene_, ray.direction, uPosition);
        ray.normal = ray.direction;
        ray.radiance = radiance_;
        ray.pdf = {emissionDiscPdfArea(scene_), uniformSpherePdfSolidAngle};
        return ray;
    }

    EmissionPdf emissionPdf(const EmitterHit&) const override {
        return {emissionDiscPdfArea(scene_), uniformSpherePdfSolidAngle};
    }

    bool isInfinite() const override { return true; }

private:
    Spectrum radiance_;
    BoundingSphere scene_;
};

}  // namespace

std::unique_ptr<Light> makeConstantLight(Spectrum radiance, BoundingSphere scene) {
    return std::make_unique<ConstantLight>(radiance, scene);
}

}  // namespace etendue
