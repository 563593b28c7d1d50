// Parallel light, as from a sun without extent.
#include <limits>

#include "renderer/emission_disc.h"
#include "renderer/light.h"

namespace etendue {
namespace {

class DirectionalLight final : public Light {
public:
    DirectionalLight(Vec3 direction, Spectrum irradiance, BoundingSphere scene)
        : direction_(direction), irradiance_(irradiance), scene_(scene) {}

    float power() const override { return brightness(irradiance_) * emissionDiscArea(scene_); }

    std::optional<LightSample> sample(Vec3, Vec2) const override {
        LightSample result{};
        result.direction = -direction_;
        result.distance = std::numeric_limits<float>::infinity();
        result.normal = direction_;
        result.radiance = irradiance_;
        result.pdfSolidAngle = 1.0f;
        result.isDirac = true;
        return result;
    }

    Spectrum radiance(const EmitterHit&) const override { return {}; }
    float pdfSolidAngle(const EmitterHit&) const override { return 0.0f; }

    std::optional<EmittedRay> emit(Vec2 uPosition, Vec2) const override {
        EmittedRay ray;
        ray.origin = sampleEmissionDisc(scene_, direction_, uPosition);
        ray.normal = direction_;
        ray.direction = direction_;
        ray.radiance = irradiance_;
        ray.pdf = {emissionDiscPdfArea(scene_), 1.0f};
        ray.isDiracDirection = true;
        return ray;
    }

    EmissionPdf emissionPdf(const EmitterHit&) const override {
        return {emissionDiscPdfArea(scene_), 1.0f};
    }

    bool isInfinite() const override { return true; }

private:
    Vec3 direction_;
    Spectrum irradiance_;
    BoundingSphere scene_;
};

}  // namespace

std::unique_ptr<Light> makeDirectionalLight(Vec3 direction, Spectrum irradiance,
                                            BoundingSphere scene) {
    return std::make_unique<DirectionalLight>(direction, irradiance, scene);
}

}  // namespace etendue
