#include "renderer/fresnel.h"

#include "renderer/quadrature.h"

namespace etendue {

double fresnelDielectricAverage(double eta) {
    const QuadratureRule rule = gaussLegendreForRootEnds(48);
    const auto weighted = [eta](double mu) {
        return 2.0 * mu * fresnelDielectric(mu, eta).reflectance;
    };
    // Beyond the critical angle all is reflected; F leaves 1 there like a square root.
    const double critical = eta < 1.0 ? std::sqrt((1.0 - eta) * (1.0 + eta)) : 0.0;
    return critical * critical + rule.integrate(critical, 1.0, weighted);
}

float fresnelConductor(float cosIncident, float eta, float k) {
    // a + i b = √((η + i k)² − sin²θ), each of a², b² by the form that does not cancel.
    const float c = cosIncident, sinSquared = std::max(0.0f, (1.0f - c) * (1.0f + c));
    const float real = eta * eta - k * k - sinSquared, halfImaginary = eta * k;
    const float modulus = std::sqrt(real * real + 4.0f * halfImaginary * halfImaginary);
    const float larger = 0.5f * (modulus + std::abs(real));
    const float smaller = larger > 0.0f ? halfImaginary * halfImaginary / larger : 0.0f;
    const float a = std::sqrt(real > 0.0f ? larger : smaller);
    const float bSquared = real > 0.0f ? smaller : larger;

    const auto square = [](float x) { return x * x; };
    const float perpendicular = (square(c - a) + bSquared) / (square(c + a) + bSquared);
    const float ratio = (square(a * c - sinSquared) + bSquared * c * c) /
                        (square(a * c + sinSquared) + bSquared * c * c);
    return 0.5f * perpendicular * (1.0f + ratio);
}

Spectrum fresnelConductor(float cosIncident, const ConductorOptics& optics) {
    return Spectrum::fromLanes(
        [&](int i) { return fresnelConductor(cosIncident, optics.eta[i], optics.k[i]); });
}

Spectrum fresnelConductorAverage(const ConductorOptics& optics) {
    const QuadratureRule rule = gaussLegendre(48);
    return Spectrum::fromLanes([&](int i) {
        return static_cast<float>(rule.integrate(0.0, 1.0, [&](double mu) {
            return 2.0 * mu * fresnelConductor(static_cast<float>(mu), optics.eta[i], optics.k[i]);
        }));
    });
}

}  // namespace etendue
