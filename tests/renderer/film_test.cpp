#include "renderer/film.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "renderer/random.h"
#include "statistics/statistics.h"

namespace etendue {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

FrameWindow fullFrame(int width, int height) { return {width, height, 0, 0, width, height}; }

constexpr FilmLayers everything{
    .albedo = true, .normal = true, .depth = true, .position = true, .variance = true};

/// The image whose first channel is called `name`.
ExrChannels image(const Film& film, const std::string& name) {
    for (const ExrChannels& channels : film.channels())
        if (channels.names.front() == name) return channels;
    FAIL("no channel " << name);
    return {};
}

/// A sample that depends on where in the full frame it falls and on nothing else.
void addNoise(Film& film, std::uint32_t firstSample, std::uint32_t count) {
    const FrameWindow& w = film.window();
    for (int y = w.y; y < w.y + w.height; ++y)
        for (int x = w.x; x < w.x + w.width; ++x)
            for (std::uint32_t sample = firstSample; sample < firstSample + count; ++sample) {
                RandomStream random(5, static_cast<std::uint32_t>(y * w.fullWidth + x), sample,
                                    RandomDomain::test);
                const float r = random.next(), g = random.next(), b = random.next();
                film.add(x, y, rgb(r, g, b));
                if (random.next() < 0.5f)
                    film.addFeatures(x, y, {rgb(b, r, g), {r, g, -b}, {g, b, r}, r + g});
            }
    film.addSamples(count);
}

TEST_CASE("Film: a pixel is the mean of its samples") {
    Film film(fullFrame(3, 2));
    film.add(0, 0, rgb(1, 2, 3));
    film.add(0, 0, rgb(3, 0, 4));
    film.add(2, 1, rgb(0, 8, 0));
    film.addSamples(4);
    const auto channels = film.channels();
    REQUIRE(channels.size() == 1);
    CHECK(channels[0].names == std::vector<std::string>{"R", "G", "B"});
    std::vector<float> expected(3 * 2 * 3, 0.0f);
    expected[0] = 1.0f;
    expected[1] = 0.5f;
    expected[2] = 1.75f;
    expected[3 * 5 + 1] = 2.0f;
    CHECK(channels[0].pixels == expected);
    CHECK(film.samples() == 4);
}

TEST_CASE("Film: many small samples are not lost beside a large one") {
    Film film(fullFrame(1, 1));
    film.add(0, 0, rgb(16777216.0f, 0, 0));  // 2²⁴, to which a float adds no 1
    constexpr int count = 1000000;
    for (int i = 0; i < count; ++i) film.add(0, 0, rgb(1, 0, 0));
    film.addSamples(1);
    CHECK(image(film, "R").pixels[0] == 17777216.0f);
}

TEST_CASE("Film: it takes 30 bytes a pixel, 18 more for splats, 12 for the luminance's variance") {
    const auto bytes = [](const Film& film) {
        const FilmState& state = film.state();
        return state.colorSums.size() * sizeof(ExactColor) +
               state.layerSums.size() * (sizeof(double) + sizeof(float)) +
               state.sampleLight.size() * sizeof(SampleLight);
    };
    Film film(fullFrame(100, 10));
    CHECK_FALSE(film.wantsFeatures());
    CHECK(bytes(film) == 30 * 1000);
    CHECK(film.add(0, 0, rgb(1, 1, 1)));
    film.expectSplats();
    CHECK(bytes(film) == 48 * 1000);
    CHECK_THROWS_AS(film.add(0, 0, rgb(1, 1, 1)), std::logic_error);
    CHECK(bytes(Film(fullFrame(100, 10), {.luminanceVariance = true})) == 42 * 1000);
}

TEST_CASE("Film: a crop is that window of the full frame") {
    Film full(fullFrame(16, 9), everything);
    const FrameWindow window{16, 9, 5, 2, 7, 4};
    Film crop(window, everything);
    addNoise(full, 0, 8);
    addNoise(crop, 0, 8);
    const auto fullChannels = full.channels(), cropChannels = crop.channels();
    REQUIRE(fullChannels.size() == 6);
    REQUIRE(cropChannels.size() == 6);
    for (std::size_t k = 0; k < 6; ++k) {
        CHECK(cropChannels[k].names == fullChannels[k].names);
        const std::size_t n = cropChannels[k].names.size();
        for (std::size_t y = 0; y < 4; ++y)
            for (std::size_t x = 0; x < 7; ++x)
                for (std::size_t i = 0; i < n; ++i)
                    CHECK(cropChannels[k].pixels[(y * 7 + x) * n + i] ==
                          fullChannels[k].pixels[((y + 2) * 16 + x + 5) * n + i]);
    }
}

TEST_CASE("Film: merging two ranges of samples gives the render of their union") {
    Film whole(fullFrame(6, 5), everything), first = whole, second = whole;
    addNoise(whole, 0, 16);
    addNoise(first, 0, 5);
    addNoise(second, 5, 11);
    first.merge(second.state());
    CHECK(first.samples() == 16);
    CHECK(first.state().colorSums == whole.state().colorSums);
    CHECK(first.state().layerSums == whole.state().layerSums);
    CHECK(first.state().roundedTerms == 0);
    Film other(fullFrame(5, 5), everything), fewer(fullFrame(6, 5));
    CHECK_THROWS_AS(first.merge(other.state()), std::invalid_argument);
    CHECK_THROWS_AS(first.merge(fewer.state()), std::invalid_argument);
}

TEST_CASE("Film: parts merge to the same bits in whatever order, splats and all") {
    FilmLayers layers;
    layers.luminanceVariance = true;
    constexpr int parts = 5;
    std::vector<Film> films(parts + 1, Film(fullFrame(6, 5), layers));  // the last: all at once
    for (Film& film : films) film.expectSplats();
    for (int sample = 0; sample < 40; ++sample)
        for (Film* film : {&films[static_cast<std::size_t>(sample / 8)], &films[parts]}) {
            for (int i = 0; i < 60; ++i)
                film->addToSample(i % 6, i / 6 % 5,
                                  {std::exp2(float(sample * i % 37) - 20.0f), 1, 3});
            film->finishSample(0, 5);
            film->addSamples(1);
        }
    for (const std::vector<std::size_t>& order :
         {std::vector<std::size_t>{0, 1, 2, 3, 4}, {4, 2, 0, 3, 1}, {3, 4, 1, 2, 0}}) {
        Film merged(fullFrame(6, 5), layers);
        for (const std::size_t i : order) merged.merge(films[i].state());
        CHECK(merged.state().colorSums == films[parts].state().colorSums);
        CHECK(merged.state().layerSums == films[parts].state().layerSums);
        CHECK(merged.state().roundedTerms == 0);
        CHECK(image(merged, "variance.Y").pixels == image(films[parts], "variance.Y").pixels);
    }
}

TEST_CASE("Film: the luminance's variance is that of whole samples, splats included") {
    FilmLayers layers;
    layers.luminanceVariance = true;
    Film film(fullFrame(1, 1), layers);
    film.expectSplats();
    // Luminances 1 + 3, 0 + 1, 2 + 0: mean 7/3, their variance 7/3.
    const float camera[] = {1, 0, 2}, splats[] = {3, 1, 0};
    for (int s = 0; s < 3; ++s) {
        for (const float light : {camera[s], splats[s]})
            film.addToSample(0, 0, {light, light, light});
        film.finishSample(0, 1);
        film.addSamples(1);
    }
    CHECK(film.luminance(0) == doctest::Approx(7.0 / 3.0));
    CHECK(film.luminanceVariance(0) == doctest::Approx(7.0 / 9.0));
    CHECK(image(film, "variance.Y").pixels[0] == doctest::Approx(7.0 / 9.0));
}

TEST_CASE("Film: a pixel that has had an unfinished sample is divided by one more") {
    Film film(fullFrame(2, 1));
    for (int x = 0; x < 2; ++x) film.add(x, 0, rgb(1, 1, 1));
    film.addSamples(1);
    film.expectUnfinishedSample();
    film.add(1, 0, rgb(4, 4, 4));
    film.countUnfinished(1, 0);
    CHECK(image(film, "R").pixels == std::vector<float>{1, 1, 1, 2.5f, 2.5f, 2.5f});
    // Finished, all have had as many.
    film.add(0, 0, rgb(2, 2, 2));
    film.finishSample(0, 1);
    film.addSamples(1);
    CHECK(image(film, "R").pixels == std::vector<float>{1.5f, 1.5f, 1.5f, 2.5f, 2.5f, 2.5f});
}

TEST_CASE("Film: light that is splatted is in the picture when its sample is whole, or the first") {
    Film film(fullFrame(2, 1), {.luminanceVariance = true});
    film.expectSplats();
    film.addToSample(0, 0, {1, 2, 3});
    CHECK(image(film, "R").pixels == std::vector<float>{1, 2, 3, 0, 0, 0});
    film.finishSample(0, 1);
    film.addSamples(1);
    film.expectUnfinishedSample();
    film.addToSample(0, 0, {9, 9, 9});
    film.countUnfinished(0, 0);
    CHECK(image(film, "R").pixels == std::vector<float>{1, 2, 3, 0, 0, 0});
    CHECK(film.luminanceVariance(0) == 0.0);
    // Of others, too. The sample that this one has begun is its own to finish.
    Film merged(fullFrame(2, 1), {.luminanceVariance = true});
    for (int i = 0; i < 2; ++i) merged.merge(film.state());
    CHECK(image(merged, "R").pixels == std::vector<float>{1, 2, 3, 0, 0, 0});
    film.finishSample(0, 1);
    film.addSamples(1);
    CHECK(image(film, "R").pixels == std::vector<float>{5, 5.5f, 6, 0, 0, 0});
    CHECK(film.luminanceVariance(0) > 0.0);
}

TEST_CASE(
    "Film: many equal splats of a sample are not lost, as those of a light path each may be") {
    Film film(fullFrame(1, 1));
    film.expectSplats();
    constexpr int count = 1 << 25;  // twice as many as a float can count
    for (int i = 0; i < count; ++i) film.addToSample(0, 0, {1.0f, 0.1f, 0.7f});
    film.finishSample(0, 1);
    film.addSamples(1);
    const std::vector<float> sums = image(film, "R").pixels;
    const double bound = count * 0x1p-38;
    for (const auto& [sum, term] : {std::pair(sums[0], 1.0f), {sums[1], 0.1f}, {sums[2], 0.7f}})
        CHECK(std::abs(double{sum} / (double{term} * count) - 1.0) <= bound);
}

TEST_CASE("Film: splats that add up to what is not finite are counted and left out") {
    Film film(fullFrame(2, 1));
    film.expectSplats();
    constexpr float most = std::numeric_limits<float>::max();
    for (int i = 0; i < 2; ++i) film.addToSample(0, 0, {most, 0, 0});
    film.addToSample(1, 0, {most, 0, 0});
    CHECK(image(film, "R").pixels == std::vector<float>{0, 0, 0, most, 0, 0});
    film.finishSample(0, 1);
    film.addSamples(1);
    CHECK(film.badSamples() == 1);
    CHECK(image(film, "R").pixels == std::vector<float>{0, 0, 0, most, 0, 0});
}

TEST_CASE("Film: a render goes on from a saved state to the same bits") {
    Film whole(fullFrame(6, 5), everything), stopped = whole, resumed(fullFrame(6, 5), everything);
    addNoise(whole, 0, 7);
    addNoise(whole, 7, 9);
    addNoise(stopped, 0, 7);
    resumed.restore(stopped.state());
    addNoise(resumed, 7, 9);
    CHECK(resumed.state().colorSums == whole.state().colorSums);
    CHECK(resumed.state().layerSums == whole.state().layerSums);
    CHECK(resumed.samples() == whole.samples());
    CHECK_THROWS_AS(resumed.restore(FilmState{}), std::invalid_argument);
}

TEST_CASE("Film: normal, depth and position are means over what was met, albedo over all samples") {
    Film film(fullFrame(2, 1), everything);
    CHECK(film.wantsFeatures());
    film.addFeatures(0, 0, {rgb(0.5f, 1, 0), {0, 0, 1}, {1, 2, 3}, 10.0f});
    film.addFeatures(0, 0, {rgb(0.5f, 0, 0), {0, 1, 0}, {3, 4, 5}, 20.0f});
    for (int i = 0; i < 4; ++i) film.add(0, 0, rgb(1, 1, 1));
    film.addSamples(4);
    CHECK(image(film, "albedo.R").pixels == std::vector<float>{0.25f, 0.25f, 0, 0, 0, 0});
    CHECK(image(film, "normal.X").pixels == std::vector<float>{0, 0.5f, 0.5f, 0, 0, 0});
    CHECK(image(film, "depth.Z").pixels == std::vector<float>{15, 0});
    CHECK(image(film, "position.X").pixels == std::vector<float>{2, 3, 4, 0, 0, 0});
}

TEST_CASE("Film: each layer stands alone") {
    const auto only = [](auto choose) {
        FilmLayers layers;
        choose(layers);
        Film film(fullFrame(1, 1), layers);
        film.add(0, 0, rgb(1, 1, 1));
        film.add(0, 0, rgb(3, 1, 1));
        film.addFeatures(0, 0, {rgb(0.5f, 0.5f, 0.5f), {0, 0, 1}, {1, 2, 3}, 10.0f});
        film.addSamples(2);
        const auto channels = film.channels();
        REQUIRE(channels.size() == 2);
        CHECK(channels[0].pixels == std::vector<float>{2, 1, 1});
        return channels[1].pixels;
    };
    using Pixel = std::vector<float>;
    CHECK(only([](FilmLayers& l) { l.albedo = true; }) == Pixel{0.25f, 0.25f, 0.25f});
    CHECK(only([](FilmLayers& l) { l.normal = true; }) == Pixel{0, 0, 1});
    CHECK(only([](FilmLayers& l) { l.depth = true; }) == Pixel{10});
    CHECK(only([](FilmLayers& l) { l.position = true; }) == Pixel{1, 2, 3});
    CHECK(only([](FilmLayers& l) { l.variance = true; }) == Pixel{1, 0, 0});
}

TEST_CASE("Film: the variance estimate is that of the pixel's mean, without bias") {
    // Uniform numbers: variance 1/12; of the mean of n, 1/(12 n).
    constexpr std::uint32_t n = 5;
    Film film(fullFrame(100, 100), everything);
    addNoise(film, 0, n);
    const auto pixels = image(film, "variance.R").pixels;
    const Summary summary = summarize(std::vector<double>(pixels.begin(), pixels.end()));
    const double z = (summary.mean - 1.0 / (12.0 * n)) / summary.standardError;
    CHECK(normalTwoSidedP(z) > 1e-3);
    // Enough samples that a divisor of n² for n (n − 1) would show: it is off by 20 %.
    CHECK(summary.standardError < 0.01 * summary.mean);
}

TEST_CASE("Film: the variance is zero for equal samples, and before there are two") {
    constexpr int width = 100, count = 100;
    Film film(fullFrame(width, 1), everything);
    const auto addAll = [&] {
        for (int x = 0; x < width; ++x) {
            const float value = static_cast<float>(x + 1) / 97.0f;
            film.add(x, 0, rgb(value, value, value));
        }
        film.addSamples(1);
    };
    addAll();
    for (const float v : image(film, "variance.R").pixels) CHECK(v == 0.0f);
    for (int i = 1; i < count; ++i) addAll();
    for (const float v : image(film, "variance.R").pixels) {
        CHECK(v >= 0.0f);
        // Fewer than 2 n roundings of sums up to n · 1.04² by 2⁻⁵³, over n (n − 1).
        CHECK(v <= 2.2f * count / (count - 1) * 0x1p-53f);
    }
}

TEST_CASE("Film: a sample that is negative or not finite is counted, reported and left out") {
    Film film(fullFrame(1, 1), everything);
    CHECK(film.add(0, 0, rgb(1, 2, 3)));
    CHECK_FALSE(film.add(0, 0, rgb(nan, 0, 0)));
    CHECK_FALSE(film.add(0, 0, rgb(0, infinity, 0)));
    CHECK_FALSE(film.add(0, 0, rgb(0, 0, -1e-20f)));
    CHECK(film.badSamples() == 3);
    const FilmFeatures good{rgb(1, 1, 1), {0, 0, 1}, {1, 2, 3}, 4.0f};
    CHECK(film.addFeatures(0, 0, good));
    const auto refuses = [&](auto spoil) {
        FilmFeatures bad = good;
        spoil(bad);
        CHECK_FALSE(film.addFeatures(0, 0, bad));
    };
    refuses([](FilmFeatures& f) { f.albedo = rgb(0, nan, 0); });
    refuses([](FilmFeatures& f) { f.normal.y = nan; });
    refuses([](FilmFeatures& f) { f.position.z = infinity; });
    refuses([](FilmFeatures& f) { f.depth = infinity; });
    CHECK(film.badSamples() == 7);
    film.addSamples(4);
    CHECK(image(film, "R").pixels == std::vector<float>{0.25f, 0.5f, 0.75f});
    CHECK(image(film, "depth.Z").pixels == std::vector<float>{4.0f});
    for (const ExrChannels& channels : film.channels())
        for (const float v : channels.pixels) CHECK(std::isfinite(v));
}

TEST_CASE("Film: before the first sample everything is zero") {
    const Film film(fullFrame(2, 2), everything);
    for (const ExrChannels& channels : film.channels())
        for (const float v : channels.pixels) CHECK(v == 0.0f);
}

TEST_CASE("Film: a window without pixels or beyond the frame is refused") {
    for (const FrameWindow& window :
         {FrameWindow{10, 10, 0, 0, 0, 5}, FrameWindow{10, 10, 0, 0, 5, -1},
          FrameWindow{10, 10, -1, 0, 5, 5}, FrameWindow{10, 10, 6, 0, 5, 5},
          FrameWindow{10, 10, 0, 6, 5, 5}, FrameWindow{10, 10, 2147483647, 0, 5, 5},
          FrameWindow{0, 0, 0, 0, 0, 0}})
        CHECK_THROWS_AS(Film film(window), std::invalid_argument);
}

}  // namespace
}  // namespace etendue
