#include "renderer/render.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <numeric>

#include "renderer/splats.h"
#include "statistics/statistics.h"
#include "tests/support/scenes.h"

using namespace etendue;

namespace {

/// A little of everything: glossy, glass, instances, three kinds of light, a thin lens.
const std::string mixedScene = R"(
[film]
width = 48
height = 32
[camera]
model = "thin-lens"
from = [0, 1.2, 4]
to = [0, 0.6, 0]
f_number = 0.2
focus_distance = 4
[[material]]
name = "floor"
type = "plastic"
color = [0.5, 0.4, 0.3]
roughness = 0.4
[[material]]
name = "glass"
type = "dielectric"
[[material]]
name = "gold"
type = "conductor"
metal = "gold"
roughness = 0.3
[[material]]
name = "lamp"
color = [0, 0, 0]
emission = [8, 7, 5]
[[mesh]]
shape = "rectangle"
material = "floor"
transform = [{scale = 5}, {rotate = [1, 0, 0, -90]}]
[[mesh]]
name = "ball"
shape = "sphere"
hidden = true
[[instance]]
mesh = "ball"
material = "glass"
transform = [{scale = 0.5}, {translate = [-0.6, 0.5, 0]}]
[[instance]]
mesh = "ball"
material = "gold"
transform = [{scale = 0.5}, {translate = [0.6, 0.5, 0]}]
[[mesh]]
shape = "disc"
material = "lamp"
transform = [{scale = 0.5}, {rotate = [1, 0, 0, 90]}, {translate = [0, 3, 0]}]
[[light]]
type = "constant"
radiance = [0.1, 0.15, 0.3]
[[light]]
type = "point"
position = [2, 2, 2]
intensity = [3, 3, 3]
)";

/// The same through a lens that parts colours.
LoadedScene partedScene(const std::vector<std::string>& overrides) {
    const std::filesystem::path lens =
        std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses/petzval-50mm.toml";
    std::string scene = mixedScene;
    const std::string thinLens = "model = \"thin-lens\"\n", opening = "f_number = 0.2\n";
    scene.replace(scene.find(thinLens), thinLens.size(),
                  "lens = \"" + lens.string() + "\"\nterms = 8\ndegree = 5\n");
    scene.erase(scene.find(opening), opening.size());
    LoadedScene loaded = sceneFromText(scene, overrides);
    REQUIRE(loaded.camera->settings().isDispersive);
    return loaded;
}

struct Parted {
    bool isParted;
    LoadedScene loaded;
};

/// Of an estimator: through a thin lens, and through one that parts colours.
std::vector<Parted> eitherScene(const std::string& kind, std::vector<std::string> overrides = {}) {
    overrides.push_back("estimator.kind=" + kind);
    std::vector<Parted> result;
    result.push_back({false, sceneFromText(mixedScene, overrides)});
    result.push_back({true, partedScene(overrides)});
    return result;
}

}  // namespace

TEST_CASE("Render: the same bits with 1, 2 and 8 threads") {
    for (const char* kind : {"pt", "lt", "bdpt"}) {
        for (const Parted& either : eitherScene(kind)) {
            const LoadedScene& loaded = either.loaded;
            const bool isParted = either.isParted;
            CAPTURE(std::string(kind));
            CAPTURE(isParted);
            const std::vector<float> one = renderPixels(loaded, 4, 11, 1);
            CHECK(renderPixels(loaded, 4, 11, 2) == one);
            CHECK(renderPixels(loaded, 4, 11, 8) == one);
            CHECK(renderPixels(loaded, 4, 12, 1) != one);
        }
    }
}

/// Splats anywhere what differs so much in size that any other order of adding has another sum.
class WildSplats final : public Estimator {
public:
    void takeSample(const View&, SampleId id, SampleRequest, Sample& result) const override {
        result.contributions.clear();
        RandomStream random(id.seed, static_cast<std::uint32_t>(id.y * 96 + id.x), id.sample,
                            RandomDomain::test);
        const Vec2 film = random.next2();
        const float size = std::exp2(60.0f * random.next() - 30.0f) * (1.0f + random.next());
        result.contributions.push_back({.technique = {2, 1},
                                        .value = Spectrum(size),
                                        .film = {96.0f * film.x, 64.0f * film.y},
                                        .isSplat = true});
    }
    int lightPathsPerSample() const override { return 1; }
};

