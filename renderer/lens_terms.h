// How many terms of a lens a picture is worth: representation = "auto" (docs/speed-accuracy.md).
#pragma once

#include <functional>
#include <string>

#include "lens/lens_fit.h"

namespace etendue {

/// relMSE ((a − r)² / (r² + 0.01), the mean over the picture) that a fit's stated errors come to:
/// (G δ / width)² + (τ / 2)², with δ the shift of the picture on the sensor, rms, τ the error of
/// J τ, rms, of which a pixel takes the mean over the aperture, and G how much the logarithm of a
/// picture changes from one side to the other, all changes taken as one. However many pixels the
/// picture has: what is there to be shifted does not become more by them.
double expectedRelMse(const FitErrors& errors, double sensorWidthMm);

/// relMSE of `samples` per pixel, in a scene of little noise.
double littleNoise(int samples);

struct ChosenFit {
    LensFit fit;
    std::string reason;  // a sentence
};

/// The fit of the fewest terms whose expected relMSE is below a tenth of littleNoise(samples), and
/// if there is none, that of the most. `fitOf` makes or loads one with as many terms.
ChosenFit chooseTerms(const std::function<LensFit(int terms)>& fitOf, double sensorWidthMm,
                      int samples);

}  // namespace etendue
