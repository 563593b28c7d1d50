#include "renderer/film.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "renderer/colorimetry.h"

namespace etendue {

namespace {

Vec3 firstLanes(const Spectrum& s) { return {s[0], s[1], s[2]}; }

/// Of a pixel; zero where there are none.
Vec3d colorOf(const std::vector<ExactColor>& sums, std::size_t pixel) {
    return sums.empty() ? Vec3d() : sums[pixel].value();
}

/// Zero where there was nothing to divide.
double mean(double sum, double count) { return count > 0.0 ? sum / count : 0.0; }

/// The unbiased estimate for the mean of n samples. It cannot be negative but for rounding.
double varianceOfMean(double sum, double sumOfSquares, double n) {
    if (n < 2.0) return 0.0;
    return std::max(0.0, (sumOfSquares - sum * sum / n) / (n * (n - 1.0)));
}

}  // namespace

Vec3d rgbOf(FilmColor color, Vec3d sum) {
    return color == FilmColor::xyz ? rec709FromXyz(sum) : sum;
}

Film::Slots Film::slotsFor(const FilmLayers& layers) {
    Slots slots;
    const auto take = [&](bool wanted, int count) {
        if (!wanted) return -1;
        slots.count += count;
        return slots.count - count;
    };
    slots.squares = take(layers.variance, 3);
    slots.luminanceSquare = take(layers.luminanceVariance, 1);
    slots.hits = take(layers.albedo || layers.normal || layers.depth || layers.position, 1);
    slots.albedo = take(layers.albedo, 3);
    slots.normal = take(layers.normal, 3);
    slots.depth = take(layers.depth, 1);
    slots.position = take(layers.position, 3);
    return slots;
}

Film::Film(const FrameWindow& window, const FilmLayers& layers, FilmColor color)
    : window_(window), layers_(layers), color_(color), slots_(slotsFor(layers)) {
    const auto isInside = [](int from, int size, int full) {
        return from >= 0 && size > 0 && size <= full && from <= full - size;
    };
    if (!isInside(window.x, window.width, window.fullWidth) ||
        !isInside(window.y, window.height, window.fullHeight))
        throw std::invalid_argument("film: the window must have pixels and lie in the full frame");
    state_.layerSums.resize(pixelCount() * static_cast<std::size_t>(slots_.count));
}

void Film::addTo(std::size_t slot, double value) {
    if (!state_.layerSums.add(slot, value)) countRounded();
}

void Film::addSquare(std::size_t slot, double value) { state_.layerSums.add(slot, value * value); }

void Film::addTo(std::size_t slot, Vec3 v) {
    for (int i = 0; i < 3; ++i) addTo(slot + static_cast<std::size_t>(i), double{v[i]});
}

void Film::expectSplats(std::uint64_t lightPathsPerSample) {
    samplesPerLightPath_ = 1.0 / static_cast<double>(lightPathsPerSample);
    state_.splatSums.resize(pixelCount());
    expectSampleLuminance();
}

void Film::countRounded() {
    std::atomic_ref(state_.roundedTerms).fetch_add(1, std::memory_order_relaxed);
}

bool Film::countBad() {
    std::atomic_ref(state_.badSamples).fetch_add(1, std::memory_order_relaxed);
    return false;
}

bool Film::add(int x, int y, const Spectrum& value) {
    if (!isUsable(value)) return countBad();
    if (state_.cameraSums.empty())
        throw std::logic_error("film: a camera sample, where no light of them was expected");
    const Vec3 color = firstLanes(value);
    const std::size_t pixel = pixelNumber(x, y);
    if (!state_.cameraSums[pixel].add(color.x, color.y, color.z)) countRounded();
    if (slots_.squares >= 0)
        for (int i = 0; i < 3; ++i) addSquare(slotOf(pixel, slots_.squares + i), double{color[i]});
    if (slots_.luminanceSquare >= 0) {
        const double luminance = luminanceOf(toDouble(color));
        if (state_.sampleLuminance.empty())
            addSquare(slotOf(pixel, slots_.luminanceSquare), luminance);
        else
            state_.sampleLuminance[pixel] += static_cast<float>(luminance);
    }
    return true;
}

bool Film::addFeatures(int x, int y, const FilmFeatures& features) {
    const Vec3 albedo = firstLanes(features.albedo);
    if (!isUsable(features.albedo) || !isFinite(features.normal) || !isFinite(features.position) ||
        !std::isfinite(features.depth))
        return countBad();
    const auto at = [this, pixel = pixelNumber(x, y)](int slot) { return slotOf(pixel, slot); };
    if (slots_.hits >= 0) addTo(at(slots_.hits), 1.0);
    if (slots_.albedo >= 0) addTo(at(slots_.albedo), albedo);
    if (slots_.normal >= 0) addTo(at(slots_.normal), features.normal);
    if (slots_.depth >= 0) addTo(at(slots_.depth), double{features.depth});
    if (slots_.position >= 0) addTo(at(slots_.position), features.position);
    return true;
}

void Film::expectUnfinishedSample() { state_.extraSamples.resize(pixelCount()); }

void Film::finishSample(int firstRow, int endRow) {
    const auto width = static_cast<std::size_t>(window_.width);
    const std::size_t first = static_cast<std::size_t>(firstRow) * width,
                      end = static_cast<std::size_t>(endRow) * width;
    if (!state_.extraSamples.empty())
        std::fill(state_.extraSamples.begin() + static_cast<std::ptrdiff_t>(first),
                  state_.extraSamples.begin() + static_cast<std::ptrdiff_t>(end), std::uint16_t{0});
    if (state_.sampleLuminance.empty()) return;
    for (std::size_t pixel = first; pixel < end; ++pixel) {
        const float luminance = std::exchange(state_.sampleLuminance[pixel], 0.0f);
        addSquare(slotOf(pixel, slots_.luminanceSquare), luminance);
    }
}

void Film::checkSize(const FilmState& other) const {
    const auto fits = [](std::size_t size, std::size_t expected) {
        return size == 0 || size == expected;
    };
    if (!fits(other.cameraSums.size(), pixelCount()) ||
        !fits(other.splatSums.size(), pixelCount()) ||
        other.layerSums.size() != state_.layerSums.size() ||
        other.layerSums.rests.size() != other.layerSums.size() ||
        !fits(other.extraSamples.size(), pixelCount()) ||
        !fits(other.sampleLuminance.size(), layers_.luminanceVariance ? pixelCount() : 0))
        throw std::invalid_argument("film: the state is of another window or of other layers");
}

void Film::merge(const FilmState& other) {
    checkSize(other);
    const auto addAll = [&](std::vector<ExactColor>& to, const std::vector<ExactColor>& from) {
        to.resize(std::max(to.size(), from.size()));
        for (std::size_t i = 0; i < from.size(); ++i)
            if (!to[i].add(from[i])) ++state_.roundedTerms;
    };
    addAll(state_.cameraSums, other.cameraSums);
    addAll(state_.splatSums, other.splatSums);
    const ExactSums& layers = other.layerSums;
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (!state_.layerSums.add(i, layers.sums[i], layers.rests[i])) ++state_.roundedTerms;
    if (!other.extraSamples.empty()) expectUnfinishedSample();
    for (std::size_t pixel = 0; pixel < other.extraSamples.size(); ++pixel)
        state_.extraSamples[pixel] =
            static_cast<std::uint16_t>(state_.extraSamples[pixel] + other.extraSamples[pixel]);
    for (std::size_t pixel = 0; pixel < other.sampleLuminance.size(); ++pixel)
        addSquare(slotOf(pixel, slots_.luminanceSquare), other.sampleLuminance[pixel]);
    state_.samples += other.samples;
    state_.lightPaths += other.lightPaths;
    state_.badSamples += other.badSamples;
    state_.roundedTerms += other.roundedTerms;
}

void Film::restore(FilmState state) {
    checkSize(state);
    state_ = std::move(state);
}

double Film::sampleCount(std::size_t pixel) const {
    const std::uint64_t extra = state_.extraSamples.empty() ? 0 : state_.extraSamples[pixel];
    return static_cast<double>(state_.samples + extra);
}

Vec3d Film::meanColor(std::size_t pixel) const {
    return colorOf(state_.cameraSums, pixel) * mean(1.0, sampleCount(pixel)) +
           colorOf(state_.splatSums, pixel) * mean(1.0, static_cast<double>(state_.lightPaths));
}

double Film::luminance(std::size_t pixel) const { return luminanceOf(meanColor(pixel)); }

double Film::luminanceVariance(std::size_t pixel) const {
    const double n = sampleCount(pixel);
    return varianceOfMean(n * luminance(pixel),
                          state_.layerSums[slotOf(pixel, slots_.luminanceSquare)], n);
}

std::vector<ExrChannels> Film::channels() const {
    std::vector<ExrChannels> result;
    /// `value` maps a pixel and the channel's number to the channel's value.
    const auto addImage = [&](std::vector<std::string> names, const auto& value) {
        ExrChannels image{std::move(names), {}};
        const int count = static_cast<int>(image.names.size());
        image.pixels.reserve(pixelCount() * image.names.size());
        for (std::size_t pixel = 0; pixel < pixelCount(); ++pixel)
            for (int i = 0; i < count; ++i)
                image.pixels.push_back(static_cast<float>(value(pixel, i)));
        result.push_back(std::move(image));
    };
    const auto sum = [&](std::size_t pixel, int slot) {
        return state_.layerSums[slotOf(pixel, slot)];
    };
    const auto overSamples = [&](int slot) {
        return [&, slot](std::size_t pixel, int i) {
            return mean(sum(pixel, slot + i), sampleCount(pixel));
        };
    };
    const auto overHits = [&](int slot) {
        return [&, slot](std::size_t pixel, int i) {
            return mean(sum(pixel, slot + i), sum(pixel, slots_.hits));
        };
    };

    addImage({"R", "G", "B"}, [&](std::size_t pixel, int channel) {
        return rgbOf(color_, meanColor(pixel))[channel];
    });
    if (layers_.variance)
        addImage(color_ == FilmColor::xyz
                     ? std::vector<std::string>{"variance.X", "variance.Y", "variance.Z"}
                     : std::vector<std::string>{"variance.R", "variance.G", "variance.B"},
                 [&](std::size_t pixel, int i) {
                     return varianceOfMean(colorOf(state_.cameraSums, pixel)[i],
                                           sum(pixel, slots_.squares + i), sampleCount(pixel));
                 });
    // Of a spectral film that is one of the three above.
    if (layers_.luminanceVariance && !(layers_.variance && color_ == FilmColor::xyz))
        addImage({"variance.Y"}, [&](std::size_t pixel, int) { return luminanceVariance(pixel); });
    if (layers_.albedo) addImage({"albedo.R", "albedo.G", "albedo.B"}, overSamples(slots_.albedo));
    if (layers_.normal) addImage({"normal.X", "normal.Y", "normal.Z"}, overHits(slots_.normal));
    if (layers_.depth) addImage({"depth.Z"}, overHits(slots_.depth));
    if (layers_.position)
        addImage({"position.X", "position.Y", "position.Z"}, overHits(slots_.position));
    return result;
}

}  // namespace etendue