TEST_CASE("Render: …whether the frame has more parts than are splatted at a time, or fewer") {
    // 96 parts: one thread takes 48 at a time, two all of one sample, sixteen those of ten samples.
    const LoadedScene loaded = sceneFromText(mixedScene, {"film.width=96", "film.height=64"});
    const Filter filter(FilterKind::box);
    const auto splats = [&](int threads) -> std::vector<ExactColor> {
        Film film({96, 64, 0, 0, 96, 64});
        RenderSettings settings;
        settings.samples = 40;
        settings.threads = threads;
        render(*loaded.scene, *loaded.camera, WildSplats(), filter, film, settings, {});
        return film.state().colorSums;
    };
    const std::vector<ExactColor> one = splats(1);
    CHECK(splats(2) == one);
    CHECK(splats(16) == one);
}

TEST_CASE("Render: a film has room for a sample's splats if there are any, and no more") {
    for (const char* estimator : {"pt", "lt", "bdpt"})
        for (const Parted& either : eitherScene(estimator)) {
            const LoadedScene& loaded = either.loaded;
            const bool isParted = either.isParted;
            CAPTURE(std::string(estimator));
            CAPTURE(isParted);
            Film film(loaded.film.fullFrame(), {}, loaded.film.color);
            RenderSettings settings;
            settings.samples = 1;
            render(*loaded.scene, *loaded.camera, *makeEstimator(loaded.estimator),
                   Filter(FilterKind::box), film, settings, {});
            const bool isSplatting = isParted || std::string(estimator) != "pt";
            CHECK(film.state().sampleLight.size() == (isSplatting ? 48 * 32 : 0));
        }
}

TEST_CASE("Render: …and for any division into passes") {
    const LoadedScene loaded = sceneFromText(mixedScene, {"estimator.kind=bdpt"});
    const std::vector<float> whole = renderPixels(loaded, 6, 3);
    Film film({48, 32, 0, 0, 48, 32});
    const Filter filter(FilterKind::box);
    const View view{*loaded.scene, *loaded.camera, filter};
    const auto estimator = makeEstimator(loaded.estimator);
    film.expectSplats();
    // Sample by sample and pixel by pixel, in the order that passes keep to.
    for (std::uint32_t s = 0; s < 6; ++s)
        for (int tileY = 0; tileY < 32; tileY += 16)
            for (int tileX = 0; tileX < 48; tileX += 16) {
                std::vector<SplatList> splats(1, SplatList(film.window(), filter));
                for (int y = tileY; y < tileY + 16; ++y)
                    for (int x = tileX; x < tileX + 16; ++x) {
                        Sample sample;
                        estimator->takeSample(view, {3, x, y, s}, {}, sample);
                        Spectrum sum;
                        for (const Contribution& c : sample.contributions)
                            if (c.isSplat)
                                splats[0].add(c, static_cast<float>(1.0 / (48 * 32)));
                            else
                                sum += c.value * c.weight;
                        splats[0].addToPixel(x, y, sum);
                    }
                splats[0].sortByBand();
                addSplats(splats, filter, 1, film, nullptr);
                if (tileY + tileX == 16 + 32) film.finishSample(0, 32);
            }
    film.addSamples(6);
    CHECK(film.channels().front().pixels == whole);
}

TEST_CASE("Render: it goes on where another has ended, to the same bits") {
    for (const char* sampler : {"independent", "sobol"}) {
        CAPTURE(std::string(sampler));
        const LoadedScene loaded = sceneFromText(
            mixedScene, {"estimator.kind=bdpt", std::string("estimator.sampler=") + sampler});
        Film whole({48, 32, 0, 0, 48, 32}), parts({48, 32, 0, 0, 48, 32});
        const Filter filter(loaded.film.filter, loaded.film.filterRadius);
        const auto estimator = makeEstimator(loaded.estimator);
        const auto take = [&](Film& film, std::uint32_t first, std::uint32_t count) {
            RenderSettings settings;
            settings.firstSample = first;
            settings.samples = count;
            settings.sampler = loaded.sampler;
            render(*loaded.scene, *loaded.camera, *estimator, filter, film, settings, {});
        };
        take(whole, 0, 6);
        take(parts, 0, 1);
        take(parts, 1, 3);
        take(parts, 4, 2);
        CHECK(parts.channels().front().pixels == whole.channels().front().pixels);
    }
}

