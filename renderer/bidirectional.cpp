// Bidirectional path tracing, with light tracing as the part of it that connects to the lens.
// docs/bidirectional.md has the formulas.
#include "renderer/bidirectional_sample.h"

namespace etendue {

namespace {

class Bidirectional final : public Estimator {
public:
    Bidirectional(const EstimatorSettings& settings, TechniqueSet techniques)
        : settings_(settings),
          needsCamera_(techniques.needsCameraWalk(settings.maxDepth)),
          needsLight_(techniques.needsLightWalk(settings.maxDepth)),
          techniques_(std::move(techniques)) {}

    void takeSample(const View& view, SampleId id, SampleRequest request,
                    Sample& result) const override {
        result.contributions.clear();
        result.firstHit.reset();
        const SpectralSample color = drawWavelengths(view, id);
        static thread_local BidirectionalMemory memory;
        BidirectionalSample sample{view, color, settings_, techniques_, memory, result};
        takeLightPaths(sample, id, lightPathsPerSample(), [](int) {});
        if (!request.ownPixel && !(needsCamera_ && isParted(view))) return;
        if (!needsCamera_ && !request.firstHit) return;
        CameraSample camera = drawCameraSample(view, id);
        if (!camera.ray || !(request.ownPixel || isSplatting(view, camera))) return;
        if (request.firstHit) result.firstHit = firstHitOf(view.scene, *camera.ray);
        if (!needsCamera_) return;
        takeCameraPath(sample, camera);
    }

    int lightPathsPerSample() const override { return needsLight_ ? settings_.lightPaths : 0; }
    bool hasCameraLight() const override { return needsCamera_; }

private:
    EstimatorSettings settings_;
    bool needsCamera_, needsLight_;
    TechniqueSet techniques_;
};

}  // namespace

std::unique_ptr<Estimator> makeLightTracer(const EstimatorSettings& settings) {
    return std::make_unique<Bidirectional>(settings, TechniqueSet::lightTracing());
}

std::unique_ptr<Estimator> makeBidirectional(const EstimatorSettings& settings) {
    return std::make_unique<Bidirectional>(settings, settings.techniques);
}

}  // namespace etendue
