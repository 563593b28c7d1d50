// Splats: light that many threads bring anywhere on the film, added up in one fixed order, so that
// the same picture has the same bits for any number of threads and passes.
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
        Vec3 value;  // what the film adds, not weighted
        float weight;
        Vec2 film;
        std::uint16_t column, row;  // of the window, the first pixel that it reaches there
        std::uint16_t s, t;  // the technique; t = 0: all of a camera path's, which the film gets,
                             // as the images get those with t ≥ 2 each

        /// Of light for the pixel of `film` alone, which no filter spreads.
        static constexpr std::uint16_t pixelS = 1;  // with t = 0
        static bool isOfPixel(std::uint16_t s, std::uint16_t t) { return t == 0 && s == pixelS; }
        bool isOfPixel() const { return isOfPixel(s, t); }
    };

    /// Throws std::invalid_argument if a side of the window has more than 65535 pixels.
    SplatList(const FrameWindow& window, const Filter& filter);

    /// Empties it. Its memory is used again.
    void clear();
    /// Keeps what reaches the window. `samples`: of the frame, that the splat's value is of: of a
    /// light path, a part of one.
    void add(const Contribution& splat, float samples);
    /// What a sample brings to its own pixel, of the window.
    void addToPixel(int x, int y, const Spectrum& value);
    /// To be called when all are there, and before they are looked at.
    void sortByBand();

    int bandCount() const { return static_cast<int>(bandEnds_.size()) - 1; }
    /// The splats that reach the band, in the order in which they came.
    std::span<const Splat> band(int index) const {
        const auto b = static_cast<std::size_t>(index);
        return std::span(sorted_).subspan(bandEnds_[b], bandEnds_[b + 1] - bandEnds_[b]);
    }

private:
    /// Keeps it if it reaches the window.
    void keep(Vec3 value, float weight, Vec2 film, std::uint16_t s, std::uint16_t t);
    /// Of the bands that it reaches.
    template <class Visit>
    void forEachBand(const Splat& splat, const Visit& visit) const;

    FrameWindow window_;
    float radius_;     // of the filter
    bool isOnePixel_;  // what a splat reaches
    std::vector<Splat> splats_;
    std::vector<Splat> sorted_;  // band after band
    /// [b + 1]: while splats are added, how many reach band b; then, where its splats end.
    std::vector<std::uint32_t> bandEnds_;
};

/// Adds the splats of all lists to the film's sample at hand, and to `images` if there are any, one
/// after another.
void addSplats(std::span<const SplatList> lists, const Filter& filter, int threads, Film& film,
               TechniqueImages* images);

}  // namespace etendue
