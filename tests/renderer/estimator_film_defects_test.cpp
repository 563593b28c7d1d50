// Defects that other renderers' trackers report of how light gets onto the film: borders, filters,
// focus, vignetting, and when to stop.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "tests/renderer/small_scenes.h"

using namespace etendue;

namespace {

const std::string sky = "[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";

Film filmOf(const LoadedScene& loaded) {
    return Film(loaded.film.fullFrame(), {}, loaded.film.color);
}

RenderResult renderInto(Film& film, const LoadedScene& loaded, const std::string& kind,
                        const RenderSettings& settings) {
    EstimatorSettings estimator = loaded.estimator;
    estimator.kind = kind;
    return render(*loaded.scene, *loaded.camera, *makeEstimator(estimator),
                  Filter(loaded.film.filter, loaded.film.filterRadius), film, settings, {});
}

struct RingAndRest {
    std::vector<double> ring, rest;
};

/// Means of the pixels at the border, and of all others.
RingAndRest ringAndRest(const LoadedScene& loaded, const std::string& kind, std::uint32_t samples) {
    RingAndRest result;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        Film film = filmOf(loaded);
        RenderSettings settings;
        settings.samples = samples;
        settings.seed = seed;
        renderInto(film, loaded, kind, settings);
        const std::vector<float> pixels = film.channels().front().pixels;
        double sums[2] = {}, counts[2] = {};
        for (int y = 0; y < loaded.film.height; ++y)
            for (int x = 0; x < loaded.film.width; ++x) {
                const bool isRing =
                    x == 0 || y == 0 || x == loaded.film.width - 1 || y == loaded.film.height - 1;
                sums[isRing] += pixels[static_cast<std::size_t>(3 * (y * loaded.film.width + x))];
                counts[isRing] += 1.0;
            }
        result.ring.push_back(sums[1] / counts[1]);
        result.rest.push_back(sums[0] / counts[0]);
    }
    return result;
}

}  // namespace

TEST_CASE("Estimators: a constant picture stays one under every filter, at its border too") {
    // cos⁴ over a field of 0.1° is 1 to 3e-6.
    const std::string scene = film() + pinhole("from = [0, 0, 1]\nto = [0, 0, 0]\n", 0.1) +
                              material("shine", 0.0, 1.0) +
                              mesh("rectangle", "shine", "{scale = [0.0016, 0.0012, 1]}");
    for (const std::string filter : {"box", "gaussian", "blackman-harris", "box 2", "gaussian 3"}) {
        CAPTURE(filter);
        const auto space = filter.find(' ');
        std::vector<std::string> overrides = {"film.filter=" + filter.substr(0, space)};
        if (space != std::string::npos)
            overrides.push_back("film.filter_radius=" + filter.substr(space + 1));
        const LoadedScene loaded = sceneFromText(scene, overrides);
        for (const char* kind : {"lt", "bdpt"}) {
            CAPTURE(std::string(kind));
            const RingAndRest means = ringAndRest(loaded, kind, 48);
            checkMean(means.ring, 1.0, 0.08, falseAlarmLevel / 20, 3e-6);
            checkMean(means.rest, 1.0, 0.05, falseAlarmLevel / 20, 3e-6);
        }
    }
}

/// A frame of 12 × 8 under a white sky, through a lens whose colours part by whole pixels.
LoadedScene partedSky(const std::string& filter) {
    const std::filesystem::path lens =
        std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses/petzval-50mm.toml";
    return sceneFromText("[film]\nwidth = 12\nheight = 8\nfilter = \"" + filter +
                         "\"\n[camera]\nlens = \"" + lens.string() +
                         "\"\nterms = 16\ndegree = 7\nsensor_width_mm = 0.15\n" + sky);
}

