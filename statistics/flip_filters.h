// The filters of FLIP's observer: contrast sensitivity, edges and points.
#pragma once

#include <vector>

namespace etendue {

/// One number a pixel, row by row.
struct Plane {
    int width = 0, height = 0;
    std::vector<float> values;
};

/// Weights of an odd number of neighbouring pixels, the middle one at the pixel itself.
using Kernel = std::vector<float>;

/// Σ horizontal[i] · vertical[j] · plane(x + i, y + j); beyond its edges the plane goes on as its
/// outermost pixels.
Plane filtered(const Plane& plane, const Kernel& horizontal, const Kernel& vertical);

/// FLIP's channels: lightness, red against green, blue against yellow (YCxCz).
enum class OpponentChannel { achromatic, redGreen, blueYellow };
/// A sum of two round Gaussians, each separable. Weights of each sum to 1, `share` of both too.
struct ContrastSensitivity {
    Kernel first, second;
    float shareOfFirst = 1.0F, shareOfSecond = 0.0F;
};
/// Andersson et al. 2020, equations 5 and 6 with table 1.
ContrastSensitivity contrastSensitivity(OpponentChannel channel, double pixelsPerDegree);
Plane filtered(const Plane& plane, const ContrastSensitivity& sensitivity);

/// A Gaussian of the width of human edge detectors and its first two derivatives, the positive
/// weights of each summing to 1, the negative ones to −1 (Andersson et al. 2020, section 4.3).
struct FeatureKernels {
    Kernel smooth, edge, point;
};
FeatureKernels featureKernels(double pixelsPerDegree);

}  // namespace etendue
