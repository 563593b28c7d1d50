// A point that shines alike in all directions.
#include "renderer/point_source.h"
#include "renderer/sampling.h"

namespace etendue {
namespace {

class PointLight final : public Light {
public:
    PointLight(Vec3 position, Spectrum intensity) : position_(position), intensity_(intensity) {}

    float power() const override { return brightness(intensity_) / uniformSpherePdfSolidAngle; }

    std::optional<LightSample> sample(Vec3 receiver, Vec2) const override {
        return sampleFromPoint(position_, intensity_, receiver);
    }

    Spectrum radiance(const EmitterHit&) const override { return {}; }
    float pdfSolidAngle(const EmitterHit&) const override { return 0.0f; }

    std::optional<EmittedRay> emit(Vec2, Vec2 uDirection) const override {
        EmittedRay ray;
        ray.origin = position_;
        ray.direction = sampleUnitSphere(uDirection);
        ray.normal = ray.direction;
        ray.radiance = intensity_;
        ray.pdf = {1.0f, uniformSpherePdfSolidAngle};
        ray.isDiracPosition = true;
        return ray;
    }

    EmissionPdf emissionPdf(const EmitterHit&) const override {
        return {1.0f, uniformSpherePdfSolidAngle};
    }

    bool isInfinite() const override { return false; }

private:
    Vec3 position_;
    Spectrum intensity_;
};

}  // namespace

std::unique_ptr<Light> makePointLight(Vec3 position, Spectrum intensity) {
    return std::make_unique<PointLight>(position, intensity);
}

}  // namespace etendue
