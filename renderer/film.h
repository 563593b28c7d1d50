// Film: what the samples of a picture, or of a window of it, have added up to. Sums and counts,
// never averages, so that viewing, resuming and merging are the same thing.
#pragma once

#include <cassert>
#include <cstdint>
#include <limits>
#include <vector>

#include "renderer/exact_color.h"
#include "renderer/exact_sums.h"
#include "renderer/image_io.h"
#include "renderer/sample_light.h"
#include "renderer/spectrum.h"
#include "renderer/vec.h"

namespace etendue {

/// Auxiliary images, recorded only when asked for. Normal, depth and position are means over those
/// samples that meet something, and zero where none does: image files ought not to hold infinities.
struct FilmLayers {
    bool albedo = false;  // mean over all samples; one that meets nothing counts as black
    bool normal = false;
    bool depth = false;
    bool position = false;
    bool variance = false;  // of the pixel's mean, estimated from the spread of its samples; of a
                            // spectral film that of X, Y and Z
    bool luminanceVariance = false;  // the same of the luminance

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
    // Pixel after pixel of the window, row by row.
    std::vector<ExactColor> colorSums;
    ExactSums layerSums;  // as many a pixel as the layers have
    std::uint64_t samples = 0;
    std::uint64_t badSamples = 0;
    std::uint64_t roundedTerms = 0;  // of the pictures' sums: 0 says that they are exact

    /// Of a sample that is not finished yet, how much of the frame is (see render()).
    std::uint64_t unfinishedParts = 0;
    /// For each pixel, its samples beyond `samples`: 1 where an unfinished one is done, or more
    /// where several such renders were merged. Empty as long as there was none.
    std::vector<std::uint16_t> extraSamples;
    /// The light of the sample at hand, which joins the sums when all of the frame has had it;
    /// empty unless light is splatted.
    std::vector<SampleLight> sampleLight;

    friend bool operator==(const FilmState&, const FilmState&) = default;
};

/// What a film's sums are: R, G, B, or of a spectral render X, Y, Z, which are never negative, as
/// the response of R, G or B to a single wavelength may be. Its pictures are RGB in either case.
enum class FilmColor { rgb, xyz };

/// Linear Rec. 709 of a sum.
Vec3d rgbOf(FilmColor color, Vec3d sum);

/// What a film takes of a contribution: its first three lanes.
inline Vec3 toVec3(const Spectrum& s) { return {s[0], s[1], s[2]}; }

/// Whether a film would take the value: finite, and not negative.
inline bool isUsable(Vec3 value) {
    const auto isIn = [](float lane) {
        return lane >= 0.0f && lane <= std::numeric_limits<float>::max();
    };
    return isIn(value.x) && isIn(value.y) && isIn(value.z);
}
inline bool isUsable(const Spectrum& value) { return isUsable(toVec3(value)); }

/// Pixels are addressed in the full frame; film point (x + 0.5, y + 0.5) is the centre of pixel
/// (x, y). The functions that add to a pixel may run at the same time for different pixels.
class Film {
public:
    /// Throws std::invalid_argument unless the window has pixels and lies in the full frame.
    explicit Film(const FrameWindow& window, const FilmLayers& layers = {},
                  FilmColor color = FilmColor::rgb);

    /// Adds the first three lanes of a pixel's sample, if it is all that the sample brings there:
    /// unless light is splatted. One that is negative or not finite is counted, left out, and
    /// reported by `false`.
    bool add(int x, int y, const Spectrum& value);
    /// What that sample met; not called for one that met nothing. As for add(), a value that is not
    /// finite is counted and left out.
    bool addFeatures(int x, int y, const FilmFeatures& features);
    /// From now on light is splatted: samples of any pixel bring light to many. It belongs to the
    /// picture when all of the frame has had the sample, since of a part of it nobody can say how
    /// much is missing. To be called before addToSample(); 18 bytes a pixel.
    void expectSplats() { state_.sampleLight.resize(pixelCount()); }
    /// Adds some of the light that the sample at hand brings to the pixel, from anywhere. Usable;
    /// always in the same order, since sums are rounded.
    void addToSample(int x, int y, Vec3 light) { state_.sampleLight[pixelNumber(x, y)].add(light); }
    /// Has pixels first … last of a row brought near, for what will be added to them soon. To be
    /// inlined, since GCC drops calls to a function that does nothing but prefetch.
    [[gnu::always_inline]] void expectSplat(int first, int last, int y) const {
        const SampleLight* light = state_.sampleLight.data();
        prefetch(light + pixelNumber(first, y), light + pixelNumber(last, y) + 1);
    }
    /// Of a sample that is left out. False.
    bool countBad();
    /// Every pixel of the window has had `count` more samples: the means' divisor.
    void addSamples(std::uint64_t count) { state_.samples += count; }

