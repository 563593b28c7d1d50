#include <algorithm>
#include <cmath>
#include <optional>

#include "renderer/bsdf_parts.h"
#include "renderer/bsdfs.h"
#include "renderer/energy_compensation.h"
#include "renderer/ggx.h"
#include "renderer/sampling.h"

namespace etendue {

namespace {

struct BaseAlbedo {
    Spectrum lanes;
    /// Of the RGB: what lobes are drawn by is then the same whichever wavelength is the hero, so
    /// that samples of several heroes can be weighed against each other.
    float brightness;
};

/// The base, seen through a coat that lets T(μ) of the light at cosine μ in. What it sends out is
///
///     f = T(μo) T(μi) / (π Tavg) · ρ (1 − Fi) / (1 − ρ Fi),      1 − Fi = Tavg / ior²,
///
/// Fi being what the coat throws back to the base, by the reciprocity of its transmittance (Jakob
/// et al. 2014, "A Comprehensive Framework for Rendering Layered Materials", for the model). A
/// white base returns all that came in.
class Base {
public:
    Base(Texture reflectance, float ior, float averageTransmittance)
        : reflectance_(std::move(reflectance)),
          inverseAverage_(1.0f / averageTransmittance),
          // Less dense than air, a rough coat could let more in than can come out, since what
          // single scattering loses counts as let in.
          leaving_(std::min(1.0f, averageTransmittance / (ior * ior))) {}

    /// Of the light that got in, the share that comes out.
    BaseAlbedo albedo(const BsdfContext& context) const {
        const auto albedoOf = [&](const Spectrum& rho) {
            return rho * leaving_ / (Spectrum(1.0f) - rho * (1.0f - leaving_));
        };
        const Spectrum color = reflectance_.color(context.uv), rgb = albedoOf(color);
        const Spectrum lanes =
            context.wavelengths.isSpectral ? albedoOf(context.wavelengths.lanesOf(color)) : rgb;
        return {lanes, brightness(rgb)};
    }
    Spectrum f(const Spectrum& albedo, float transmittanceO, float transmittanceI) const {
        return albedo * (transmittanceO * transmittanceI * inverseAverage_ * inversePi);
    }

private:
    Texture reflectance_;
    float inverseAverage_, leaving_;
};

/// Probability of drawing from the coat rather than from the base: their shares of the light.
float coatProbability(float transmittance, const BaseAlbedo& baseAlbedo) {
    const float coat = 1.0f - transmittance, base = transmittance * baseAlbedo.brightness;
    return coat > 0.0f ? coat / (coat + base) : 0.0f;
}

Vec3 upward(Vec3 w) { return w.z < 0.0f ? flipped(w) : w; }

class SmoothPlastic final : public Bsdf {
public:
    SmoothPlastic(Texture diffuse, float ior)
        : ior_(ior),
          averageTransmittance_(1.0f - static_cast<float>(fresnelDielectricAverage(ior))),
          base_(std::move(diffuse), ior, averageTransmittance_) {}

    BsdfValue evaluate(const BsdfContext& context, Vec3 wo, Vec3 wi) const override {
        if (isInSurface(wo) || isInSurface(wi) || (wo.z > 0.0f) != (wi.z > 0.0f)) return {};
        const float cosO = std::abs(wo.z), cosI = std::abs(wi.z);
        const float throughO = transmittance(cosO), throughI = transmittance(cosI);
        const BaseAlbedo albedo = base_.albedo(context);
        return {base_.f(albedo.lanes, throughO, throughI),
                (1.0f - coatProbability(throughO, albedo)) * cosI * inversePi,
                (1.0f - coatProbability(throughI, albedo)) * cosO * inversePi};
    }

