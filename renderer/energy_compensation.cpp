#include "renderer/energy_compensation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "renderer/fresnel.h"
#include "renderer/quadrature.h"

namespace etendue {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

const QuadratureRule& rule() {
    static const QuadratureRule r = gaussLegendreForRootEnds(12);
    return r;
}

enum class Interface { reflector, dielectric, coat };

/// Places where an integrand has kinks, in ascending order.
struct Breaks {
    std::array<double, 10> place{};
    std::size_t count = 0;

    void add(double x, double low, double high) {
        if (!(x > low && x < high)) return;
        std::size_t i = count++;
        for (; i > 0 && place[i - 1] > x; --i) place[i] = place[i - 1];
        place[i] = x;
    }
};

/// A mean over the visible microfacets of the light that comes from one direction, in the plane of
/// azimuth 0. A microfacet is given in polar coordinates by its slope, (r cosφ, r sinφ)
/// = −(mx, my) / mz up to sign, r in [0, ∞): normal ∝ (r cosφ, r sinφ, 1).
///
/// What becomes of the light has kinks: where the outgoing light grazes the surface (conics r² − 2
/// r cosφ tanθ + (sin²θ − n²) / cos²θ = 0, n = 1 for reflection and η for refraction) and where
/// total reflection begins. The radii of both are roots of quadratics, the azimuths where they
/// appear, cross or go to infinity are closed forms; between these the integrand is smooth, up to
/// square roots at the ends.
class VisibleMicrofacets {
public:
    VisibleMicrofacets(Interface interface, double mu, double alpha, double eta)
        : interface_(interface),
          mu_(mu),
          sine_(std::sqrt((1.0 - mu) * (1.0 + mu))),
          alpha_(alpha),
          eta_(eta),
          stretched_(stretchedLength(mu)),
          criticalSquared_(interface == Interface::reflector ? 0.0 : (1.0 - eta) * (1.0 + eta)) {}

    double meanShare() const {
        const Breaks azimuths = azimuthBreaks();
        double sum = 0.0, from = 0.0;
        for (std::size_t i = 0; i < azimuths.count; ++i) {
            sum += rule().integrate(from, azimuths.place[i],
                                    [this](double phi) { return radialIntegral(std::cos(phi)); });
            from = azimuths.place[i];
        }
        return 2.0 * sum;
    }

private:
    double stretchedLength(double cosine) const {
        return std::sqrt(cosine * cosine + alpha_ * alpha_ * (1.0 - cosine) * (1.0 + cosine));
    }

    /// 1 − G₂ / G₁ for light leaving at `cosine`, all of it if that is below the surface.
    double blocked(double cosine) const {
        if (cosine <= 0.0) return 1.0;
        const double sineSquared = std::max(0.0, (1.0 - cosine) * (1.0 + cosine));
        const double stretched = std::sqrt(cosine * cosine + alpha_ * alpha_ * sineSquared);
        return mu_ * alpha_ * alpha_ * sineSquared /
               ((stretched + cosine) * (mu_ * stretched + cosine * stretched_));
    }

    /// What the microfacet loses; for a coat, what it reflects.
    double share(double r, double projected) const {
        const double mz = 1.0 / std::sqrt(1.0 + r * r);
        const double cosine = std::min(projected * mz, 1.0);
        const double reflectedLoss = blocked(2.0 * cosine * mz - mu_);
        if (interface_ == Interface::reflector) return reflectedLoss;
        const auto [reflectance, cosTransmitted] = fresnelDielectric(cosine, eta_);
        if (interface_ == Interface::coat) return reflectance * (1.0 - reflectedLoss);
        if (reflectance >= 1.0) return reflectedLoss;
        const double refractedLoss = blocked(mu_ / eta_ - (cosine / eta_ - cosTransmitted) * mz);
        return reflectance * reflectedLoss + (1.0 - reflectance) * refractedLoss;
    }

    /// Density of visible normals by slope, times the share, times r.
    double integrand(double r, double cosPhi) const {
        const double projected = mu_ + sine_ * r * cosPhi;  // wo·m / mz
        if (projected <= 0.0) return 0.0;
        const double e = alpha_ * alpha_ + r * r;
        return r * alpha_ * alpha_ / (std::numbers::pi * e * e) * 2.0 / (mu_ + stretched_) *
               projected * share(r, projected);
    }

    double radialIntegral(double cosPhi) const {
        const double visible = cosPhi < 0.0 ? -mu_ / (sine_ * cosPhi) : infinity;
        const Breaks radii = radialBreaks(cosPhi, visible);
        // r = α sinh y spreads the core and the tail of the distribution evenly.
        double sum = 0.0, from = 0.0;
        for (std::size_t i = 0; i < radii.count; ++i) {
            const double to = std::asinh(radii.place[i] / alpha_);
            const int parts = std::max(1, static_cast<int>(std::ceil((to - from) / longestPart)));
            const double step = (to - from) / parts;
            for (int k = 0; k < parts; ++k)
                sum += rule().integrate(from + k * step, from + (k + 1) * step, [&](double y) {
                    const double e = std::exp(y), r = 0.5 * alpha_ * (e - 1.0 / e);
                    return 0.5 * alpha_ * (e + 1.0 / e) * integrand(r, cosPhi);
                });
            from = to;
        }
        // The rest in 1 / r.
        const double last = radii.place[radii.count - 1];
        if (visible <= last) return sum;
        return sum + rule().integrate(1.0 / visible, 1.0 / last, [&](double x) {
            return integrand(1.0 / x, cosPhi) / (x * x);
        });
    }
    static constexpr double longestPart = 3.0;