    /// A sample is taken part of the frame by part: room to count them, pixel by pixel.
    void expectUnfinishedSample();
    /// Pixel (x, y) has had its share of the unfinished sample.
    void countUnfinished(int x, int y) { ++state_.extraSamples[pixelNumber(x, y)]; }
    /// So many parts of it are done.
    void setUnfinishedParts(std::uint64_t parts) { state_.unfinishedParts = parts; }
    /// Every pixel has had the sample, and all that it splats is there. The rows (from the
    /// window's top) of one call are one thread's.
    void finishSample(int firstRow, int endRow);

    /// Adds another render of the same window, layers and color, if by other samples; of light
    /// that is splatted only that of whole samples. Throws std::invalid_argument if its size shows
    /// that it is not.
    void merge(const FilmState& other);
    /// Takes up such a state in place of its own. Throws std::invalid_argument as merge() does.
    void restore(FilmState state);

    /// Images of the means: R, G, B first, then each layer asked for: variance.R …, variance.Y,
    /// albedo.R …, normal.X …, depth.Z, position.X …. Zero before the first sample; the variance,
    /// before the second. Where light is splatted, what has come of the first sample until it is
    /// whole: too little.
    std::vector<ExrChannels> channels() const;
    /// Of a pixel's mean, with splats, by its place in the window, row by row.
    double luminance(std::size_t pixel) const;
    /// The variance of that mean. Needs FilmLayers::luminanceVariance.
    double luminanceVariance(std::size_t pixel) const;
    std::size_t pixelCount() const {
        return static_cast<std::size_t>(window_.width) * static_cast<std::size_t>(window_.height);
    }

    /// How many sums a pixel has in FilmState::layerSums.
    static int sumsPerPixel(const FilmLayers& layers) { return slotsFor(layers).count; }

    const FrameWindow& window() const { return window_; }
    const FilmLayers& layers() const { return layers_; }
    FilmColor color() const { return color_; }
    const FilmState& state() const { return state_; }
    std::uint64_t samples() const { return state_.samples; }
    std::uint64_t badSamples() const { return state_.badSamples; }
    bool wantsFeatures() const { return slots_.hits >= 0; }
    bool isSplattedOn() const { return !state_.sampleLight.empty(); }
    /// Whether such a state's sums have something of a sample that it has not finished.
    bool countsUnfinished(const FilmState& other) const {
        return other.sampleLight.empty() || wantsFeatures();
    }

private:
    /// Where in a pixel's run of FilmState::layerSums a layer's begin, or −1.
    struct Slots {
        int squares = -1, luminanceSquare = -1, albedo = -1, hits = -1, normal = -1, depth = -1,
            position = -1;
        int count = 0;
    };
    static Slots slotsFor(const FilmLayers& layers);

    std::size_t pixelNumber(int x, int y) const {
        assert(x >= window_.x && x - window_.x < window_.width);
        assert(y >= window_.y && y - window_.y < window_.height);
        return static_cast<std::size_t>(y - window_.y) * static_cast<std::size_t>(window_.width) +
               static_cast<std::size_t>(x - window_.x);
    }
    /// The light of one sample, which is usable.
    void addSample(std::size_t pixel, Vec3 light);
    /// Each cache line of some memory, which is not empty.
    [[gnu::always_inline]] static void prefetch(const void* begin, const void* end) {
        const char* last = static_cast<const char*>(end) - 1;
        for (const char* p = static_cast<const char*>(begin); p < last; p += 64)
            __builtin_prefetch(p, 1);
        __builtin_prefetch(last, 1);
    }
    /// Where a pixel's sum of a layer lies.
    std::size_t slotOf(std::size_t pixel, int slot) const {
        return pixel * static_cast<std::size_t>(slots_.count) + static_cast<std::size_t>(slot);
    }
    /// Adds to a layer's sum, or to three.
    void addTo(std::size_t slot, Vec3 v);
    void addTo(std::size_t slot, double value);
    /// Squares of small samples have to be rounded beside others: no picture's sum is, by that. Of
    /// floats, whose squares are doubles without error.
    void addSquare(std::size_t slot, float value);
    /// A term had to be.
    void countRounded();
    double luminanceOf(Vec3d value) const {
        return color_ == FilmColor::xyz ? value.y
                                        : 0.2126 * value.x + 0.7152 * value.y + 0.0722 * value.z;
    }
    /// The pixel's samples, the unfinished one among them if it has had that.
    double sampleCount(std::size_t pixel) const;
    /// Those of its light.
    double lightCount(std::size_t pixel) const {
        return isSplattedOn() ? static_cast<double>(state_.samples) : sampleCount(pixel);
    }
    /// In the film's own colors.
    Vec3d meanColor(std::size_t pixel) const;
    void checkSize(const FilmState& other) const;

    FrameWindow window_;
    FilmLayers layers_;
    FilmColor color_;
    Slots slots_;
    FilmState state_;
};

}  // namespace etendue