    std::optional<BsdfSample> sample(const BsdfContext& context, Vec3 wo, float uLobe,
                                     Vec2 u) const override {
        if (isInSurface(wo)) return std::nullopt;
        const float through = transmittance(std::abs(wo.z));
        const float coat = coatProbability(through, base_.albedo(context));
        if (uLobe < coat)
            return diracSample({-wo.x, -wo.y, wo.z}, Spectrum((1.0f - through) / coat), coat, coat);
        Vec3 wi = sampleCosineHemisphere(u);
        wi.z = std::copysign(wi.z, wo.z);
        return continuousSample(wi, evaluate(context, wo, wi));
    }

    bool isDirac() const override { return false; }
    bool isTransmitting() const override { return false; }
    Spectrum albedo(const BsdfContext& context) const override {
        return Spectrum(1.0f - averageTransmittance_) +
               base_.albedo(context).lanes * averageTransmittance_;
    }

private:
    float transmittance(float cosine) const {
        return 1.0f - fresnelDielectric(std::min(cosine, 1.0f), ior_).reflectance;
    }

    float ior_, averageTransmittance_;
    Base base_;
};

class RoughPlastic final : public Bsdf {
public:
    RoughPlastic(Texture diffuse, float ior, float alpha)
        : ior_(ior),
          ggx_(alpha),
          transmittance_(coatTransmittanceTable(alpha, ior)),
          base_(std::move(diffuse), ior, transmittance_.average()) {}

    BsdfValue evaluate(const BsdfContext& context, Vec3 wo, Vec3 wi) const override {
        if (wo.z < 0.0f) {
            wo = flipped(wo);
            wi = flipped(wi);
        }
        if (isInSurface(wo) || isInSurface(wi) || wi.z < 0.0f) return {};
        const float throughO = transmittance_.at(wo.z), throughI = transmittance_.at(wi.z);
        const BaseAlbedo albedo = base_.albedo(context);
        const float coatO = coatProbability(throughO, albedo);
        const float coatI = coatProbability(throughI, albedo);
        BsdfValue value{base_.f(albedo.lanes, throughO, throughI),
                        (1.0f - coatO) * wi.z * inversePi, (1.0f - coatI) * wo.z * inversePi};
        if (const auto facet = reflectingMicrofacet(wo, wi)) {
            const float density = ggx_.density(facet->normal) * facet->transfer;
            const float reflected = fresnelDielectric(facet->cosineO, ior_).reflectance;
            value.f += Spectrum(reflected * density * ggx_.g2OverCosines(wo, wi));
            value.pdfSolidAngle += coatO * density * ggx_.g1OverCosine(wo);
            value.pdfSolidAngleReverse += coatI * density * ggx_.g1OverCosine(wi);
        }
        return value;
    }

    std::optional<BsdfSample> sample(const BsdfContext& context, Vec3 wo, float uLobe,
                                     Vec2 u) const override {
        if (isInSurface(wo)) return std::nullopt;
        const Vec3 above = upward(wo);
        const float coat = coatProbability(transmittance_.at(above.z), base_.albedo(context));
        const Vec3 wi = uLobe < coat ? reflect(above, ggx_.sampleVisibleNormal(above, u))
                                     : sampleCosineHemisphere(u);
        if (!(wi.z > 0.0f)) return std::nullopt;
        return continuousSample(wo.z < 0.0f ? flipped(wi) : wi, evaluate(context, above, wi));
    }

    bool isDirac() const override { return false; }
    bool isTransmitting() const override { return false; }
    Spectrum albedo(const BsdfContext& context) const override {
        return Spectrum(1.0f - transmittance_.average()) +
               base_.albedo(context).lanes * transmittance_.average();
    }

private:
    float ior_;
    Ggx ggx_;
    EnergyTable transmittance_;
    Base base_;
};

}  // namespace

std::unique_ptr<Bsdf> makePlastic(Texture diffuse, float ior, float roughness) {
    const float alpha = alphaFromRoughness(roughness);
    if (alpha < smallestAlpha) return std::make_unique<SmoothPlastic>(std::move(diffuse), ior);
    return std::make_unique<RoughPlastic>(std::move(diffuse), ior, alpha);
}

}  // namespace etendue
