#include "renderer/energy_compensation.h"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

#include "renderer/fresnel.h"
#include "renderer/vec.h"

namespace etendue {

namespace {

enum class Kind { reflector, dielectric, coat };

/// The share that single scattering loses (a coat: lets through), by another way than the tables':
/// visible normals drawn as in Heitz 2018 ("Sampling the GGX Distribution of Visible Normals"),
/// weighed by G₂ / G₁ from the published Λ, over `count` points of a two-dimensional Kronecker
/// sequence.
class SampledShare {
public:
    SampledShare(Kind kind, double mu, double alpha, double eta)
        : kind_(kind), alpha_(alpha), eta_(eta), wo_{std::sqrt(1.0 - mu * mu), 0.0, mu} {}

    double average(int count) const {
        double sum = 0.0;
        for (int i = 0; i < count; ++i) {
            const double u = 0.5 + (i + 1) * 0.7548776662466927;
            const double v = 0.5 + (i + 1) * 0.5698402909980532;
            sum += lost(visibleNormal(u - std::floor(u), v - std::floor(v)));
        }
        return sum / count;
    }

private:
    Vec3d visibleNormal(double u, double v) const {
        const Vec3d view = normalize(Vec3d{alpha_ * wo_.x, alpha_ * wo_.y, wo_.z});
        const Vec3d t1 = normalize(cross(Vec3d{0, 0, 1}, view)), t2 = cross(view, t1);
        const double r = std::sqrt(u), phi = 2.0 * std::numbers::pi * v;
        const double p1 = r * std::cos(phi), s = 0.5 * (1.0 + view.z);
        const double p2 = (1.0 - s) * std::sqrt(1.0 - p1 * p1) + s * r * std::sin(phi);
        const Vec3d n =
            t1 * p1 + t2 * p2 + view * std::sqrt(std::max(0.0, 1.0 - p1 * p1 - p2 * p2));
        return normalize(Vec3d{alpha_ * n.x, alpha_ * n.y, std::max(0.0, n.z)});
    }
    double lambda(double cosine) const {
        const double tanSquared = (1.0 - cosine * cosine) / (cosine * cosine);
        return 0.5 * (std::sqrt(1.0 + alpha_ * alpha_ * std::max(0.0, tanSquared)) - 1.0);
    }
    double kept(double cosine) const {
        if (cosine <= 0.0) return 0.0;
        return (1.0 + lambda(wo_.z)) / (1.0 + lambda(wo_.z) + lambda(std::min(cosine, 1.0)));
    }
    double lost(Vec3d m) const {
        const double cosine = dot(wo_, m);
        if (!(cosine > 0.0)) return 0.0;
        const auto f = fresnelDielectric(std::min(cosine, 1.0), eta_);
        const double reflected = kind_ == Kind::reflector ? 1.0 : f.reflectance;
        const double refractedZ = (cosine / eta_ - f.cosTransmitted) * m.z - wo_.z / eta_;
        const double refracted = kind_ == Kind::dielectric ? kept(-refractedZ) : 0.0;
        return 1.0 - reflected * kept(2.0 * cosine * m.z - wo_.z) - (1.0 - reflected) * refracted;
    }

