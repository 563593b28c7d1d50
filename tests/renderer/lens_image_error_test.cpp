// A fitted lens' picture differs from the traced lens' by what the fit's errors predict, and by no
// more than the fit states. Equations in parentheses are those of docs/lens-image-error.md.
#include "tests/support/lens_image_error.h"

#include <doctest/doctest.h>

#include <cmath>

#include "statistics/picture_comparison.h"
#include "statistics/statistics.h"

namespace etendue {
namespace {

std::filesystem::path lensFile(const std::string& name) {
    return std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses" / name;
}

/// Stops and sensors of which the fits decide every ray as the traced lens does: clipping has a
/// test of its own (tests/lens/lens_fit_test.cpp).
const ChartView doubleGauss{lensFile("double-gauss-100mm.toml"), 36.0, 48, 32};
const ChartView fisheye{lensFile("fisheye-10mm.toml"), 18.0, 48, 32, 5.6};
const ChartView anamorphic{lensFile("anamorphic-80x90mm.toml"), 6.0, 48, 32, 8.0};

std::vector<Picture> picturesOf(const std::vector<PixelMap>& maps) {
    std::vector<Picture> pictures;
    for (const PixelMap& map : maps) {
        Picture& picture = pictures.emplace_back();
        for (const double v : map) picture.insert(picture.end(), 3, static_cast<float>(v));
    }
    return pictures;
}

constexpr std::size_t replicates = 12;
constexpr int seeds = 12;

struct Compared {
    StatedBound bound;
    ChartFacts facts;
    std::vector<PixelMap> measured, exact;
    WelchResult welch;  // of the pattern's factors, measured less predicted
    double predictedFactor = 0.0;
    double remainder = 0.0;  // of the first order, as a factor
};

/// The pattern is the first order's, of half of the replicates; it is looked for in the other half
/// and in the pictures, so that no noise is common to both sides.
Compared compare(const LensPair& pair) {
    const PredictionSet set = predict(pair, replicates, 16, 1);
    const auto scene = chartScene(pair.chart);
    Compared result;
    result.facts = set.facts;
    result.bound = statedBound(pair, set.facts);
    // The same numbers in both, so that both ask for the same rays.
    result.measured = differences(renderChart(*scene, *pair.fittedCamera, "pt", 16, 1, seeds),
                                  renderChart(*scene, *pair.tracedCamera, "pt", 16, 1, seeds));
    result.exact = set.maps(&Prediction::exact, 0, replicates);
    const PixelMap pattern = meanOf(set.maps(&Prediction::firstOrder, 0, replicates / 2));
    const auto predicted =
        factorsOf(pattern, set.maps(&Prediction::firstOrder, replicates / 2, replicates));
    result.welch = welchTest(factorsOf(pattern, result.measured), predicted);
    result.predictedFactor = summarize(predicted).mean;
    // By Cauchy and Schwarz.
    result.remainder = rms(meanOf(set.maps(&Prediction::remainder, 0, replicates))) / rms(pattern);
    return result;
}

}  // namespace

TEST_SUITE_BEGIN("statistical");

TEST_CASE(
    "Lens image error: pictures differ as the rays of both lenses predict, within what the fit "
    "states") {
    struct Case {
        ChartView view;
        int terms;
    };
    ChartView unfocused = doubleGauss;
    unfocused.focusDistanceMm = 4000.0;
    const std::vector<Case> cases{{doubleGauss, 8}, {doubleGauss, 16}, {unfocused, 8},
                                  {fisheye, 8},     {fisheye, 32},     {anamorphic, 16},
                                  {anamorphic, 32}};
    for (const Case& one : cases) {
        CAPTURE(one.view.lensFile);
        CAPTURE(one.view.focusDistanceMm);
        CAPTURE(one.terms);
        const LensPair pair = makeLensPair(one.view, one.terms);
        const Compared c = compare(pair);
        REQUIRE(c.facts.decidedOtherwise == 0.0);
        const double measuredRms = sharedRms(c.measured), most = largest(meanOf(c.measured));
        CAPTURE(c.bound.rms);
        CAPTURE(c.bound.most);
        CAPTURE(measuredRms);
        CAPTURE(most);
        CHECK(measuredRms > 0.0);
        CHECK(measuredRms <= c.bound.rms);
        CHECK(most <= c.bound.most);

        // What the rays predict to first order is there, as strongly: to 1 % of false alarms in
        // all.
        const double t =
            studentQuantile(1.0 - sidakLevel(0.01, 2 * cases.size()), c.welch.degreesOfFreedom);
        CAPTURE(c.welch.difference);
        CAPTURE(c.welch.standardError);
        CAPTURE(c.predictedFactor);
        CAPTURE(c.remainder);
        CHECK(std::abs(c.welch.difference) <= t * c.welch.standardError + c.remainder);
        // So well known that a shift wrong by a quarter would be found.
        CHECK(t * c.welch.standardError + c.remainder < 0.25 * c.predictedFactor);

        // And each part of the picture is as the whole integrand predicts.
        const PictureComparison tiles = comparePictures(picturesOf(c.measured), picturesOf(c.exact),
                                                        one.view.width, 4, 2 * cases.size());
        CAPTURE(tiles.smallestP);
        CHECK(tiles.agree());
    }
}

TEST_CASE("Lens image error: it falls with the shift that the fits state") {
    // From eight terms on. Below, it need not: what the error is in the mean over the aperture is
    // what a picture shows, and the double Gauss' is smaller with four terms than with eight.
    for (const ChartView& view : {doubleGauss, fisheye, anamorphic}) {
        double stated = std::numeric_limits<double>::infinity(), measured = stated;
        std::vector<PixelMap> traced;
        for (const int terms : {8, 16, 32}) {
            CAPTURE(view.lensFile);
            CAPTURE(terms);
            const LensPair pair = makeLensPair(view, terms);
            const auto scene = chartScene(pair.chart);
            if (traced.empty()) traced = renderChart(*scene, *pair.tracedCamera, "pt", 16, 1, 6);
            const double now = sharedRms(
                differences(renderChart(*scene, *pair.fittedCamera, "pt", 16, 1, 6), traced));
            CHECK(pair.fit.errors.sensorMicrometres.rms < stated);
            CHECK(now < measured);
            stated = pair.fit.errors.sensorMicrometres.rms;
            measured = now;
        }
    }
}

TEST_CASE(
    "Lens image error: independent pictures differ where it is above their noise, as predicted") {
    const auto tracedWith = [](const LensPair& pair) {
        return renderChart(*chartScene(pair.chart), *pair.tracedCamera, "pt", 32, 100, 16);
    };
    const LensPair bad = makeLensPair(fisheye, 4), good = makeLensPair(fisheye, 32);
    const std::vector<PixelMap> traced = tracedWith(bad);
    const PredictionSet set = predict(bad, replicates, 16, 1);
    const PixelMap pattern = meanOf(set.maps(&Prediction::exact, 0, replicates / 2));
    const Summary predicted =
        summarize(factorsOf(pattern, set.maps(&Prediction::exact, replicates / 2, replicates)));
    const std::vector<double> inTraced = factorsOf(pattern, traced);
    struct Kind {
        const char* name;
        std::uint32_t samples;
    };
    const std::vector<Kind> kinds{{"pt", 32}, {"lt", 512}};
    for (const Kind& kind : kinds) {
        CAPTURE(kind.name);
        const auto pictures = [&](const LensPair& pair) {
            return renderChart(*chartScene(pair.chart), *pair.fittedCamera, kind.name, kind.samples,
                               200, 16);
        };
        const std::vector<PixelMap> badly = pictures(bad), well = pictures(good);
        const auto compared = [&](const std::vector<PixelMap>& fitted) {
            return comparePictures(picturesOf(fitted), picturesOf(traced), fisheye.width, 8,
                                   2 * kinds.size());
        };
        CHECK_FALSE(compared(badly).agree());
        CHECK(compared(well).agree());

        const WelchResult welch = welchTest(factorsOf(pattern, badly), inTraced);
        const double t =
            studentQuantile(1.0 - sidakLevel(0.01, kinds.size()), welch.degreesOfFreedom);
        CAPTURE(welch.difference);
        CAPTURE(welch.standardError);
        CAPTURE(predicted.mean);
        CHECK(std::abs(welch.difference - predicted.mean) <=
              t * std::hypot(welch.standardError, predicted.standardError));
        CHECK(t * welch.standardError < 0.25 * predicted.mean);
    }
}

TEST_SUITE_END();

}  // namespace etendue