TEST_CASE("Render: stopped within a sample it goes on from what there is, to the same bits") {
    for (const char* kind : {"pt", "lt", "bdpt"})
        for (const Parted& either : eitherScene(kind)) {
            const LoadedScene& loaded = either.loaded;
            const bool isParted = either.isParted;
            // A frame so small that only the lists of splats divide it.
            if (std::string(kind) == "pt" && !isParted) continue;
            CAPTURE(std::string(kind));
            CAPTURE(isParted);
            const Filter filter(loaded.film.filter, loaded.film.filterRadius);
            const auto take = [&](Film& film, std::uint32_t first, std::uint32_t count, int threads,
                                  bool stops = false) {
                RenderSettings settings;
                settings.firstSample = first;
                settings.samples = count;
                settings.threads = threads;
                render(*loaded.scene, *loaded.camera, *makeEstimator(loaded.estimator), filter,
                       film, settings, [&](const RenderProgress&) { return !stops; });
            };
            const Film empty(loaded.film.fullFrame(), {}, loaded.film.color);
            Film whole = empty, stopped = empty, resumed = empty;
            take(whole, 0, 3, 2);
            take(stopped, 0, 1, 1);
            take(stopped, 1, 2, 1, true);
            REQUIRE(stopped.samples() == 1);
            REQUIRE(stopped.state().unfinishedParts > 0);
            REQUIRE(stopped.isSplattedOn());
            resumed.restore(stopped.state());
            take(resumed, 1, 2, 2);
            CHECK(resumed.samples() == 3);
            CHECK(resumed.channels().front().pixels == whole.channels().front().pixels);
        }
}

TEST_CASE("Render: a crop is the window of the full frame, bit for bit") {
    const auto check = [](const std::string& kind, const std::vector<std::string>& overrides) {
        for (const Parted& either : eitherScene(kind, overrides)) {
            const LoadedScene& loaded = either.loaded;
            const bool isParted = either.isParted;
            CAPTURE(kind);
            CAPTURE(overrides.front());
            CAPTURE(isParted);
            const std::vector<float> full = renderPixels(loaded, 4, 5);
            Film film({48, 32, 10, 7, 20, 15}, {}, loaded.film.color);
            RenderSettings settings;
            settings.samples = 4;
            settings.seed = 5;
            render(*loaded.scene, *loaded.camera, *makeEstimator(loaded.estimator),
                   Filter(loaded.film.filter, loaded.film.filterRadius), film, settings, {});
            const std::vector<float> crop = film.channels().front().pixels;
            for (std::size_t y = 0; y < 15; ++y)
                for (std::size_t i = 0; i < 20 * 3; ++i)
                    REQUIRE(crop[y * 20 * 3 + i] == full[((y + 7) * 48 + 10) * 3 + i]);
        }
    };
    for (const char* kind : {"pt", "lt", "bdpt"})
        for (const char* filter : {"film.filter=gaussian", "film.filter=box"})
            check(kind, {filter});
    // A wide box, and several light paths a sample.
    check("bdpt", {"film.filter=box", "film.filter_radius=1", "estimator.light_paths=3"});
}