    Kind kind_;
    double alpha_, eta_;
    Vec3d wo_;
};

constexpr int count = 50000;
/// The sequence's error: seen 5e-5 at twice this count and 3e-5 at twenty times.
constexpr double sequenceError = 1.5e-4;

}  // namespace

TEST_CASE("Energy compensation: the energy lost agrees with sampled visible normals") {
    for (const double alpha : {1e-4, 0.01, 0.09, 0.36, 1.0})
        for (const double mu : {0.02, 0.3, 0.75, 0.999}) {
            CAPTURE(alpha);
            CAPTURE(mu);
            CHECK(std::abs(reflectorLoss(mu, alpha) -
                           SampledShare(Kind::reflector, mu, alpha, 1.0).average(count)) <
                  sequenceError);
            for (const double eta : {1.5, 1.0 / 1.5, 2.4, 1.0 / 2.4}) {
                CAPTURE(eta);
                CHECK(std::abs(dielectricLoss(mu, alpha, eta) -
                               SampledShare(Kind::dielectric, mu, alpha, eta).average(count)) <
                      sequenceError);
            }
            CHECK(std::abs(coatTransmittance(mu, alpha, 1.5) -
                           SampledShare(Kind::coat, mu, alpha, 1.5).average(count)) <
                  sequenceError);
        }
}

TEST_CASE(
    "Energy compensation: a reflector seen from straight above loses what a hand can integrate") {
    // From the normal a microfacet at slope r reflects to cosine (1 − r²) / (1 + r²), and G₁(wo) =
    // 1: the loss is 1 − ∫ G₁(wi) over r < 1, a one-dimensional integral, here by the midpoint
    // rule.
    for (const double alpha : {0.05, 0.3, 1.0}) {
        constexpr int steps = 200000;
        double kept = 0.0;
        for (int i = 0; i < steps; ++i) {
            const double r = (i + 0.5) / steps, cosine = (1.0 - r * r) / (1.0 + r * r);
            const double tanSquared = 1.0 / (cosine * cosine) - 1.0;
            const double g1 = 2.0 / (1.0 + std::sqrt(1.0 + alpha * alpha * tanSquared));
            kept += 2.0 * r * alpha * alpha / std::pow(alpha * alpha + r * r, 2) * g1 / steps;
        }
        CHECK(reflectorLoss(1.0, alpha) == doctest::Approx(1.0 - kept).epsilon(1e-5));
    }
    CHECK(reflectorLoss(1.0, 1.0) == doctest::Approx(std::log(2.0)).epsilon(1e-5));
}

TEST_CASE("Energy compensation: tables agree with the integrals, at the critical angle too") {
    for (const double alpha : {1e-4, 9e-4, 0.01, 0.09, 0.36, 1.0})
        for (const double eta : {1.5, 1.0 / 1.5, 1.0 / 2.4}) {
            const EnergyTable table = dielectricLossTable(alpha, eta);
            const double critical = eta < 1.0 ? std::sqrt(1.0 - eta * eta) : 0.7;
            double worst = 0.0;
            for (int i = -12; i <= 12; ++i)
                for (const double mu :
                     {critical + i * 0.3 * alpha, (i + 12.5) / 25.0, alpha * std::exp2(0.37 * i)}) {
                    if (mu <= 0.0 || mu > 1.0) continue;
                    const auto rounded = static_cast<float>(mu);
                    worst = std::max(worst, std::abs(double{table.at(rounded)} -
                                                     dielectricLoss(double{rounded}, alpha, eta)));
                }
            CAPTURE(alpha);
            CAPTURE(eta);
            // The table's tolerance, the chord between nodes and the quadrature's own jumps.
            CHECK(worst < 4e-5);
        }
}

TEST_CASE("Energy compensation: the lobe gives back exactly what is lost") {
    // ∫ (1 − E(μo)) (1 − E(μi)) / (π (1 − Eavg)) cosθi dω over the hemisphere is 1 − E(μo): that
    // the average is the integral of the interpolant itself, here by the midpoint rule.
    const EnergyTable table = reflectorLossTable(0.25);
    constexpr int steps = 100000;
    double integral = 0.0;
    for (int i = 0; i < steps; ++i) {
        const float mu = (static_cast<float>(i) + 0.5f) / steps;
        integral += 2.0 * double{mu} * double{table.at(mu)} / steps;
    }
    CHECK(double{table.average()} == doctest::Approx(integral).epsilon(1e-6));
}

TEST_CASE("Energy compensation: both sides' shares make the dielectric's lobe reciprocal") {
    for (const double ior : {1.5, 2.4, 1.0 / 1.5, 1.05}) {
        const float outside = dielectricLossTable(0.3, ior).average();
        const float inside = dielectricLossTable(0.3, 1.0 / ior).average();
        const TransmittedShares shares = compensationShares(ior, outside, inside);
        // f from outside over n², per unit of (1 − E) (1 − E): share / (π (1 − Eavg) of the far
        // side).
        CHECK(double{shares.outside} / double{inside} / (ior * ior) ==
              doctest::Approx(double{shares.inside} / double{outside}).epsilon(1e-6));
        for (const float share : {shares.outside, shares.inside}) {
            CHECK(share > 0.0f);
            CHECK(share <= 1.0f);
        }
    }
}

TEST_CASE("Energy compensation: the colour of multiple scattering") {
    const Spectrum color = multipleScatteringColor({1.0f, 0.5f, 0.0f, 0.9f}, 0.4f);
    // White stays white, black black, and each further bounce adds Favg (1 − Eavg) of the last:
    // F² E (1 + F (1 − E) + F² (1 − E)² + …).
    CHECK(color[0] == doctest::Approx(1.0));
    CHECK(color[2] == 0.0f);
    double series = 0.0, bounce = 0.81 * 0.6;
    for (int i = 0; i < 100; ++i, bounce *= 0.9 * 0.4) series += bounce;
    CHECK(double{color[3]} == doctest::Approx(series).epsilon(1e-6));
}

}  // namespace etendue