/// Of the sky's picture, seed by seed: each camera ray for its hero alone, by no estimator.
std::vector<std::vector<float>> skyByHeroes(const LoadedScene& loaded, std::uint32_t samples) {
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    const View view{*loaded.scene, *loaded.camera, filter, true};
    std::vector<std::vector<float>> result;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        Film film = filmOf(loaded);
        for (int y = 0; y < loaded.film.height; ++y)
            for (int x = 0; x < loaded.film.width; ++x)
                for (std::uint32_t i = 0; i < samples; ++i) {
                    const CameraSample sample = drawCameraSample(view, {seed, x, y, i});
                    const Wavelengths& wavelengths = sample.color.wavelengths;
                    const Spectrum white = wavelengths.lanesOf(Spectrum(1.0f));
                    const float weight = sample.ray ? sample.ray->weight : 0.0f;
                    film.add(x, y, sample.color.onFilm(heroAlone(white * weight)));
                }
        film.addSamples(samples);
        result.push_back(film.channels().front().pixels);
    }
    return result;
}

/// Its pictures by an estimator.
std::vector<std::vector<float>> skyBy(const std::string& kind, const LoadedScene& loaded,
                                      std::uint32_t samples) {
    std::vector<std::vector<float>> result;
    for (std::uint64_t seed = 101; seed <= 112; ++seed) {
        Film film = filmOf(loaded);
        RenderSettings settings;
        settings.samples = samples;
        settings.seed = seed;
        renderInto(film, loaded, kind, settings);
        result.push_back(film.channels().front().pixels);
    }
    return result;
}

TEST_CASE("Estimators: light that a lens parts is as bright at the frame's border" *
          doctest::test_suite("statistical")) {
    for (const std::string filter : {"box", "blackman-harris"}) {
        CAPTURE(filter);
        const LoadedScene loaded = partedSky(filter);
        REQUIRE(loaded.camera->settings().isDispersive);
        const auto expected = skyByHeroes(loaded, 4096);
        for (const std::string kind : {"pt", "bdpt"}) {
            CAPTURE(kind);
            const auto pictures = skyBy(kind, loaded, 256);
            // Tiles of one pixel: the border is a third of the frame, its corners are four.
            const PictureComparison comparison = comparePictures(pictures, expected, 12, 1);
            CAPTURE(comparison.smallestP);
            CAPTURE(comparison.relativeBias);
            CAPTURE(comparison.relativeBiasHalfWidth);
            CHECK(comparison.agree());
            CHECK(comparison.isEquivalent(0.01));
        }
    }
}

TEST_CASE("Estimators: a hero that goes on alone has all of its ray's weight back") {
    const LoadedScene loaded = partedSky("box");
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    const View view{*loaded.scene, *loaded.camera, filter, true};
    int rays = 0, lonely = 0;
    for (std::uint32_t i = 0; i < 10; ++i)
        for (int y = 0; y < loaded.film.height; ++y)
            for (int x = 0; x < loaded.film.width; ++x) {
                const CameraSample sample = drawCameraSample(view, {3, x, y, i});
                if (!sample.ray) continue;
                ++rays;
                lonely += sample.heroStandsFor < 3.0f;
                CHECK(heroAlone(sample.throughput, sample.heroStandsFor)[0] ==
                      doctest::Approx(Spectrum::lanes * sample.ray->weight).epsilon(1e-6));
            }
    CHECK(rays > 800);
    CHECK(lonely > 20);  // near the border, other wavelengths come from outside the frame
}

TEST_CASE("Estimators: a lens that parts colours adds little noise of colour" *
          doctest::test_suite("statistical")) {
    // Under a white sky there is no other noise: what light one sample of a pixel misses comes with
    // those of its neighbours, but for the share that lands elsewhere by chance.
    const LoadedScene loaded = partedSky("box");
    const auto blueVariance = [&](const std::vector<std::vector<float>>& pictures) {
        double sum = 0.0;
        for (std::size_t i = 2; i < pictures.front().size(); i += 3) {
            std::vector<double> values;
            for (const std::vector<float>& picture : pictures) values.push_back(double{picture[i]});
            sum += summarize(values).variance;
        }
        return sum;
    };
    CHECK(blueVariance(skyBy("pt", loaded, 64)) < 0.25 * blueVariance(skyByHeroes(loaded, 64)));
}

