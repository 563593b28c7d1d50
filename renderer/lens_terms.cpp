#include "renderer/lens_terms.h"

#include <array>
#include <cstdio>

namespace etendue {

namespace {

/// Each half as many again or more than the one before: between them there is little to gain.
constexpr std::array<int, 5> candidates{8, 16, 24, 40, 64};

/// Of the scenes of scenes/, the most that was measured; docs/speed-accuracy.md.
constexpr double gradientPerPixel = 0.25;
/// relMSE of one sample per pixel in the quietest of them.
constexpr double quietestRelMse = 0.1;

std::string shortNumber(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", value);
    return text;
}

}  // namespace

double expectedRelMse(const FitErrors& errors, double pixelMm) {
    const double shift = gradientPerPixel * 1e-3 * errors.sensorMicrometres.rms / pixelMm;
    return shift * shift + errors.throughputRelative.rms * errors.throughputRelative.rms;
}

double littleNoise(int samples) { return quietestRelMse / samples; }

ChosenFit chooseTerms(const std::function<LensFit(int terms)>& fitOf, double pixelMm, int samples) {
    const double limit = 0.1 * littleNoise(samples);
    ChosenFit chosen;
    for (const int terms : candidates) {
        chosen.fit = fitOf(terms);
        const double error = expectedRelMse(chosen.fit.errors, pixelMm);
        const bool isEnough = error < limit;
        chosen.reason = "representation = \"auto\": " + std::to_string(terms) +
                        " terms, which move the picture by " +
                        shortNumber(1e-3 * chosen.fit.errors.sensorMicrometres.rms / pixelMm) +
                        " pixels rms: a relative error of " + shortNumber(error) +
                        (isEnough ? " squared, below a tenth of the noise of "
                                  : " squared, more than a tenth of the noise of ") +
                        std::to_string(samples) + " samples per pixel even in a quiet scene" +
                        (isEnough ? "" : "; \"traced\" has none");
        if (isEnough) break;
    }
    return chosen;
}

}  // namespace etendue