TEST_CASE("Render: the weighted pictures of all techniques sum to the picture") {
    for (const Parted& either :
         eitherScene("bdpt", {"estimator.max_depth=4", "film.filter=gaussian"})) {
        const LoadedScene& loaded = either.loaded;
        const bool isParted = either.isParted;
        CAPTURE(isParted);
        const FrameWindow window = loaded.film.fullFrame();
        Film film(window, {}, loaded.film.color);
        TechniqueImages techniques(window, loaded.film.color);
        RenderSettings settings;
        settings.samples = 8;
        settings.techniqueImages = &techniques;
        render(*loaded.scene, *loaded.camera, *makeEstimator(loaded.estimator),
               Filter(loaded.film.filter, loaded.film.filterRadius), film, settings, {});
        const std::vector<float> picture = film.channels().front().pixels;
        std::vector<double> sum(picture.size(), 0.0);
        int weighted = 0;
        for (const ExrChannels& image : techniques.channels(film.samples())) {
            if (image.names.front().find("unweighted") != std::string::npos) continue;
            ++weighted;
            for (std::size_t i = 0; i < sum.size(); ++i)
                sum[i] += static_cast<double>(image.pixels[i]);
        }
        CHECK(weighted == 2 + 3 + 4 + 5);  // all with 1 … 4 edges
        double largest = 0.0;
        for (const float value : picture) largest = std::max(largest, std::abs(double{value}));
        for (std::size_t i = 0; i < sum.size(); ++i)
            CHECK(std::abs(sum[i] - static_cast<double>(picture[i])) <= 1e-6 * largest);
    }
}

TEST_CASE("Render: where no technique brings light there is a black picture of one") {
    const TechniqueImages techniques({2, 1, 0, 0, 2, 1});
    const std::vector<ExrChannels> channels = techniques.channels(4);
    REQUIRE(channels.size() == 2);
    CHECK(channels[0].names == std::vector<std::string>{"s0t2.R", "s0t2.G", "s0t2.B"});
    CHECK(channels[0].pixels == std::vector<float>(6));
}

TEST_CASE(
    "Render: what is not finite is counted in the film's state too, and the first are named") {
    const std::string scene = std::string(ballScene) +
                              "[[light]]\ntype = \"point\"\nposition = [0, 0.2, 1.2]\nintensity = "
                              "[1e30, 1e30, 1e30]\n";
    for (const char* estimator : {"pt", "lt", "bdpt"}) {
        CAPTURE(estimator);
        const LoadedScene loaded = sceneFromText(
            scene, {"camera.exposure=60", std::string("estimator.kind=") + estimator});
        const auto badSamples = [&](int threads) {
            Film film({30, 20, 0, 0, 30, 20});
            RenderSettings settings;
            settings.samples = 16;
            settings.threads = threads;
            const RenderResult result =
                render(*loaded.scene, *loaded.camera, *makeEstimator(loaded.estimator),
                       Filter(FilterKind::box), film, settings, {});
            CHECK(film.state().badSamples == result.badSampleCount);
            CHECK(result.badSampleCount > 1024);
            std::vector<std::tuple<std::uint32_t, int, int>> places;
            for (const BadSample& b : result.badSamples) places.emplace_back(b.sample, b.y, b.x);
            return places;
        };
        const auto places = badSamples(1);
        CHECK(places.size() == 16);
        CHECK(std::is_sorted(places.begin(), places.end()));
        CHECK(std::get<0>(places.back()) == 0);
        CHECK(places == badSamples(8));
    }
}

TEST_CASE("Render: a filter changes no constant picture, at the border neither") {
    for (const char* filter : {"box", "gaussian", "blackman-harris"}) {
        const LoadedScene loaded = sceneFromText(
            "[film]\nwidth = 8\nheight = 8\n[camera]\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nfov = "
            "0.02\n"
            "[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n",
            {std::string("film.filter=") + filter});
        // cos⁴ over half a field of 0.01° differs from 1 by 2 tan² = 6e-8; the rest is float
        // rounding.
        for (const float v : renderPixels(loaded, 4, 1))
            CHECK(v == doctest::Approx(1.0).epsilon(1e-6));
    }
}

