// The judge of estimators is judged: it finds what is wrong, passes what is right, and says when it
// cannot tell.
#include "tools/agreement.h"

#include <doctest/doctest.h>

#include "statistics/statistics.h"
#include "tests/support/scenes.h"
#include "tests/tools/command_outcome.h"
#include "tests/tools/every_material_scene.h"
#include "tools/agreement_report.h"
#include "tools/progress.h"

using namespace etendue;

namespace {

AgreementSettings fixedSamples(int samples) {
    AgreementSettings settings;
    settings.samples = samples;
    settings.threads = 2;
    settings.tileSize = 8;
    return settings;
}

/// Path tracing, all of it times `factor`.
class Tinted final : public CommonPaths {
public:
    Tinted(const EstimatorSettings& settings, Spectrum factor)
        : estimator_(makePathTracer(settings)), factor_(factor) {}
    void takeSample(const View& view, SampleId id, SampleRequest request,
                    Sample& result) const override {
        estimator_->takeSample(view, id, request, result);
        for (Contribution& c : result.contributions) c.value *= factor_;
    }
    LeftOutMeans leftOut(std::uint32_t, std::size_t, FilmColor) const override { return {}; }

private:
    std::unique_ptr<Estimator> estimator_;
    Spectrum factor_;
};

Contestant tinted(const LoadedScene& loaded, Spectrum factor) {
    return {"pt", [settings = loaded.estimator, factor] {
                return std::make_unique<Tinted>(settings, factor);
            }};
}

double shareOf(const AgreementSide& side, PathClass pathClass) {
    return side.leftOut[static_cast<std::size_t>(pathClass)];
}

Judgement judgementWith(double smallestP, double bias, double halfWidth,
                        std::size_t testsInDoubt = 0) {
    return {{.smallestP = smallestP,
             .level = 0.001,
             .relativeBias = bias,
             .relativeBiasHalfWidth = halfWidth},
            testsInDoubt};
}

std::optional<Agreement> compareKinds(const LoadedScene& loaded, const std::string& tested,
                                      const std::string& reference,
                                      const AgreementSettings& settings,
                                      const std::function<bool(double)>& goOn = {}) {
    return compareEstimators(loaded, parseContender(tested).value(),
                             parseContender(reference).value(), settings, goOn);
}

}  // namespace

TEST_CASE("Agreement: the verdict is by tests first, then by the interval against the bound") {
    const double bound = 0.002;
    CHECK(verdictOf(judgementWith(0.5, 0.001, 0.0009), bound, false, false) == Verdict::agree);
    CHECK(verdictOf(judgementWith(0.5, -0.001, 0.0011), bound, false, false) == Verdict::tooNoisy);
    CHECK(verdictOf(judgementWith(0.5, 0.001, 0.0009, 1), bound, false, false) ==
          Verdict::tooNoisy);
    CHECK(verdictOf(judgementWith(0.0005, 0.0001, 0.0001), bound, false, false) == Verdict::differ);
    CHECK(verdictOf(judgementWith(0.5, 0.001, 0.0009), bound, false, true) == Verdict::differ);
    CHECK(verdictOf(judgementWith(1.0, NAN, 0.0), bound, true, false) == Verdict::nothingCommon);
}

TEST_CASE("Agreement: samples are planned for the interval, or for the time if that is less") {
    const PictureCost noisy{4, 9.0, 0.01}, costly{2, 1.0, 0.04};
    // Enough time: t of 15 degrees of freedom at 99 % is 2.947.
    const double halfWidth = 0.01;
    const SamplePlan plan = planSamples(noisy, costly, 16, halfWidth, 1e9);
    const double variance = 9.0 / plan.tested + 1.0 / plan.reference;
    CHECK(2.947 * std::sqrt(variance / 16) / halfWidth == doctest::Approx(1).epsilon(0.01));
    // The least cost: no other share of it does as well.
    const double cost = 0.01 * plan.tested + 0.04 * plan.reference;
    for (const double factor : {0.7, 1.3}) {
        const double tested = factor * plan.tested;
        const double reference = (cost - 0.01 * tested) / 0.04;
        CHECK(9.0 / tested + 1.0 / reference > variance);
    }
    const SamplePlan hurried = planSamples(noisy, costly, 16, halfWidth, 10.0);
    CHECK(0.01 * hurried.tested + 0.04 * hurried.reference == doctest::Approx(10.0).epsilon(0.02));
    CHECK(hurried.tested / static_cast<double>(hurried.reference) ==
          doctest::Approx(plan.tested / static_cast<double>(plan.reference)).epsilon(0.02));
    // Never fewer than have been affordable before, even when the time is over or nothing varies.
    CHECK(planSamples(noisy, costly, 16, halfWidth, -1.0).tested == 4);
    CHECK(planSamples({8, 0.0, 0.01}, {16, 0.0, 0.01}, 16, halfWidth, 10.0).reference == 16);
}

