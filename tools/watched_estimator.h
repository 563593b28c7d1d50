// WatchedEstimator: an estimator, and the largest value that a sample of it brought to a pixel.
#pragma once

#include <algorithm>
#include <cmath>

#include "renderer/estimator.h"
#include "renderer/film.h"
#include "renderer/lane_sums.h"
#include "renderer/scene_loader.h"

namespace etendue {

/// For one thread.
class WatchedEstimator final : public Estimator {
public:
    WatchedEstimator(const Estimator& estimator, const LoadedScene& loaded)
        : estimator_(estimator),
          color_(loaded.film.color),
          framePixels_(static_cast<float>(loaded.film.width * loaded.film.height)) {}

    int lightPathsPerSample() const override { return estimator_.lightPathsPerSample(); }
    bool hasCameraLight() const override { return estimator_.hasCameraLight(); }

    void takeSample(const View& view, SampleId id, SampleRequest request,
                    Sample& result) const override {
        estimator_.takeSample(view, id, request, result);
        Spectrum own;
        LaneSums lanes;
        for (const Contribution& c : result.contributions) {
            const Spectrum value = c.value * c.weight;
            if (!isUsable(value)) continue;
            // A light path is a sample of all pixels, a camera path of one.
            if (c.technique.t == 1)
                note(value * (1.0f / framePixels_));
            else if (c.isSplat)
                lanes.add(c);
            else
                own += value;
        }
        for (const Contribution& lane : lanes.sums()) note(lane.value);
        note(own);
    }

    /// In any colour.
    double largest() const { return largest_; }

private:
    void note(const Spectrum& value) const {
        const Vec3d rgb = rgbOf(color_, {double{value[0]}, double{value[1]}, double{value[2]}});
        largest_ = std::max({largest_, std::abs(rgb.x), std::abs(rgb.y), std::abs(rgb.z)});
    }

    const Estimator& estimator_;
    FilmColor color_;
    float framePixels_;
    mutable double largest_ = 0.0;
};

}  // namespace etendue
