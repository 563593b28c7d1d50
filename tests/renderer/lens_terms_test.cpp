// representation = "auto": as many terms as the samples are worth.
#include "renderer/lens_terms.h"

#include <doctest/doctest.h>

#include "tests/support/scenes.h"

using namespace etendue;

namespace {

/// A fit that is off by 1 mm over the square of its terms.
LensFit fitWith(int terms) {
    LensFit fit;
    fit.settings.terms = terms;
    fit.errors.sensorMicrometres.rms = 1000.0 / (terms * terms);
    return fit;
}

int termsFor(int samples, double sensorWidthMm) {
    return chooseTerms(fitWith, sensorWidthMm, samples).fit.settings.terms;
}

std::string lensScene(const std::string& more) {
    const auto scenes = std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses";
    return "[film]\nwidth = 48\nheight = 32\n[camera]\nfrom = [0, 1, 4]\nto = [0, 1, 0]\n"
           "dispersion = false\nlens = \"" +
           (scenes / "double-gauss-100mm.toml").string() +
           "\"\nf_number = 8\nfocus_distance = 4\n" + more +
           "[[light]]\ntype = \"constant\"\nradiance = [1, 1, 1]\n";
}

}  // namespace

TEST_CASE("Lens terms: the error expected of a picture falls with the square of its width") {
    LensFit fit = fitWith(10);
    const double narrow = expectedRelMse(fit.errors, 4.0), wide = expectedRelMse(fit.errors, 40.0);
    CHECK(wide > 0.0);
    CHECK(narrow == doctest::Approx(100.0 * wide));
    fit.errors.throughputRelative.rms = 0.01;
    CHECK(expectedRelMse(fit.errors, 40.0) == doctest::Approx(wide + 0.25e-4));
}

TEST_CASE("Lens terms: more samples and smaller sensors are worth more terms") {
    int last = 0;
    for (int samples = 1; samples <= 1 << 24; samples *= 16) {
        const int terms = termsFor(samples, 36.0);
        CHECK(terms >= last);
        last = terms;
    }
    CHECK(termsFor(1, 36.0) < 64);
    CHECK(last == 64);
    CHECK(termsFor(16, 6.0) > termsFor(16, 36.0));
}

TEST_CASE(
    "Lens terms: the fewest whose error is below a tenth of the noise, or the most there are") {
    for (const int samples : {1, 16, 256}) {
        CAPTURE(samples);
        const ChosenFit chosen = chooseTerms(fitWith, 36.0, samples);
        CHECK(expectedRelMse(chosen.fit.errors, 36.0) < 0.1 * littleNoise(samples));
        CHECK(chosen.reason.find("below a tenth of the noise of " + std::to_string(samples) +
                                 " samples") != std::string::npos);
        const int terms = chosen.fit.settings.terms;
        if (terms > 8)
            CHECK(expectedRelMse(fitWith(terms * 2 / 3).errors, 36.0) >=
                  0.1 * littleNoise(samples));
    }
    const ChosenFit most = chooseTerms(fitWith, 1.0, 1 << 20);
    CHECK(most.fit.settings.terms == 64);
    CHECK(most.reason.find("more than a tenth of the noise") != std::string::npos);
    CHECK(most.reason.find("traced") != std::string::npos);
}

TEST_CASE("Scene: representation = \"auto\" chooses terms by the samples, and says so") {
    const TemporaryFolder folder;
    LoadOptions options;
    options.fitCache = folder.path() / "fits";
    const auto load = [&](const std::string& more, std::optional<int> samples = {}) {
        options.samples = samples;
        return loadScene(folder.write("scene.toml", lensScene(more)), options);
    };
    const LoadedScene few = load("representation = \"auto\"\ndegree = 5\n", 1);
    REQUIRE(few.fit.has_value());
    CHECK(few.fit->terms == 8);
    CHECK(few.samples == 1);
    CHECK(few.notes.back().find("representation = \"auto\": 8 terms") != std::string::npos);
    std::string message;
    try {
        load("representation = \"auto\"\nterms = 8\n");
    } catch (const InputError& error) {
        message = error.what();
    }
    CHECK(message.find("camera.terms: representation = \"auto\" chooses them") !=
          std::string::npos);
}
