// Splats: light that many threads bring to the film, added up in one fixed order, so that the same
// picture has the same bits for any number of threads and passes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/estimator.h"
#include "renderer/film.h"
#include "renderer/filter.h"
#include "renderer/technique_images.h"

namespace etendue {

/// What some samples splat, one after another, and in which bands of the film's rows it lands.
class SplatList {
public:
    struct Splat {
        Spectrum value;  // what the film adds, not weighted
        Vec2 film;
        float weight;
        std::uint16_t s, t;  // the technique; t = 0: all of a camera path's, which the film gets,
                             // as the images get those with t ≥ 2 each
    };

    SplatList(const FrameWindow& window, const Filter& filter);

    /// Empties it. Its memory is used again.
    void clear();
    /// Keeps what reaches the window.
    void add(const Contribution& splat);
    /// To be called when all are there, and before they are looked at.
    void sortByBand();

    int bandCount() const { return static_cast<int>(bandEnds_.size()) - 1; }
    /// Of the splats that reach the band, the numbers, rising.
    std::span<const std::uint32_t> band(int index) const {
        const auto b = static_cast<std::size_t>(index);
        return std::span(numbers_).subspan(bandEnds_[b], bandEnds_[b + 1] - bandEnds_[b]);
    }
    const Splat& operator[](std::uint32_t number) const { return splats_[number]; }

private:
    /// Of the bands that the rows, of the film's, belong to.
    template <class Visit>
    void forEachBand(int firstRow, int lastRow, const Visit& visit) const;

    FrameWindow window_;
    float radius_;
    std::vector<Splat> splats_;
    std::vector<std::uint32_t> numbers_;  // band after band
    /// [b + 1]: while splats are added, how many reach band b; then, where its numbers end.
    std::vector<std::uint32_t> bandEnds_;
};

/// Adds the splats of all lists to the film, and to `images` if there are any, one after another.
void addSplats(std::span<const SplatList> lists, const Filter& filter, int threads, Film& film,
               TechniqueImages* images);

}  // namespace etendue
