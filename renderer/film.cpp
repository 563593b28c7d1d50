#include "renderer/film.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <tuple>

#include "renderer/colorimetry.h"

namespace etendue {

namespace {

void addTo(double* sums, Vec3 v) {
    sums[0] += v.x;
    sums[1] += v.y;
    sums[2] += v.z;
}

Vec3 firstLanes(const Spectrum& s) { return {s[0], s[1], s[2]}; }

bool sameWindow(const FrameWindow& a, const FrameWindow& b) {
    const auto numbers = [](const FrameWindow& w) {
        return std::tie(w.fullWidth, w.fullHeight, w.x, w.y, w.width, w.height);
    };
    return numbers(a) == numbers(b);
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
    state_.sums.resize(static_cast<std::size_t>(window.width) *
                       static_cast<std::size_t>(window.height) *
                       static_cast<std::size_t>(slots_.count));
}

double* Film::pixelSums(int x, int y) {
    return state_.sums.data() + pixelNumber(x, y) * static_cast<std::size_t>(slots_.count);
}

void Film::expectSplats() {
    state_.splatSums.resize(3 * state_.sums.size() / static_cast<std::size_t>(slots_.count));
}

bool Film::countBad() {
    std::atomic_ref(state_.badSamples).fetch_add(1, std::memory_order_relaxed);
    return false;
}

bool Film::add(int x, int y, const Spectrum& value) {
    if (!isUsable(value)) return countBad();
    const Vec3 color = firstLanes(value);
    double* sums = pixelSums(x, y);
    addTo(sums, color);
    if (slots_.squares >= 0) {
        for (int i = 0; i < 3; ++i) sums[slots_.squares + i] += double{color[i]} * color[i];
    }
    return true;
}

bool Film::addFeatures(int x, int y, const FilmFeatures& features) {
    const Vec3 albedo = firstLanes(features.albedo);
    if (!isUsable(features.albedo) || !isFinite(features.normal) || !isFinite(features.position) ||
        !std::isfinite(features.depth))
        return countBad();
    double* sums = pixelSums(x, y);
    if (slots_.hits >= 0) sums[slots_.hits] += 1.0;
    if (slots_.albedo >= 0) addTo(sums + slots_.albedo, albedo);
    if (slots_.normal >= 0) addTo(sums + slots_.normal, features.normal);
    if (slots_.depth >= 0) sums[slots_.depth] += features.depth;
    if (slots_.position >= 0) addTo(sums + slots_.position, features.position);
    return true;
}

void Film::merge(const Film& other) {
    if (!sameWindow(window_, other.window_) || layers_ != other.layers_ || color_ != other.color_)
        throw std::invalid_argument("film: merged renders must share window and layers");
    std::transform(state_.sums.begin(), state_.sums.end(), other.state_.sums.begin(),
                   state_.sums.begin(), std::plus<>());
    if (!other.state_.splatSums.empty()) expectSplats();
    std::transform(other.state_.splatSums.begin(), other.state_.splatSums.end(),
                   state_.splatSums.begin(), state_.splatSums.begin(), std::plus<>());
    state_.samples += other.state_.samples;
    state_.lightPaths += other.state_.lightPaths;
    state_.badSamples += other.state_.badSamples;
}

void Film::restore(FilmState state) {
    if (state.sums.size() != state_.sums.size())
        throw std::invalid_argument("film: the saved state is of another size");
    state_ = std::move(state);
}

std::vector<ExrChannels> Film::channels() const {
    const auto stride = static_cast<std::size_t>(slots_.count);
    std::vector<ExrChannels> result;
    /// `value` maps a pixel's sums and the channel's number to the channel's value.
    const auto addImage = [&](std::vector<std::string> names, const auto& value) {
        ExrChannels image{std::move(names), {}};
        const int count = static_cast<int>(image.names.size());
        image.pixels.reserve(state_.sums.size() / stride * image.names.size());
        for (std::size_t p = 0; p < state_.sums.size(); p += stride)
            for (int i = 0; i < count; ++i)
                image.pixels.push_back(static_cast<float>(value(&state_.sums[p], i)));
        result.push_back(std::move(image));
    };
    const auto n = static_cast<double>(state_.samples);
    const auto overSamples = [n](int slot) {
        return [=](const double* sums, int i) { return mean(sums[slot + i], n); };
    };
    const auto overHits = [hits = slots_.hits](int slot) {
        return [=](const double* sums, int i) { return mean(sums[slot + i], sums[hits]); };
    };

    const auto lightPaths = static_cast<double>(state_.lightPaths);
    addImage({"R", "G", "B"}, [&](const double* sums, int channel) {
        Vec3d value = Vec3d{sums[0], sums[1], sums[2]} * mean(1.0, n);
        if (!state_.splatSums.empty()) {
            const double* splats =
                &state_
                     .splatSums[3 * (static_cast<std::size_t>(sums - state_.sums.data()) / stride)];
            value += Vec3d{splats[0], splats[1], splats[2]} * mean(1.0, lightPaths);
        }
        return rgbOf(color_, value)[channel];
    });
    if (layers_.variance)
        addImage(color_ == FilmColor::xyz
                     ? std::vector<std::string>{"variance.X", "variance.Y", "variance.Z"}
                     : std::vector<std::string>{"variance.R", "variance.G", "variance.B"},
                 [&](const double* sums, int i) {
                     return varianceOfMean(sums[i], sums[slots_.squares + i], n);
                 });
    if (layers_.albedo) addImage({"albedo.R", "albedo.G", "albedo.B"}, overSamples(slots_.albedo));
    if (layers_.normal) addImage({"normal.X", "normal.Y", "normal.Z"}, overHits(slots_.normal));
    if (layers_.depth) addImage({"depth.Z"}, overHits(slots_.depth));
    if (layers_.position)
        addImage({"position.X", "position.Y", "position.Z"}, overHits(slots_.position));
    return result;
}

}  // namespace etendue
