// Rules of when pixels have had samples enough, tried on samples drawn before.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "bench/bench_scene.h"
#include "renderer/parallel.h"
#include "tools/picture_noise.h"

namespace etendue {

inline constexpr int stoppingWidth = 48, stoppingHeight = 32;
inline constexpr std::size_t stoppingPixels = stoppingWidth * stoppingHeight;

template <class Values>
double meanOf(const Values& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The luminances that one seed brings, all of a pixel one after the other.
struct Streams {
    std::size_t length;
    std::vector<float> values;
    std::span<const float> of(std::size_t pixel) const {
        return std::span(values).subspan(pixel * length, length);
    }
};

/// The estimator may splat nothing.
inline Streams drawStreams(const LoadedScene& loaded, std::size_t length, std::uint64_t seed) {
    const Filter filter = filterOf(loaded);
    const bool isSpectral = loaded.film.color == FilmColor::xyz;
    const View view{*loaded.scene, *loaded.camera, filter, isSpectral};
    const auto estimator = makeEstimator(loaded.estimator);
    Streams streams{length, std::vector<float>(stoppingPixels * length)};
    parallelFor(stoppingPixels, hardwareThreads(), [&](std::size_t p) {
        const int x = static_cast<int>(p) % stoppingWidth, y = static_cast<int>(p) / stoppingWidth;
        Sample sample;
        for (std::size_t i = 0; i < length; ++i) {
            const SampleId id{seed, x, y, static_cast<std::uint32_t>(i), loaded.sampler};
            estimator->takeSample(view, id, {}, sample);
            Spectrum v;
            for (const Contribution& c : sample.contributions) v += c.value * c.weight;
            streams.values[p * length + i] =
                isSpectral ? v[1] : 0.2126f * v[0] + 0.7152f * v[1] + 0.0722f * v[2];
        }
    });
    return streams;
}

/// Of each pixel: how many of its samples it takes; its mean over them.
using Counts = std::vector<std::size_t>;
using Means = std::vector<double>;

inline Means imageOf(const Streams& streams, const Counts& counts) {
    Means image;
    for (std::size_t p = 0; p < stoppingPixels; ++p)
        image.push_back(meanOf(streams.of(p).first(counts[p])));
    return image;
}

inline Means imageOf(const Streams& streams, std::size_t count) {
    return imageOf(streams, Counts(stoppingPixels, count));
}

/// Looks are rarer the more samples there are, as those of --error.
inline std::size_t nextLook(std::size_t samples) { return samples + samples / 8 + 1; }

/// Until the pixel's standard error is below `limit` of it. `floor` is added to its square, as in
/// --error, lest black pixels go on for ever.
inline std::size_t stopPixel(std::span<const float> values, double limit, double floor,
                             std::size_t fewest) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0, next = fewest; i < values.size(); ++i) {
        const double value{values[i]}, n = static_cast<double>(i + 1);
        sum += value;
        squares += value * value;
        if (i + 1 < next) continue;
        next = nextLook(i + 1);
        const double mean = sum / n, varianceOfMean = (squares / n - mean * mean) / (n - 1.0);
        if (varianceOfMean <= limit * limit * (mean * mean + floor)) return i + 1;
    }
    return values.size();
}

inline Counts stopPixels(const Streams& streams, double limit, std::size_t fewest) {
    const double mean = meanOf(imageOf(streams, fewest));
    Counts counts;
    for (std::size_t p = 0; p < stoppingPixels; ++p)
        counts.push_back(stopPixel(streams.of(p), limit, 0.01 * mean * mean, fewest));
    return counts;
}

/// Until `isDone` says so of the samples of every pixel and of --error's bound of the noise.
template <class IsDone>
std::size_t stopPicture(const Streams& streams, const IsDone& isDone) {
    FilmLayers layers;
    layers.luminanceVariance = true;
    Film film({stoppingWidth, stoppingHeight, 0, 0, stoppingWidth, stoppingHeight}, layers);
    for (std::size_t i = 0, next = 8; i < streams.length; ++i) {
        for (int y = 0; y < stoppingHeight; ++y)
            for (int x = 0; x < stoppingWidth; ++x) {
                const float v = streams.of(static_cast<std::size_t>(y * stoppingWidth + x))[i];
                film.add(x, y, rgb(v, v, v));
            }
        film.addSamples(1);
        if (i + 1 < next) continue;
        next = nextLook(i + 1);
        if (isDone(i + 1, pictureNoise(film).upperBound)) return i + 1;
    }
    return streams.length;
}

/// What a rule makes of each seed. A reference is of the same seed with a fixed number of samples:
/// it has no bias, but much of the same noise.
struct Rule {
    std::string name{};
    std::vector<Means> images{}, references{};
    std::vector<double> samples{};  // per pixel

    void add(const Streams& streams, const Counts& counts, std::size_t referenceCount) {
        images.push_back(imageOf(streams, counts));
        references.push_back(imageOf(streams, referenceCount));
        samples.push_back(meanOf(counts));
    }
};

/// All rules at one limit. A first seed says how many samples a pixel takes on the average: so many
/// everyone takes in uniform sampling, and --error gets the limit that takes as many.
struct Contest {
    Contest(double limitOfPixels, const Streams& first)
        : limit(limitOfPixels),
          count(static_cast<std::size_t>(meanOf(stopPixels(first, limit, 16)))) {
        stopPicture(first, [&](std::size_t samples, double bound) {
            pictureLimit = bound;
            return samples >= count;
        });
        picture.name = fmt::format("--error {:.3f}", pictureLimit);
    }

    /// `pilot` is of another seed.
    void run(const Streams& streams, const Streams& pilot) {
        const auto isDone = [&](std::size_t, double bound) { return bound <= pictureLimit; };
        uniform.add(streams, Counts(stoppingPixels, count), streams.length);
        picture.add(streams, Counts(stoppingPixels, stopPicture(streams, isDone)), count);
        pixel.add(streams, stopPixels(streams, limit, 16), streams.length);
        pixelFrom64.add(streams, stopPixels(streams, limit, 64), streams.length);
        byPilot.add(streams, stopPixels(pilot, limit, 16), streams.length);
        byPilot.samples.back() *= 2.0;  // those of the pilot have been taken, too
    }

    double limit;
    std::size_t count;
    double pictureLimit = 0.0;
    Rule uniform{"uniform"}, picture{}, pixel{"pixel"}, pixelFrom64{"pixel, from 64"},
        byPilot{"pixel, by pilot"};
};

}  // namespace etendue