TEST_CASE("Agreement: estimators agree on what they share, and what they do not is measured" *
          doctest::test_suite("statistical")) {
    // Mirrors, glass, a smooth coat, a visible point and a sun.
    for (const std::string& color : {std::string("film.color=auto"), dispersiveGlass}) {
        CAPTURE(color);
        const LoadedScene loaded = sceneFromText(everyMaterialScene, {color});
        AgreementSettings settings = fixedSamples(96);
        settings.comparisons = 6;
        for (const auto& pair : {std::pair{"lt", "pt"}, {"bdpt", "pt"}, {"lt", "bdpt"}}) {
            const std::string tested = pair.first, reference = pair.second;
            CAPTURE(tested);
            CAPTURE(reference);
            const auto agreement = compareKinds(loaded, tested, reference, settings, {});
            REQUIRE(agreement);
            CAPTURE(agreement->comparison.smallestP);
            CAPTURE(agreement->comparison.relativeBias);
            CAPTURE(agreement->comparison.relativeBiasHalfWidth);
            CHECK(agreement->verdict != Verdict::differ);
            CHECK(agreement->comparison.isEquivalent(0.06));
            const bool isLight = tested == "lt";
            const bool hasPath = reference == "pt";
            CHECK((shareOf(agreement->reference, PathClass::mirrorFirst) > 0.01) == isLight);
            CHECK((shareOf(agreement->tested, PathClass::mirroredPoint) > 0.001) == hasPath);
            CHECK(agreement->tested.bad.count == 0);
        }
    }
}

TEST_CASE("Agreement: without leaving anything out the same estimators differ") {
    const LoadedScene loaded = sceneFromText(everyMaterialScene);
    const auto whole = [&](const std::string& kind) {
        const Contender self = parseContender(kind).value();
        return Contestant{kind, [&, self] {
                              return makeCommonPaths(*loaded.scene, *loaded.camera,
                                                     {loaded.estimator, self, self});
                          }};
    };
    const auto agreement =
        comparePicturesOf(loaded, whole("lt"), whole("pt"), fixedSamples(96), {});
    REQUIRE(agreement);
    CHECK(agreement->verdict == Verdict::differ);
}

TEST_CASE("Agreement: a picture 1 % too bright, or with a trace too much of red, is found") {
    const LoadedScene loaded = sceneFromText(everyMaterialFrame + R"(
[[mesh]]
shape = "sphere"
[[light]]
type = "constant"
radiance = [1, 1, 1]
)");
    AgreementSettings settings = fixedSamples(64);
    settings.bound = 0.005;
    const auto judge = [&](Spectrum factor) {
        return comparePicturesOf(loaded, tinted(loaded, factor), tinted(loaded, Spectrum(1.0f)),
                                 settings, {});
    };
    CHECK(judge(Spectrum(1.0f))->verdict == Verdict::agree);
    const auto bright = judge(Spectrum(1.01f));
    CHECK(bright->verdict == Verdict::differ);
    CHECK(std::abs(bright->comparison.relativeBias - 0.01) < 0.003);
    CHECK(judge(rgb(1.01f, 1.0f, 0.99f))->verdict == Verdict::differ);
    // Of 16 × 12 pixels there are four tiles in three colours, and the whole.
    settings.comparisons = 5;
    CHECK(judge(Spectrum(1.0f))->comparison.level == sidakLevel(0.01, 5 * (4 * 3 + 1)));
}

TEST_CASE("Agreement: samples that are not finite are a difference, with the first of them named") {
    const LoadedScene loaded = sceneFromText(everyMaterialScene);
    const float infinity = std::numeric_limits<float>::infinity();
    const auto agreement = comparePicturesOf(loaded, tinted(loaded, Spectrum(infinity)),
                                             tinted(loaded, Spectrum(1.0f)), fixedSamples(1), {});
    REQUIRE(agreement);
    CHECK(agreement->verdict == Verdict::differ);
    CHECK(agreement->tested.bad.count > 100);
    CHECK(agreement->reference.bad.count == 0);
    const AgreementRow row{"s", "c", "pt", "pt", agreement};
    CHECK(contains(agreementText({row}, fixedSamples(1)), "were not finite or negative"));
    CHECK(contains(agreementText({row}, fixedSamples(1)), "--seed "));
}

