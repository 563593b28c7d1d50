// Film: what the camera samples of a picture, or of a window of it, have added up to. Sums and
// counts, never averages, so that viewing, resuming and merging are the same thing.
#pragma once

#include <cassert>
#include <cstdint>
#include <limits>
#include <vector>

#include "renderer/image_io.h"
#include "renderer/spectrum.h"
#include "renderer/vec.h"

namespace etendue {

/// Auxiliary images, recorded only when asked for. Beauty alone takes 24 bytes a pixel. Normal,
/// depth and position are means over those samples that meet something, and zero where none does:
/// image files ought not to hold infinities.
struct FilmLayers {
    bool albedo = false;  // mean over all samples; one that meets nothing counts as black
    bool normal = false;
    bool depth = false;
    bool position = false;
    bool variance = false;  // of the pixel's mean, estimated from the spread of its samples; of a
                            // spectral film that of X, Y and Z

    friend bool operator==(const FilmLayers&, const FilmLayers&) = default;
};

/// What a camera sample met first.
struct FilmFeatures {
    Spectrum albedo;
    Vec3 normal;         // unit, shading normal, world
    Vec3 position;       // world, m
    float depth = 0.0f;  // m, from the lens along the ray
};

/// All that a film remembers; write it down and a render can go on elsewhere.
struct FilmState {
    std::vector<double> sums;       // pixel after pixel of the window, row by row
    std::vector<double> splatSums;  // three a pixel; empty when nothing is splatted
    std::uint64_t samples = 0;
    std::uint64_t lightPaths = 0;  // of the whole frame, not of the window alone
    std::uint64_t badSamples = 0;
};

/// What a film's sums are: R, G, B, or of a spectral render X, Y, Z, which are never negative, as
/// the response of R, G or B to a single wavelength may be. Its pictures are RGB in either case.
enum class FilmColor { rgb, xyz };

/// Linear Rec. 709 of a sum.
Vec3d rgbOf(FilmColor color, Vec3d sum);

/// Whether a film would take the value: finite, and not negative.
inline bool isUsable(const Spectrum& value) {
    const auto isIn = [](float lane) {
        return lane >= 0.0f && lane <= std::numeric_limits<float>::max();
    };
    return isIn(value[0]) && isIn(value[1]) && isIn(value[2]);
}

/// Pixels are addressed in the full frame; film point (x + 0.5, y + 0.5) is the centre of pixel
/// (x, y). The functions that add to a pixel may run at the same time for different pixels.
class Film {
public:
    /// Throws std::invalid_argument unless the window has pixels and lies in the full frame.
    explicit Film(const FrameWindow& window, const FilmLayers& layers = {},
                  FilmColor color = FilmColor::rgb);

    /// Adds one sample's first three lanes. One that is negative or not finite is counted, left
    /// out, and reported by `false`.
    bool add(int x, int y, const Spectrum& value);
    /// What that sample met; not called for one that met nothing. As for add(), a value that is not
    /// finite is counted and left out.
    bool addFeatures(int x, int y, const FilmFeatures& features);
    /// From now on light is splatted. To be called before addSplat.
    void expectSplats();
    /// Adds light that a light path brought to pixel (x, y) of the window: the film holds the mean
    /// over all light paths. The value must be finite and not negative (isUsable).
    void addSplat(int x, int y, const Spectrum& value) {
        double* sums = state_.splatSums.data() + 3 * pixelNumber(x, y);
        for (int i = 0; i < 3; ++i) sums[i] += value[i];
    }
    /// Has the pixel brought near, if it is one of the window's, for what will be added soon.
    void expectSplat(int x, int y) const {
        if (x < window_.x || x - window_.x >= window_.width || y < window_.y ||
            y - window_.y >= window_.height)
            return;
        __builtin_prefetch(state_.splatSums.data() + 3 * pixelNumber(x, y), 1);
    }
    void addLightPaths(std::uint64_t count) { state_.lightPaths += count; }
    bool countBad();
    /// Every pixel of the window has had `count` more samples: the means' divisor.
    void addSamples(std::uint64_t count) { state_.samples += count; }

    /// Adds another render of the same window and layers. Throws std::invalid_argument if it is
    /// not.
    void merge(const Film& other);
    /// Takes up a state of the same window and layers. Throws std::invalid_argument if its size
    /// shows that it is not.
    void restore(FilmState state);

    /// Images of the means: R, G, B first, then each layer asked for: variance.R …, albedo.R …,
    /// normal.X …, depth.Z, position.X …. Zero before the first sample; the variance, before the
    /// second.
    std::vector<ExrChannels> channels() const;

    const FrameWindow& window() const { return window_; }
    const FilmLayers& layers() const { return layers_; }
    FilmColor color() const { return color_; }
    const FilmState& state() const { return state_; }
    std::uint64_t samples() const { return state_.samples; }
    std::uint64_t badSamples() const { return state_.badSamples; }
    bool wantsFeatures() const { return slots_.hits >= 0; }

private:
    /// Where in a pixel's run of sums a layer's begin, or −1. Beauty begins at 0.
    struct Slots {
        int squares = -1, albedo = -1, hits = -1, normal = -1, depth = -1, position = -1;
        int count = 3;
    };
    static Slots slotsFor(const FilmLayers& layers);

    std::size_t pixelNumber(int x, int y) const {
        assert(x >= window_.x && x - window_.x < window_.width);
        assert(y >= window_.y && y - window_.y < window_.height);
        return static_cast<std::size_t>(y - window_.y) * static_cast<std::size_t>(window_.width) +
               static_cast<std::size_t>(x - window_.x);
    }
    double* pixelSums(int x, int y);

    FrameWindow window_;
    FilmLayers layers_;
    FilmColor color_;
    Slots slots_;
    FilmState state_;
};

}  // namespace etendue