TEST_CASE("Render: where a sample is unfinished, pixels that have had it are whole") {
    // Camera paths alone: what a light path splats may come from anywhere.
    for (const std::vector<std::string>& estimator :
         {std::vector<std::string>{"estimator.kind=pt"},
          {"estimator.kind=bdpt", "estimator.techniques=s0,s1t2,s1t3"}}) {
        CAPTURE(estimator.front());
        const LoadedScene loaded = partedScene(estimator);
        const Filter filter(FilterKind::box);
        const auto take = [&](bool goesOn) {
            Film film(loaded.film.fullFrame(), {}, loaded.film.color);
            RenderSettings settings;
            settings.samples = 1;
            render(*loaded.scene, *loaded.camera, *makeEstimator(loaded.estimator), filter, film,
                   settings, [&](const RenderProgress&) { return goesOn; });
            return film;
        };
        const Film part = take(false), whole = take(true);
        REQUIRE(part.samples() == 0);
        const std::vector<std::uint16_t>& counts = part.state().extraSamples;
        const std::vector<float> partly = part.channels().front().pixels,
                                 wholly = whole.channels().front().pixels;
        std::size_t compared = 0;
        for (std::size_t y = 2; y + 2 < 32; ++y)
            for (std::size_t x = 2; x + 2 < 48; ++x) {
                // Wavelengths part by less than a pixel here.
                bool isInside = true;
                for (std::size_t v = y - 2; v <= y + 2; ++v)
                    for (std::size_t u = x - 2; u <= x + 2; ++u)
                        isInside = isInside && counts[v * 48 + u] == 1;
                if (!isInside) continue;
                ++compared;
                for (std::size_t i = 0; i < 3; ++i)
                    REQUIRE(partly[(y * 48 + x) * 3 + i] == wholly[(y * 48 + x) * 3 + i]);
            }
        CHECK(compared > 100);
    }
}

TEST_CASE("Render: the variance of the luminance is that of pictures, through a lens that parts") {
    const LoadedScene loaded = partedScene({"film.width=12", "film.height=8"});
    const Filter filter(FilterKind::box);
    constexpr std::size_t pictures = 48;
    std::vector<std::vector<double>> luminances(96);
    double stated = 0.0, measured = 0.0;
    for (std::uint64_t seed = 1; seed <= pictures; ++seed) {
        Film film(loaded.film.fullFrame(), {.luminanceVariance = true}, loaded.film.color);
        RenderSettings settings;
        settings.samples = 32;
        settings.seed = seed;
        render(*loaded.scene, *loaded.camera, *makeEstimator(loaded.estimator), filter, film,
               settings, {});
        for (std::size_t pixel = 0; pixel < luminances.size(); ++pixel) {
            luminances[pixel].push_back(film.luminance(pixel));
            stated += film.luminanceVariance(pixel) / pictures;
        }
    }
    for (const std::vector<double>& values : luminances) measured += summarize(values).variance;
    // Over 47 degrees of freedom of 96 pixels; those of one splat are not independent.
    CHECK(stated == doctest::Approx(measured).epsilon(0.15));
}

TEST_CASE("Render: it stops between passes when asked, and says so") {
    const LoadedScene loaded = sceneFromText(mixedScene);
    Film film({48, 32, 0, 0, 48, 32});
    RenderSettings settings;
    settings.samples = 1000;
    const RenderResult result = render(*loaded.scene, *loaded.camera,
                                       *makeEstimator(loaded.estimator), Filter(FilterKind::box),
                                       film, settings, [](const RenderProgress&) { return false; });
    CHECK(result.wasInterrupted);
    CHECK(result.samples == film.samples());
    CHECK(result.samples < 1000);
}

