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
    state_.colorSums.resize(pixelCount());
    state_.layerSums.resize(pixelCount() * static_cast<std::size_t>(slots_.count));
}

void Film::addTo(std::size_t slot, double value) {
    if (!state_.layerSums.add(slot, value)) countRounded();
}

void Film::addSquare(std::size_t slot, float value) {
    state_.layerSums.add(slot, double{value} * double{value});
}

void Film::addTo(std::size_t slot, Vec3 v) {
    for (int i = 0; i < 3; ++i) addTo(slot + static_cast<std::size_t>(i), double{v[i]});
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
    if (isSplattedOn())
        throw std::logic_error("film: a sample of one pixel, where light is splatted");
    addSample(pixelNumber(x, y), toVec3(value));
    return true;
}

void Film::addSample(std::size_t pixel, Vec3 light) {
    if (!state_.colorSums[pixel].add(light.x, light.y, light.z)) countRounded();
    if (slots_.squares >= 0)
        for (int i = 0; i < 3; ++i) addSquare(slotOf(pixel, slots_.squares + i), light[i]);
    if (slots_.luminanceSquare >= 0)
        addSquare(slotOf(pixel, slots_.luminanceSquare),
                  static_cast<float>(luminanceOf(toDouble(light))));
}

bool Film::addFeatures(int x, int y, const FilmFeatures& features) {
    const Vec3 albedo = toVec3(features.albedo);
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
    if (!isSplattedOn()) return;
    for (std::size_t pixel = first; pixel < end; ++pixel) {
        const Vec3 light = std::exchange(state_.sampleLight[pixel], {}).value();
        if (light == Vec3()) continue;
        // What is usable may add up to what is not.
        if (isUsable(light))
            addSample(pixel, light);
        else
            countBad();
    }
}

void Film::checkSize(const FilmState& other) const {
    const auto fits = [](std::size_t size, std::size_t expected) {
        return size == 0 || size == expected;
    };
    if (other.colorSums.size() != pixelCount() ||
        other.layerSums.size() != state_.layerSums.size() ||
        other.layerSums.rests.size() != other.layerSums.size() ||
        !fits(other.extraSamples.size(), pixelCount()) ||
        !fits(other.sampleLight.size(), pixelCount()))
        throw std::invalid_argument("film: the state is of another window or of other layers");
}

void Film::merge(const FilmState& other) {
    checkSize(other);
    for (std::size_t pixel = 0; pixel < pixelCount(); ++pixel)
        if (!state_.colorSums[pixel].add(other.colorSums[pixel])) ++state_.roundedTerms;
    const ExactSums& layers = other.layerSums;
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (!state_.layerSums.add(i, layers.sums[i], layers.rests[i])) ++state_.roundedTerms;
    if (!other.sampleLight.empty()) expectSplats();
    if (!other.extraSamples.empty() && countsUnfinished(other)) {
        expectUnfinishedSample();
        for (std::size_t pixel = 0; pixel < other.extraSamples.size(); ++pixel)
            state_.extraSamples[pixel] =
                static_cast<std::uint16_t>(state_.extraSamples[pixel] + other.extraSamples[pixel]);
    }
    state_.samples += other.samples;
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
    if (isSplattedOn() && state_.samples == 0) {
        const Vec3 light = state_.sampleLight[pixel].value();
        return isUsable(light) ? toDouble(light) : Vec3d();
    }
    return state_.colorSums[pixel].value() * mean(1.0, lightCount(pixel));
}

double Film::luminance(std::size_t pixel) const { return luminanceOf(meanColor(pixel)); }

double Film::luminanceVariance(std::size_t pixel) const {
    const double n = lightCount(pixel);
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
                     return varianceOfMean(state_.colorSums[pixel].value()[i],
                                           sum(pixel, slots_.squares + i), lightCount(pixel));
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
