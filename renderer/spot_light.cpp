// A point that shines into a cone. Angles θ from its axis are kept as 1 − cos θ, which stays exact
// where the cosine of a narrow cone rounds to 1.
#include "renderer/frame.h"
#include "renderer/point_source.h"
#include "renderer/sampling.h"

namespace etendue {
namespace {

double oneMinusCosDegrees(double degrees) {
    const double sinHalf = std::sin(degrees * (std::numbers::pi / 360.0));
    return 2.0 * sinHalf * sinHalf;
}

class SpotLight final : public Light {
public:
    SpotLight(Vec3 position, Vec3 direction, Spectrum intensity, float innerHalfAngleDegrees,
              float outerHalfAngleDegrees)
        : position_(position),
          frame_(Frame::fromZ(direction)),
          intensity_(intensity),
          inner_(oneMinusCosDegrees(innerHalfAngleDegrees)),
          outer_(oneMinusCosDegrees(outerHalfAngleDegrees)) {}

    float power() const override {
        // The falloff is odd about its middle, so its mean over the rim is one half.
        const double solidAngle = std::numbers::pi * (inner_ + outer_);
        return static_cast<float>(brightness(intensity_) * solidAngle);
    }

    std::optional<LightSample> sample(Vec3 receiver, Vec2) const override {
        auto result = sampleFromPoint(position_, intensity_, receiver);
        if (!result) return {};
        const float share = falloff(-result->direction);
        if (share <= 0.0f) return {};
        result->radiance *= share;
        return result;
    }

    Spectrum radiance(const EmitterHit&) const override { return {}; }
    float pdfSolidAngle(const EmitterHit&) const override { return 0.0f; }

    std::optional<EmittedRay> emit(Vec2, Vec2 uDirection) const override {
        EmittedRay ray;
        ray.origin = position_;
        ray.direction = frame_.worldFromLocal(sampleCone(uDirection, static_cast<float>(outer_)));
        const float share = falloff(ray.direction);
        if (share <= 0.0f) return {};
        ray.normal = ray.direction;
        ray.radiance = intensity_ * share;
        ray.pdf = {1.0f, conePdf()};
        ray.isDiracPosition = true;
        return ray;
    }

    EmissionPdf emissionPdf(const EmitterHit& hit) const override {
        return {1.0f, falloff(-hit.direction) > 0.0f ? conePdf() : 0.0f};
    }

    bool isInfinite() const override { return false; }

private:
    float conePdf() const { return conePdfSolidAngle(static_cast<float>(outer_)); }

    /// Share of the intensity that leaves along `direction`: smoothstep in cos θ.
    float falloff(Vec3 direction) const {
        // For unit vectors 1 − cos θ = |a − b|² / 2, without cancellation.
        const double oneMinusCos = 0.5 * lengthSquared(toDouble(direction) - toDouble(frame_.z));
        if (oneMinusCos >= outer_) return 0.0f;
        if (oneMinusCos <= inner_) return 1.0f;
        const double t = (outer_ - oneMinusCos) / (outer_ - inner_);
        return static_cast<float>(t * t * (3.0 - 2.0 * t));
    }

    Vec3 position_;
    Frame frame_;  // z: the axis
    Spectrum intensity_;
    double inner_, outer_;  // 1 − cos of the half angles
};

}  // namespace

std::unique_ptr<Light> makeSpotLight(Vec3 position, Vec3 direction, Spectrum intensity,
                                     float innerHalfAngleDegrees, float outerHalfAngleDegrees) {
    return std::make_unique<SpotLight>(position, direction, intensity, innerHalfAngleDegrees,
                                       outerHalfAngleDegrees);
}

}  // namespace etendue