TEST_CASE("Estimators: a wall is as bright through a thin lens, wherever that is focused") {
    for (const std::string focus : {"0.5", "1.25", "10", "inf"}) {
        CAPTURE(focus);
        const LoadedScene loaded =
            sceneFromText(film() + thinLens(atOrigin, 1.4, focus) + shiningWall(1.2, 1.0));
        const std::vector<double> field = uniformField(loaded);
        checkRatio(goodMeans(loaded, "lt", 96), field, 1.0, 0.08);
        checkRatio(goodMeans(loaded, "bdpt", 16), field, 1.0, 0.03);
    }
}

TEST_CASE("Estimators: every camera that loads can be connected to") {
    // Light tracing has nothing but connections: where a camera could not make them the picture
    // would be black, or the render would end in the middle.
    const std::string lenses =
        (std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses").string();
    const std::string lens =
        "lens = \"" + lenses + "/tessar-100mm.toml\"\nterms = 12\ndegree = 5\n" + "dispersion = ";
    for (const std::string& camera :
         {std::string("model = \"pinhole\"\n"),
          std::string("model = \"thin-lens\"\nf_number = 2\nfocus_distance = 3\n"),
          lens + "false\n", lens + "true\nrepresentation = \"sensor-state\"\n",
          lens + "false\nrepresentation = \"traced\"\n"}) {
        CAPTURE(camera);
        goodMeans(sceneFromText(film() + "[camera]\n" + camera + atOrigin + shiningWall(1.2, 1.0)),
                  "lt", 4, 2);
    }
    // What light tracing cannot do with a camera is refused before it starts.
    CHECK_THROWS_WITH_AS(sceneFromText(film() + pinhole(atOrigin) + sky,
                                       {"estimator.kind=lt", "estimator.pupil_sampling=outer"}),
                         doctest::Contains("pupil_sampling"), InputError);
    CHECK_THROWS_WITH_AS(sceneFromText(film() + "[camera]\n" + lens + "false\n" + atOrigin + sky,
                                       {"estimator.kind=bdpt", "estimator.pupil_sampling=outer"}),
                         doctest::Contains("pupil_sampling"), InputError);
    CHECK_THROWS_WITH_AS(sceneFromText(film() + pinhole(atOrigin) + sky,
                                       {"estimator.kind=lt", "estimator.techniques=s1"}),
                         doctest::Contains("techniques"), InputError);
}

TEST_CASE("Estimators: parts of a render are put together by sums and counts") {
    // Parts that ended by the clock have different counts of samples; the mean of their pictures
    // would weigh the samples of the shorter one more.
    const LoadedScene loaded = sceneFromText(film() + thinLens(standing, 2.0, "3.4") + room());
    for (const char* kind : kinds) {
        CAPTURE(std::string(kind));
        Film first = filmOf(loaded), second = filmOf(loaded);
        RenderSettings settings;
        settings.samples = 2;
        renderInto(first, loaded, kind, settings);
        settings.samples = 7;
        settings.seed = 1;
        renderInto(second, loaded, kind, settings);
        const std::vector<float> a = first.channels().front().pixels,
                                 b = second.channels().front().pixels;
        first.merge(second.state());
        CHECK(first.samples() == 9);
        const std::vector<float> merged = first.channels().front().pixels;
        for (std::size_t i = 0; i < merged.size(); ++i) {
            // Floats hold the parts' means, each rounded once.
            const double expected = (2.0 * a[i] + 7.0 * b[i]) / 9.0;
            CHECK(std::abs(merged[i] - expected) <= 2 * 0x1p-24 * expected);
        }
    }
}

TEST_CASE("Estimators: a render that the clock ends is whole passes of all pixels") {
    const LoadedScene loaded = sceneFromText(film() + thinLens(standing, 2.0, "3.4") + room());
    for (const char* kind : kinds) {
        CAPTURE(std::string(kind));
        Film byClock = filmOf(loaded), byCount = filmOf(loaded);
        RenderSettings settings;
        settings.seed = 3;
        settings.samples = unlimitedSamples;
        settings.timeLimitSeconds = 0.05;
        const RenderResult result = renderInto(byClock, loaded, kind, settings);
        CHECK(byClock.samples() == result.samples);
        settings.samples = result.samples;
        settings.timeLimitSeconds = std::numeric_limits<double>::infinity();
        renderInto(byCount, loaded, kind, settings);
        CHECK(byClock.channels().front().pixels == byCount.channels().front().pixels);
    }
}