    Breaks radialBreaks(double cosPhi, double visible) const {
        Breaks result;
        const double s = sine_ * cosPhi;
        const auto addGrazing = [&](double index) {
            const double square = s * s - (sine_ - index) * (sine_ + index);
            if (square < 0.0) return;
            const double root = std::sqrt(square);
            result.add((s + root) / mu_, 0.0, visible);
            result.add((s - root) / mu_, 0.0, visible);
        };
        addGrazing(1.0);
        if (interface_ == Interface::dielectric) addGrazing(eta_);
        if (criticalSquared_ > 0.0) {
            // (μ + s r)² = cos²θcritical (1 + r²)
            const double a = s * s - criticalSquared_, b = s * mu_;
            const double c = mu_ * mu_ - criticalSquared_, square = b * b - a * c;
            if (square >= 0.0) {
                const double q = -(b + std::copysign(std::sqrt(square), b));
                result.add(q / a, 0.0, visible);
                result.add(c / q, 0.0, visible);
            }
        }
        result.add(coreEnd, 0.0, visible);
        result.add(visible, 0.0, farAway);
        return result;
    }
    static constexpr double coreEnd = 4.0, farAway = 1e3;

    Breaks azimuthBreaks() const {
        Breaks result;
        // A kink at slope `radius` matters by the share of the visible microfacets out there.
        const auto add = [&](double cosPhi, double radius) {
            const double r = std::min(radius, coreEnd);
            const double share = alpha_ * alpha_ * (mu_ / r + sine_) / r * 2.0 / (mu_ + stretched_);
            if (std::abs(cosPhi) < 1.0 && share > 3e-4)
                result.add(std::acos(cosPhi), 0.0, std::numbers::pi);
        };
        add(0.0, alpha_);
        if (criticalSquared_ > 0.0) {
            const double critical = std::sqrt(criticalSquared_);
            const double tangent = std::sqrt(std::max(0.0, (sine_ - eta_) * (sine_ + eta_)));
            for (const double sign : {-1.0, 1.0}) {
                add(sign * critical / sine_, infinity);
                if (tangent > 0.0) add(sign * tangent / sine_, tangent / mu_);
            }
            // Where the light that grazes the surface has met a microfacet at the critical angle.
            for (const double part : {0.5, 1.0}) {
                const double mz = part * mu_ / critical;
                if (mz >= 1.0) continue;
                const double radius = std::sqrt((1.0 - mz) * (1.0 + mz)) / mz;
                add((critical / mz - mu_) / (sine_ * radius), radius);
            }
        }
        result.add(std::numbers::pi, 0.0, infinity);
        return result;
    }

    Interface interface_;
    double mu_, sine_, alpha_, eta_, stretched_;
    double criticalSquared_;  // cos² of the angle of total reflection; ≤ 0: there is none
};

/// Of the angle where total reflection begins; 0 if there is none.
double criticalCosine(double eta) { return std::sqrt(std::max(0.0, (1.0 - eta) * (1.0 + eta))); }

}  // namespace

double reflectorLoss(double mu, double alpha) {
    return VisibleMicrofacets(Interface::reflector, mu, alpha, 1.0).meanShare();
}

double dielectricLoss(double mu, double alpha, double eta) {
    return VisibleMicrofacets(Interface::dielectric, mu, alpha, eta).meanShare();
}

double coatTransmittance(double mu, double alpha, double eta) {
    return 1.0 - VisibleMicrofacets(Interface::coat, mu, alpha, eta).meanShare();
}

EnergyTable reflectorLossTable(double alpha) {
    return {alpha, 0.0, [=](double mu) { return reflectorLoss(mu, alpha); }};
}

EnergyTable dielectricLossTable(double alpha, double eta) {
    return {alpha, criticalCosine(eta), [=](double mu) { return dielectricLoss(mu, alpha, eta); }};
}

EnergyTable coatTransmittanceTable(double alpha, double eta) {
    return {alpha, criticalCosine(eta),
            [=](double mu) { return coatTransmittance(mu, alpha, eta); }};
}

Spectrum multipleScatteringColor(const Spectrum& averageReflectance, float averageLoss) {
    const Spectrum& f = averageReflectance;
    return f * f * (1.0f - averageLoss) / (Spectrum(1.0f) - f * averageLoss);
}

TransmittedShares compensationShares(double ior, float averageLossOutside,
                                     float averageLossInside) {
    const double transmittance = 1.0 - fresnelDielectricAverage(ior);
    const double outside = double{averageLossOutside}, inside = double{averageLossInside};
    const double larger = std::max(outside, inside);
    if (!(larger > 0.0)) return {0.0f, 0.0f};
    return {static_cast<float>(transmittance * inside / larger),
            static_cast<float>(transmittance / (ior * ior) * outside / larger)};
}

}  // namespace etendue
