// TechniqueImages: one picture for each technique of bidirectional path tracing, once with its
// weights and once without (the pyramids of Veach 1997, figure 10.3).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "renderer/film.h"
#include "renderer/image_io.h"
#include "renderer/mis.h"

namespace etendue {

/// Weighted, the pictures sum to the rendered one. Unweighted, each is an estimate of the light
/// that comes by paths of s + t − 1 edges, as far as the technique can make them.
class TechniqueImages {
public:
    explicit TechniqueImages(const FrameWindow& window, FilmColor color = FilmColor::rgb)
        : window_(window), color_(color) {}

    /// `value` is what the film's sample gets, not weighted yet. May run at the same time for
    /// different pixels.
    void add(int x, int y, Technique technique, Vec3 value, float weight);

    /// "s1t2.R" …, then "s1t2.unweighted.R" …, for each technique that found anything;
    /// where none did, those of s0t2, black.
    std::vector<ExrChannels> channels(std::uint64_t samples) const;

private:
    /// Six sums a pixel: weighted, then not. Made when a technique first finds anything.
    using Sums = std::vector<double>;
    Sums& sumsOf(Technique technique);
    Sums noSums() const;

    FrameWindow window_;
    FilmColor color_;
    std::mutex mutex_;
    std::map<Technique, std::unique_ptr<Sums>> images_;
};

}  // namespace etendue
