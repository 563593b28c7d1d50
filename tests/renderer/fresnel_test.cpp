#include "renderer/fresnel.h"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <initializer_list>
#include <limits>

namespace etendue {

namespace {

constexpr double epsilon = std::numeric_limits<float>::epsilon();

/// Fresnel's equations as textbooks give them (Born and Wolf, §1.5.2), in complex numbers: the
/// oracle for metals and, with a real index, for dielectrics.
double textbookReflectance(double cosIncident, std::complex<double> index) {
    const double sinSquared = 1.0 - cosIncident * cosIncident;
    const std::complex<double> cosTransmitted = std::sqrt(1.0 - sinSquared / (index * index));
    const auto perpendicular =
        (cosIncident - index * cosTransmitted) / (cosIncident + index * cosTransmitted);
    const auto parallel =
        (index * cosIncident - cosTransmitted) / (index * cosIncident + cosTransmitted);
    return 0.5 * (std::norm(perpendicular) + std::norm(parallel));
}

}  // namespace

TEST_CASE("Fresnel: normal incidence reflects ((n − 1) / (n + 1))²") {
    for (const float n : {1.0f, 1.0003f, 1.33f, 1.5f, 2.4f, 1.0f / 1.5f, 0.1f}) {
        const double expected = std::pow((double{n} - 1.0) / (double{n} + 1.0), 2);
        const auto fresnel = fresnelDielectric(1.0f, n);
        // r is a difference of numbers near 1, each rounded a few times.
        CHECK(std::abs(fresnel.reflectance - expected) <=
              4.0 * epsilon * (expected + std::sqrt(expected)));
        // The cosine is the root of 1 − (1 − 1) / n², rounded by an epsilon of each term.
        CHECK(std::abs(fresnel.cosTransmitted - 1.0) <= epsilon * (1.0 + 1.0 / (n * n)));
    }
}

TEST_CASE("Fresnel: at Brewster's angle parallel light is not reflected") {
    for (const double n : {1.33, 1.5, 2.4, 1.0 / 1.5}) {
        // tan θ = n; then θi + θt = 90°, and only perpendicular light, half of it, is reflected:
        // sin²(θi − θt) = ((1 − n²) / (1 + n²))².
        const double cosine = 1.0 / std::sqrt(1.0 + n * n);
        const double expected = 0.5 * std::pow((1.0 - n * n) / (1.0 + n * n), 2);
        CHECK(fresnelDielectric(cosine, n).reflectance == doctest::Approx(expected).epsilon(1e-12));
    }
}

TEST_CASE("Fresnel: light is reflected totally beyond the critical angle, and only there") {
    for (const double n : {1.0 / 1.5, 1.0 / 2.4, 0.9}) {
        const double critical = std::sqrt(1.0 - n * n);
        for (const double part : {1e-6, 0.3, 0.999999}) {
            const auto beyond = fresnelDielectric(critical * part, n);
            CHECK(beyond.reflectance == 1.0);
            CHECK(beyond.cosTransmitted == 0.0);
        }
        const auto before = fresnelDielectric(critical * 1.000001, n);
        CHECK(before.reflectance < 1.0);
        CHECK(before.cosTransmitted > 0.0);
    }
}

TEST_CASE("Fresnel: an index of 1 is no surface, to the last bit") {
    for (float cosine = 0.001f; cosine <= 1.0f; cosine += 0.001f) {
        const auto fresnel = fresnelDielectric(cosine, 1.0f);
        CHECK(fresnel.reflectance == 0.0f);
        CHECK(fresnel.cosTransmitted == cosine);
    }
}

TEST_CASE("Fresnel: a dielectric agrees with the textbook, and with Snell's law") {
    for (const double n : {1.2, 1.5, 2.4, 1.0 / 1.5, 1.0 / 2.4})
        for (double cosine = 0.005; cosine <= 1.0; cosine += 0.005) {
            const auto fresnel = fresnelDielectric(cosine, n);
            CHECK(fresnel.reflectance ==
                  doctest::Approx(textbookReflectance(cosine, n)).epsilon(1e-12));
            if (fresnel.reflectance == 1.0) continue;
            const double sineTransmitted = std::sqrt(1.0 - cosine * cosine) / n;
            CHECK(fresnel.cosTransmitted * fresnel.cosTransmitted ==
                  doctest::Approx(1.0 - sineTransmitted * sineTransmitted).epsilon(1e-12));
        }
}

TEST_CASE("Fresnel: what is not reflected is transmitted") {
    for (const double n : {1.05, 1.5, 2.4, 1.0 / 1.5})
        for (double cosine = 0.01; cosine <= 1.0; cosine += 0.01) {
            const auto fresnel = fresnelDielectric(cosine, n);
            if (fresnel.cosTransmitted == 0.0) continue;
            CHECK(dielectricTransmittance(cosine, fresnel.cosTransmitted, n) ==
                  doctest::Approx(1.0 - fresnel.reflectance).epsilon(1e-12));
        }
}

TEST_CASE("Fresnel: reflectance is the same along the refracted ray reversed") {
    for (const double n : {1.1, 1.5, 2.4})
        for (double cosine = 0.01; cosine <= 1.0; cosine += 0.01) {
            const auto there = fresnelDielectric(cosine, n);
            const auto back = fresnelDielectric(there.cosTransmitted, 1.0 / n);
            CHECK(back.reflectance == doctest::Approx(there.reflectance).epsilon(1e-10));
            CHECK(back.cosTransmitted == doctest::Approx(cosine).epsilon(1e-10));
        }
}

TEST_CASE("Fresnel: a conductor agrees with the textbook at every angle") {
    for (const float eta : {0.05f, 0.2f, 1.0f, 1.37f, 3.0f})
        for (const float k : {0.01f, 1.0f, 3.9f, 7.5f})
            for (float cosine = 0.001f; cosine <= 1.0f; cosine += 0.013f) {
                const double expected =
                    textbookReflectance(double{cosine}, {double{eta}, double{k}});
                // Sums of positive terms, and squares of differences that are small only where the
                // reflectance is: each of some ten roundings counts once or twice.
                CHECK(std::abs(fresnelConductor(cosine, eta, k) - expected) <= 16.0 * epsilon);
            }
}

TEST_CASE("Fresnel: a conductor that absorbs nothing is a dielectric") {
    for (const float n : {1.5f, 2.4f, 0.6f})
        for (float cosine = 0.01f; cosine <= 1.0f; cosine += 0.01f) {
            const auto dielectric = fresnelDielectric(double{cosine}, double{n});
            // Near the critical angle the cosine's own rounding, under a square root, tells.
            const double tolerance = n > 1.0f ? 16.0 * epsilon : 8.0 * std::sqrt(epsilon);
            CHECK(std::abs(fresnelConductor(cosine, n, 0.0f) - dielectric.reflectance) <=
                  tolerance);
        }
}

TEST_CASE("Fresnel: averages over the hemisphere agree with a plain sum") {
    const auto plainSum = [](auto reflectance) {
        constexpr int count = 200000;  // midpoint rule; F has at worst a root's corner: error 1e-7
        double sum = 0.0;
        for (int i = 0; i < count; ++i) {
            const double mu = (i + 0.5) / count;
            sum += 2.0 * mu * reflectance(mu) / count;
        }
        return sum;
    };
    for (const double n : {1.05, 1.5, 2.4, 1.0 / 1.5, 1.0 / 2.4})
        CHECK(fresnelDielectricAverage(n) == doctest::Approx(plainSum([n](double mu) {
                                                 return textbookReflectance(mu, n);
                                             })).epsilon(1e-6));
    const ConductorOptics optics{Spectrum(0.2f, 1.0f, 1.4f, 3.0f),
                                 Spectrum(3.9f, 7.0f, 2.0f, 1.0f)};
    const Spectrum average = fresnelConductorAverage(optics);
    for (int i = 0; i < Spectrum::lanes; ++i)
        CHECK(double{average[i]} ==
              doctest::Approx(plainSum([&](double mu) {
                  return textbookReflectance(mu, {double{optics.eta[i]}, double{optics.k[i]}});
              })).epsilon(1e-6));
}

TEST_CASE("Fresnel: diffuse transmittances of the two sides differ by the squared index") {
    // Both count the same étendue: 1 − Favg(n) = n² (1 − Favg(1/n)).
    for (const double n : {1.05, 1.5, 2.4})
        CHECK(1.0 - fresnelDielectricAverage(n) ==
              doctest::Approx(n * n * (1.0 - fresnelDielectricAverage(1.0 / n))).epsilon(1e-8));
}

}  // namespace etendue
