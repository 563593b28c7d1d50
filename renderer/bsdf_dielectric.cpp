#include <array>
#include <cmath>

#include "renderer/bsdf_parts.h"
#include "renderer/bsdfs.h"
#include "renderer/energy_compensation.h"
#include "renderer/ggx.h"

namespace etendue {

namespace {

/// Radiance is compressed into a smaller solid angle by the denser medium, flux is not (Veach 1997,
/// §5.2). `eta` is the index on wi's side over that on wo's.
float transportFactor(Transport transport, float eta) {
    return transport == Transport::radiance ? 1.0f / (eta * eta) : 1.0f;
}

Spectrum averageShare(float ior, const Spectrum& tint) {
    const auto reflected = static_cast<float>(fresnelDielectricAverage(ior));
    return Spectrum(reflected) + tint * (1.0f - reflected);
}

class SmoothDielectric final : public Bsdf {
public:
    SmoothDielectric(float ior, const Spectrum& tint)
        : ior_(ior), tint_(tint), albedo_(averageShare(ior, tint)) {}

    BsdfValue evaluate(const BsdfContext&, Vec3, Vec3) const override { return {}; }

    std::optional<BsdfSample> sample(const BsdfContext& context, Vec3 wo, float uLobe,
                                     Vec2) const override {
        if (isInSurface(wo)) return std::nullopt;
        const float eta = wo.z > 0.0f ? ior_ : 1.0f / ior_;
        const auto [reflected, cosTransmitted] =
            fresnelDielectric(std::min(std::abs(wo.z), 1.0f), eta);
        if (uLobe < reflected)
            return diracSample({-wo.x, -wo.y, wo.z}, Spectrum(1.0f), reflected, reflected);
        const Vec3 wi = {-wo.x / eta, -wo.y / eta, -std::copysign(cosTransmitted, wo.z)};
        return diracSample(
            wi, context.wavelengths.lanesOf(tint_) * transportFactor(context.transport, eta),
            1.0f - reflected, 1.0f - reflected);
    }

    bool isDirac() const override { return true; }
    Spectrum albedo(const BsdfContext&) const override { return albedo_; }

private:
    float ior_;
    Spectrum tint_, albedo_;
};

class RoughDielectric final : public Bsdf {
public:
    RoughDielectric(float ior, const Spectrum& tint, float alpha)
        : tint_(tint),
          albedo_(averageShare(ior, tint)),
          ggx_(alpha),
          outside_(ior, alpha),
          inside_(1.0f / ior, alpha) {
        const TransmittedShares shares =
            compensationShares(ior, outside_.loss.average(), inside_.loss.average());
        outside_.transmitted = shares.outside;
        inside_.transmitted = shares.inside;
    }

    BsdfValue evaluate(const BsdfContext& context, Vec3 wo, Vec3 wi) const override {
        if (isInSurface(wo) || isInSurface(wi)) return {};
        const Side& sideO = sideOf(wo);
        const Side& sideI = sideOf(wi);
        const bool isReflected = &sideO == &sideI;
        if (wo.z < 0.0f) {
            wo = flipped(wo);
            wi = flipped(wi);
        }
        const float cosI = std::abs(wi.z);
        const float lossO = sideO.loss.at(wo.z), lossI = sideI.loss.at(cosI);

        // Several bounces between microfacets…
        const float towards = sideO.share(isReflected) * lossO * lossI * sideI.lobeScale;
        const float back = sideI.share(isReflected) * lossO * lossI * sideO.lobeScale;
        BsdfValue value{{}, towards * cosI, back * wo.z};
        float f = towards;
        // … and one.
        const auto facet =
            isReflected ? reflectingMicrofacet(wo, wi) : refractingMicrofacet(wo, wi, sideO.eta);
        if (facet) {
            const float share =
                isReflected ? fresnelDielectric(facet->cosineO, sideO.eta).reflectance
                            : dielectricTransmittance(facet->cosineO, facet->cosineI, sideO.eta);
            const float density = ggx_.density(facet->normal) * share;
            f += density * facet->transfer * ggx_.g2OverCosines(wo, wi);
            value.pdfSolidAngle +=
                (1.0f - lossO) * density * facet->transfer * ggx_.g1OverCosine(wo);
            value.pdfSolidAngleReverse +=
                (1.0f - lossI) * density * facet->transferReverse * ggx_.g1OverCosine(wi);
        }
        value.f = isReflected ? Spectrum(f)
                              : context.wavelengths.lanesOf(tint_) *
                                    (f * transportFactor(context.transport, sideO.eta));
        return value;
    }

    std::optional<BsdfSample> sample(const BsdfContext& context, Vec3 wo, float uLobe,
                                     Vec2 u) const override {
        if (isInSurface(wo)) return std::nullopt;
        const Vec3 wi = sampleAbove(sideOf(wo), wo.z < 0.0f ? flipped(wo) : wo, uLobe, u);
        const Vec3 turned = wo.z < 0.0f ? flipped(wi) : wi;
        return continuousSample(turned, evaluate(context, wo, turned));
    }

    bool isDirac() const override { return false; }
    Spectrum albedo(const BsdfContext&) const override { return albedo_; }

private:
    struct Side {
        Side(float relativeIndex, float alpha)
            : eta(relativeIndex),
              loss(dielectricLossTable(alpha, relativeIndex)),
              lobeScale(inversePi / loss.average()) {}

        float share(bool isReflected) const {
            return isReflected ? 1.0f - transmitted : transmitted;
        }

        float eta;  // index beyond the surface over that on this side
        EnergyTable loss;
        float lobeScale;           // 1 / (π (1 − Eavg))
        float transmitted = 0.0f;  // share of what the compensation gives back
    };

    const Side& sideOf(Vec3 w) const { return w.z > 0.0f ? outside_ : inside_; }

    /// `wo` on `side`, turned to wo.z > 0. Zero where the microfacet sends the light to the wrong
    /// side of the surface.
    Vec3 sampleAbove(const Side& side, Vec3 wo, float uLobe, Vec2 u) const {
        const float loss = side.loss.at(wo.z);
        if (uLobe < loss) {
            if (uLobe >= loss * side.transmitted)
                return directionAround(side.loss.sample(u.x), u.y);
            const Side& other = &side == &outside_ ? inside_ : outside_;
            return flipped(directionAround(other.loss.sample(u.x), u.y));
        }
        const Vec3 m = ggx_.sampleVisibleNormal(wo, u);
        const float cosine = std::min(dot(wo, m), 1.0f);
        const auto [reflected, cosTransmitted] = fresnelDielectric(cosine, side.eta);
        const bool isReflected = uLobe - loss < (1.0f - loss) * reflected;
        const Vec3 wi = isReflected ? reflect(wo, m)
                                    : normalize(refract(wo, m, side.eta, cosine, cosTransmitted));
        return (wi.z > 0.0f) == isReflected ? wi : Vec3{};
    }

    Spectrum tint_, albedo_;
    Ggx ggx_;
    Side outside_, inside_;
};

}  // namespace

std::unique_ptr<Bsdf> makeDielectric(float ior, const Spectrum& tint, float roughness) {
    const float alpha = alphaFromRoughness(roughness);
    if (alpha * std::min(1.0f, std::abs(ior - 1.0f)) < smallestAlpha)
        return std::make_unique<SmoothDielectric>(ior, tint);
    return std::make_unique<RoughDielectric>(ior, tint, alpha);
}

}  // namespace etendue