namespace {

/// `mixedScene` around a camera, all lengths times `scale`. Radiances do not change with scale, a
/// point light's intensity goes with its square.
std::string scaledScene(double scale) {
    const auto number = [&](double v) {
        char text[40];
        std::snprintf(text, sizeof text, "%.9e", v * scale);
        return std::string(text);
    };
    const auto vector = [&](double x, double y, double z) {
        return "[" + number(x) + ", " + number(y) + ", " + number(z) + "]";
    };
    const std::string s = number(1.0);
    char intensity[40];
    std::snprintf(intensity, sizeof intensity, "%.9e", 3.0 * scale * scale);
    const std::string i = intensity;
    return "[film]\nwidth = 24\nheight = 16\n[camera]\nfov = 40\nfrom = " + vector(0, 1.2, 4) +
           "\nto = " + vector(0, 0.6, 0) +
           R"(
[[material]]
name = "floor"
type = "plastic"
color = [0.5, 0.4, 0.3]
roughness = 0.4
[[material]]
name = "glass"
type = "dielectric"
roughness = 0.2
[[material]]
name = "lamp"
color = [0, 0, 0]
emission = [8, 7, 5]
[[mesh]]
shape = "rectangle"
material = "floor"
transform = [{scale = 5}, {rotate = [1, 0, 0, -90]}, {scale = )" +
           s + R"(}]
[[mesh]]
name = "ball"
shape = "sphere"
hidden = true
[[instance]]
mesh = "ball"
material = "glass"
transform = [{scale = 0.5}, {translate = [-0.6, 0.5, 0]}, {scale = )" +
           s + R"(}]
[[instance]]
mesh = "ball"
transform = [{scale = 0.5}, {translate = [0.6, 0.5, 0]}, {scale = )" +
           s + R"(}]
[[mesh]]
shape = "disc"
material = "lamp"
transform = [{scale = 0.5}, {rotate = [1, 0, 0, 90]}, {translate = [0, 3, 0]}, {scale = )" +
           s + R"(}]
[[light]]
type = "point"
position = )" +
           vector(2, 2, 2) + "\nintensity = [" + i + ", " + i + ", " + i + "]\n";
}

std::vector<std::vector<float>> renderSeeds(const std::string& text, std::uint32_t samples,
                                            std::uint64_t firstSeed, int seeds) {
    const LoadedScene loaded = sceneFromText(text);
    std::vector<std::vector<float>> pictures;
    for (int i = 0; i < seeds; ++i)
        pictures.push_back(
            renderPixels(loaded, samples, firstSeed + static_cast<std::uint64_t>(i)));
    return pictures;
}

double meanPixel(const std::vector<float>& pixels) {
    return std::accumulate(pixels.begin(), pixels.end(), 0.0) / static_cast<double>(pixels.size());
}

}  // namespace

TEST_CASE("Render: a scene of 1e-4 or 1e6 times the size gives the same picture" *
          doctest::test_suite("statistical")) {
    const auto reference = renderSeeds(scaledScene(1.0), 128, 100, 24);
    for (const double scale : {1e-4, 1e6}) {
        CAPTURE(scale);
        const PictureComparison independent =
            comparePictures(renderSeeds(scaledScene(scale), 128, 200, 24), reference, 24, 4);
        CAPTURE(independent.smallestP);
        CHECK(independent.agree());
        // With the same seeds the paths are the same but for rounding, so that the noise cancels.
        const auto paired = renderSeeds(scaledScene(scale), 128, 100, 24);
        std::vector<double> differences;
        for (std::size_t i = 0; i < paired.size(); ++i)
            differences.push_back(meanPixel(paired[i]) / meanPixel(reference[i]) - 1.0);
        const Summary bias = summarize(differences);
        CAPTURE(bias.mean);
        CAPTURE(bias.standardError);
        CHECK(std::abs(bias.mean) + studentQuantile(0.99, 23) * bias.standardError < 0.005);
    }
}

TEST_CASE("Render: pictures of different lights are told apart" *
          doctest::test_suite("statistical")) {
    // The comparison itself must be able to fail: 2 % more light in one of the pictures.
    // The scene is simple, so that its noise is below that.
    const std::string plain =
        "[film]\nwidth = 24\nheight = 16\n[camera]\nfov = 40\nfrom = [0, 1, 4]\nto = [0, 0, 0]\n"
        "[[mesh]]\nshape = \"sphere\"\n[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";
    const auto a = renderSeeds(plain, 64, 300, 24);
    auto b = renderSeeds(plain, 64, 400, 24);
    CHECK(comparePictures(a, b, 24, 4).agree());
    CHECK(comparePictures(a, b, 24, 4).isEquivalent(0.005));
    for (auto& picture : b)
        for (float& v : picture) v *= 1.02f;
    CHECK_FALSE(comparePictures(a, b, 24, 4).agree());
    CHECK_FALSE(comparePictures(a, b, 24, 4).isEquivalent(0.005));
}
