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

/// n = A + B/λ² (Cauchy), from the index at the d line and Abbe's number.
class DispersiveIndex {
public:
    DispersiveIndex(float atDLine, float abbeNumber)
        : perSquareNm_((atDLine - 1.0) / (abbeNumber * (1.0 / (fNm * fNm) - 1.0 / (cNm * cNm)))),
          offset_(atDLine - perSquareNm_ / (dNm * dNm)) {}

    float at(float wavelengthNm) const {
        const double nm = wavelengthNm;
        return static_cast<float>(offset_ + perSquareNm_ / (nm * nm));
    }

private:
    static constexpr double dNm = 587.5618, fNm = 486.1327, cNm = 656.2725;
    double perSquareNm_, offset_;
};

class SmoothDielectric final : public Bsdf {
public:
    SmoothDielectric(float ior, const Spectrum& tint, std::optional<DispersiveIndex> dispersion)
        : ior_(ior), tint_(tint), albedo_(averageShare(ior, tint)), dispersion_(dispersion) {}

    BsdfValue evaluate(const BsdfContext&, Vec3, Vec3) const override { return {}; }

    std::optional<BsdfSample> sample(const BsdfContext& context, Vec3 wo, float uLobe,
                                     Vec2) const override {
        if (isInSurface(wo)) return std::nullopt;
        const bool isParting = dispersion_ && context.wavelengths.isSpectral;
        const float ior = isParting ? dispersion_->at(context.wavelengths.heroNm()) : ior_;
        const float eta = wo.z > 0.0f ? ior : 1.0f / ior;
        const float cosine = std::min(std::abs(wo.z), 1.0f);
        const auto fresnel = fresnelDielectric(cosine, eta);
        const float reflected = fresnel.reflectance;
        if (uLobe < reflected) {
            Spectrum weight(1.0f);
            // Reflected, all wavelengths go one way, each with its own share.
            if (isParting)
                weight = Spectrum::fromLanes([&](int lane) {
                    const float other =
                        dispersion_->at(context.wavelengths.nm[static_cast<std::size_t>(lane)]);
                    const float otherEta = wo.z > 0.0f ? other : 1.0f / other;
                    return fresnelDielectric(cosine, otherEta).reflectance / reflected;
                });
            return diracSample({-wo.x, -wo.y, wo.z}, weight, reflected, reflected);
        }
        const Vec3 wi = {-wo.x / eta, -wo.y / eta, -std::copysign(fresnel.cosTransmitted, wo.z)};
        const Spectrum weight =
            context.wavelengths.lanesOf(tint_) * transportFactor(context.transport, eta);
        BsdfSample sample = diracSample(wi, weight, 1.0f - reflected, 1.0f - reflected);
        sample.isHeroOnly = isParting;
        return sample;
    }

    bool isDirac() const override { return true; }
    bool isTransmitting() const override { return true; }
    Spectrum albedo(const BsdfContext&) const override { return albedo_; }

private:
    float ior_;
    Spectrum tint_, albedo_;
    std::optional<DispersiveIndex> dispersion_;
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
    bool isTransmitting() const override { return true; }
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
        return std::make_unique<SmoothDielectric>(ior, tint, std::nullopt);
    return std::make_unique<RoughDielectric>(ior, tint, alpha);
}

std::unique_ptr<Bsdf> makeDispersiveDielectric(float ior, float abbeNumber, const Spectrum& tint) {
    return std::make_unique<SmoothDielectric>(ior, tint, DispersiveIndex(ior, abbeNumber));
}

}  // namespace etendue
