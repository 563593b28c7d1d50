#include "renderer/lens_terms.h"

#include <array>
#include <cstdio>

namespace etendue {

namespace {

/// Each half as many again or more than the one before: between them there is little to gain.
constexpr std::array<int, 5> candidates{8, 16, 24, 40, 64};

/// G: above all that was measured; docs/speed-accuracy.md.
constexpr double gradientPerWidth = 32.0;
/// relMSE of one sample per pixel in the quietest of them.
constexpr double quietestRelMse = 0.1;

std::string shortNumber(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", value);
    return text;
}

}  // namespace

double expectedRelMse(const FitErrors& errors, double sensorWidthMm) {
    const double shift = gradientPerWidth * 1e-3 * errors.sensorMicrometres.rms / sensorWidthMm;
    const double brightness = 0.5 * errors.throughputRelative.rms;
    return shift * shift + brightness * brightness;
}

double littleNoise(int samples) { return quietestRelMse / samples; }

ChosenFit chooseTerms(const std::function<LensFit(int terms)>& fitOf, double sensorWidthMm,
                      int samples) {
    const double limit = 0.1 * littleNoise(samples);
    ChosenFit chosen;
    for (const int terms : candidates) {
        chosen.fit = fitOf(terms);
        const double error = expectedRelMse(chosen.fit.errors, sensorWidthMm);
        const bool isEnough = error < limit;
        chosen.reason = "representation = \"auto\": " + std::to_string(terms) +
                        " terms; they are off by a relMSE of about " + shortNumber(error) + ", " +
                        (isEnough ? "below" : "more than") + " a tenth of the noise of " +
                        std::to_string(samples) + " samples per pixel in a quiet scene, " +
                        shortNumber(littleNoise(samples)) +
                        (isEnough ? "" : "; \"traced\" is not off");
        if (isEnough) break;
    }
    return chosen;
}

}  // namespace etendue
