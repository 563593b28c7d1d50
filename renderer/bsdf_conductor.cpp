#include <numbers>
#include <variant>

#include "renderer/bsdf_parts.h"
#include "renderer/bsdfs.h"
#include "renderer/energy_compensation.h"
#include "renderer/ggx.h"

namespace etendue {

namespace {

/// What one facet reflects: a metal by Fresnel's equations, or the same at every angle.
using Facet = std::variant<ConductorOptics, Spectrum>;

Spectrum reflectance(const Facet& facet, float cosine) {
    if (const auto* optics = std::get_if<ConductorOptics>(&facet))
        return fresnelConductor(cosine, *optics);
    return std::get<Spectrum>(facet);
}

Spectrum averageReflectance(const Facet& facet) {
    if (const auto* optics = std::get_if<ConductorOptics>(&facet))
        return fresnelConductorAverage(*optics);
    return std::get<Spectrum>(facet);
}

class Mirror final : public Bsdf {
public:
    explicit Mirror(const Facet& facet) : facet_(facet), albedo_(averageReflectance(facet)) {}

    BsdfValue evaluate(const BsdfContext&, Vec3, Vec3) const override { return {}; }

    std::optional<BsdfSample> sample(const BsdfContext& context, Vec3 wo, float,
                                     Vec2) const override {
        if (isInSurface(wo)) return std::nullopt;
        const Spectrum reflected = reflectance(facet_, std::min(std::abs(wo.z), 1.0f));
        return diracSample({-wo.x, -wo.y, wo.z}, context.wavelengths.lanesOf(reflected), 1.0f,
                           1.0f);
    }

    bool isDirac() const override { return true; }
    bool isTransmitting() const override { return false; }
    Spectrum albedo(const BsdfContext&) const override { return albedo_; }

private:
    Facet facet_;
    Spectrum albedo_;
};

class RoughConductor final : public Bsdf {
public:
    RoughConductor(const Facet& facet, float alpha)
        : facet_(facet),
          albedo_(averageReflectance(facet)),
          ggx_(alpha),
          loss_(reflectorLossTable(alpha)),
          multipleScattering_(multipleScatteringColor(albedo_, loss_.average())),
          lobeScale_(inversePi / loss_.average()) {}

    BsdfValue evaluate(const BsdfContext& context, Vec3 wo, Vec3 wi) const override {
        if (wo.z < 0.0f) {
            wo = flipped(wo);
            wi = flipped(wi);
        }
        if (isInSurface(wo) || isInSurface(wi) || wi.z < 0.0f) return {};
        // Several bounces between microfacets…
        const float lossO = loss_.at(wo.z), lossI = loss_.at(wi.z);
        const float lobe = lossO * lossI * lobeScale_;
        BsdfValue value{multipleScattering_ * lobe, lobe * wi.z, lobe * wo.z};
        // … and one.
        if (const auto facet = reflectingMicrofacet(wo, wi)) {
            const float density = ggx_.density(facet->normal) * facet->transfer;
            value.f += reflectance(facet_, facet->cosineO) * (density * ggx_.g2OverCosines(wo, wi));
            value.pdfSolidAngle += (1.0f - lossO) * density * ggx_.g1OverCosine(wo);
            value.pdfSolidAngleReverse += (1.0f - lossI) * density * ggx_.g1OverCosine(wi);
        }
        value.f = context.wavelengths.lanesOf(value.f);
        return value;
    }

    std::optional<BsdfSample> sample(const BsdfContext& context, Vec3 wo, float uLobe,
                                     Vec2 u) const override {
        if (isInSurface(wo)) return std::nullopt;
        const Vec3 above = wo.z < 0.0f ? flipped(wo) : wo;
        const Vec3 wi = uLobe < loss_.at(above.z)
                            ? directionAround(loss_.sample(u.x), u.y)
                            : reflect(above, ggx_.sampleVisibleNormal(above, u));
        if (!(wi.z > 0.0f)) return std::nullopt;
        return continuousSample(wo.z < 0.0f ? flipped(wi) : wi, evaluate(context, above, wi));
    }

    bool isDirac() const override { return false; }
    bool isTransmitting() const override { return false; }
    Spectrum albedo(const BsdfContext&) const override { return albedo_; }

private:
    Facet facet_;
    Spectrum albedo_;
    Ggx ggx_;
    EnergyTable loss_;
    Spectrum multipleScattering_;
    float lobeScale_;  // 1 / (π (1 − Eavg))
};

std::unique_ptr<Bsdf> make(const Facet& facet, float roughness) {
    const float alpha = alphaFromRoughness(roughness);
    if (alpha < smallestAlpha) return std::make_unique<Mirror>(facet);
    return std::make_unique<RoughConductor>(facet, alpha);
}

}  // namespace

std::unique_ptr<Bsdf> makeConductor(const ConductorOptics& optics, float roughness) {
    return make(optics, roughness);
}

std::unique_ptr<Bsdf> makeConductor(const Spectrum& reflectance, float roughness) {
    return make(reflectance, roughness);
}

}  // namespace etendue