TEST_CASE(
    "Agreement: samples are added until the bound is met, and no longer than the time allows") {
    const LoadedScene loaded = sceneFromText(everyMaterialFrame + everyMaterialRoom + lampAndSky);
    AgreementSettings settings;
    settings.threads = 2;
    settings.seconds = 600.0;
    settings.bound = 0.05;
    // The pilots may take long, as they may of ten minutes; they end as soon as they are known.
    settings.seconds = 8.0;
    const auto enough = compareKinds(loaded, "bdpt", "pt", settings, {});
    REQUIRE(enough);
    CHECK(enough->verdict == Verdict::agree);
    // 0.45 of the bound was asked for, by a spread known to a fifth.
    CHECK(enough->comparison.relativeBiasHalfWidth < 0.05);
    settings.bound = 1e-5;
    settings.seconds = 0.5;
    const auto hurried = compareKinds(loaded, "bdpt", "pt", settings, {});
    REQUIRE(hurried);
    CHECK(hurried->verdict == Verdict::tooNoisy);
    CHECK(hurried->tested.samples >= 1);
}

TEST_CASE("Agreement: gives up when asked to") {
    const LoadedScene loaded = sceneFromText(everyMaterialScene);
    CHECK_FALSE(
        compareKinds(loaded, "lt", "pt", fixedSamples(1000000), [](double) { return false; }));
    double told = 0.0;
    CHECK(compareKinds(loaded, "lt", "pt", fixedSamples(2), [&](double seconds) {
        told = seconds;
        return true;
    }));
    CHECK(told > 0.0);
}

TEST_CASE("Agreement: two black pictures have nothing in common") {
    const LoadedScene loaded = sceneFromText(everyMaterialFrame + silverMirror + R"(
[[mesh]]
shape = "rectangle"
material = "mirror"
transform = [{scale = 40}, {translate = [0, 0, -1]}]
[[light]]
type = "point"
position = [0, 1, 6]
intensity = [3, 4, 5]
)");
    // The point behind the camera is seen in the mirror alone.
    const auto agreement = compareKinds(loaded, "lt", "pt", fixedSamples(2), {});
    REQUIRE(agreement);
    CHECK(agreement->verdict == Verdict::nothingCommon);
}

TEST_CASE("Agreement: the exit code is that of the worst row") {
    Agreement fine;
    fine.verdict = Verdict::agree;
    Agreement wrong;
    wrong.verdict = Verdict::differ;
    const AgreementRow agrees{"s", "c", "lt", "pt", fine}, differs{"s", "c", "lt", "pt", wrong},
        broken{"s", "c", "lt", "pt", {}, "s.toml: bad"}, missing{"s", "c", "lt", "pt"};
    CHECK(exitCodeOf({agrees, agrees}) == ExitCode::success);
    CHECK(exitCodeOf({agrees, missing}) == ExitCode::stoppedEarly);
    CHECK(exitCodeOf({agrees, agrees}, 2) == ExitCode::success);
    CHECK(exitCodeOf({agrees, agrees}, 3) == ExitCode::failure);
    CHECK(exitCodeOf({missing, broken}) == ExitCode::badInput);
    CHECK(exitCodeOf({broken, differs, missing}) == ExitCode::failure);
    const std::string text = agreementText({agrees, differs, broken, missing}, {});
    for (const char* word :
         {"agree", "DIFFER", "not done", "not reached", "s, c, lt against pt: s.toml: bad"})
        CHECK(contains(text, word));
}

TEST_CASE("Agreement: what is too noisy to tell says how long it would take") {
    Agreement noisy;
    noisy.verdict = Verdict::tooNoisy;
    noisy.seconds = 8.0;
    noisy.comparison.relativeBiasHalfWidth = 0.01;
    // Eleven times as wide as it may be, which takes 123 times as long.
    const double expected = 8.0 / (0.09 * 0.09);
    CHECK(secondsToTell(noisy, 0.002) == doctest::Approx(expected));
    AgreementSettings settings;
    settings.bound = 0.002;
    const auto textOf = [&] { return agreementText({{"s", "c", "lt", "pt", noisy}}, settings); };
    CHECK(contains(textOf(), formatDuration(expected)));
    noisy.verdict = Verdict::agree;
    CHECK_FALSE(contains(textOf(), formatDuration(expected)));
}
