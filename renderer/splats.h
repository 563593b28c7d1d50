// Splats: light that many threads bring to the film, added up in one fixed order, so that the same
// picture has the same bits for any number of threads and passes.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/estimator.h"
#include "renderer/film.h"
#include "renderer/filter.h"
#include "renderer/technique_images.h"

namespace etendue {

/// What the samples of one part of the frame splat, kept apart by where it lands: one list for each
/// band of the film's rows.
class SplatList {
public:
    struct Splat {
        Vec2 film;
        Vec3 value;  // not weighted
        float weight;
        Technique technique;
        std::uint32_t sample;
    };

    SplatList(const FrameWindow& window, const Filter& filter);

    /// Keeps what reaches the window.
    void add(std::uint32_t sample, const Contribution& splat);
    void clear();

    int bandCount() const { return static_cast<int>(bands_.size()); }
    const std::vector<Splat>& band(int index) const {
        return bands_[static_cast<std::size_t>(index)];
    }

private:
    FrameWindow window_;
    float radius_;
    std::vector<std::vector<Splat>> bands_;
};

/// Adds the splats of all parts to the film, and to `images` if there are any: sample by sample,
/// within a sample part by part. Each list holds its samples in rising order, from `firstSample`
/// on.
void addSplats(const std::vector<SplatList>& parts, const Filter& filter, std::uint32_t firstSample,
               std::uint32_t sampleCount, int threads, Film& film, TechniqueImages* images);

}  // namespace etendue
