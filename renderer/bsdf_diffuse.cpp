#include "renderer/bsdf_parts.h"
#include "renderer/bsdfs.h"
#include "renderer/sampling.h"

namespace etendue {

namespace {

class Diffuse final : public Bsdf {
public:
    explicit Diffuse(Texture reflectance) : reflectance_(std::move(reflectance)) {}

    BsdfValue evaluate(const BsdfContext& context, Vec3 wo, Vec3 wi) const override {
        if (isInSurface(wo) || isInSurface(wi) || (wo.z > 0.0f) != (wi.z > 0.0f)) return {};
        return {albedo(context) * inversePi, std::abs(wi.z) * inversePi,
                std::abs(wo.z) * inversePi};
    }

    std::optional<BsdfSample> sample(const BsdfContext& context, Vec3 wo, float,
                                     Vec2 u) const override {
        Vec3 wi = sampleCosineHemisphere(u);
        wi.z = std::copysign(wi.z, wo.z);
        return continuousSample(wi, evaluate(context, wo, wi));
    }

    bool isDirac() const override { return false; }
    bool isTransmitting() const override { return false; }
    Spectrum albedo(const BsdfContext& context) const override {
        return context.wavelengths.lanesOf(reflectance_.color(context.uv));
    }

private:
    Texture reflectance_;
};

}  // namespace

std::unique_ptr<Bsdf> makeDiffuse(Texture reflectance) {
    return std::make_unique<Diffuse>(std::move(reflectance));
}

}  // namespace etendue
