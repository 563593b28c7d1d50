// The BSDFs that the tests of all BSDFs go through, and directions to try them in.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "renderer/bsdf_parts.h"
#include "renderer/bsdfs.h"
#include "renderer/random.h"
#include "renderer/sampling.h"

namespace etendue {

struct BsdfCase {
    std::string name;
    std::unique_ptr<Bsdf> bsdf;
    float roughness = 0.0f;
    float ior = 1.0f;  // of a dielectric; 1: opaque

    bool isDielectric() const { return ior != 1.0f; }
    /// Refractive index on the side of `w`.
    float indexAt(Vec3 w) const { return w.z < 0.0f ? ior : 1.0f; }
};

inline std::string describe(const std::string& name, float roughness) {
    return name + ", roughness " + std::to_string(roughness);
}

/// Every BSDF at every one of these roughnesses; 0 stands for the smooth ones. None absorbs light.
inline std::vector<BsdfCase> whiteCases(const std::vector<float>& roughnesses,
                                        const std::vector<float>& iors = {1.5f}) {
    const Spectrum white(1.0f);
    std::vector<BsdfCase> cases;
    cases.push_back({"diffuse", makeDiffuse(Texture(white)), 1.0f});
    for (const float roughness : roughnesses) {
        cases.push_back(
            {describe("conductor", roughness), makeConductor(white, roughness), roughness});
        cases.push_back({describe("plastic", roughness),
                         makePlastic(Texture(white), 1.5f, roughness), roughness});
        for (const float ior : iors)
            cases.push_back({describe("dielectric of index " + std::to_string(ior), roughness),
                             makeDielectric(ior, white, roughness), roughness, ior});
    }
    return cases;
}

/// The same kinds of surface where they do absorb.
inline std::vector<BsdfCase> coloredCases(const std::vector<float>& roughnesses) {
    std::vector<BsdfCase> cases;
    cases.push_back({"diffuse", makeDiffuse(Texture(rgb(0.8f, 0.5f, 0.0f))), 1.0f});
    for (const float r : roughnesses) {
        for (const std::string& metal : metalNames())
            cases.push_back({describe(metal, r), makeConductor(metalOptics(metal), r), r});
        cases.push_back(
            {describe("tinted conductor", r), makeConductor(rgb(0.9f, 0.5f, 0.0f), r), r});
        cases.push_back(
            {describe("tinted glass", r), makeDielectric(1.5f, rgb(0.9f, 0.5f, 0.0f), r), r, 1.5f});
        cases.push_back({describe("coloured plastic", r),
                         makePlastic(Texture(rgb(0.9f, 0.5f, 0.0f)), 1.5f, r), r});
    }
    return cases;
}

/// A direction of that cosine, at an azimuth where no axis is special.
inline Vec3 atCosine(float cosine) {
    const float sine = std::sqrt((1.0f - cosine) * (1.0f + cosine));
    return {0.8f * sine, -0.6f * sine, cosine};
}

inline BsdfContext withTransport(Transport transport) { return {{0.5f, 0.5f}, transport}; }

inline std::optional<BsdfSample> drawSample(const BsdfCase& c, Transport transport, Vec3 wo,
                                            RandomStream& random) {
    const float uLobe = random.next();
    return c.bsdf->sample(withTransport(transport), wo, uLobe, random.next2());
}

/// wo uniform over the sphere; wi too, or drawn by the BSDF, half and half, so that narrow lobes
/// are met.
struct DirectionPair {
    Vec3 wo, wi;
};
inline DirectionPair drawPair(const BsdfCase& c, RandomStream& random) {
    const Vec3 wo = sampleUnitSphere(random.next2());
    if (random.next() < 0.5f)
        if (const auto sample = drawSample(c, Transport::importance, wo, random))
            return {wo, sample->wi};
    return {wo, sampleUnitSphere(random.next2())};
}

}  // namespace etendue
