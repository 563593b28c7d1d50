// What a fit's error does to a picture: predicted ray by ray from both lenses, bounded by what the
// fit states, and rendered. docs/lens-image-error.md has the derivation.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "lens/lens_fit.h"
#include "renderer/camera.h"
#include "tests/support/chart.h"

namespace etendue {

/// A picture of it through a lens.
struct ChartView {
    std::filesystem::path lensFile;
    double sensorWidthMm = 36.0;
    int width = 48, height = 32;  // pixels
    std::optional<double> fNumber = {};
    double focusDistanceMm = std::numeric_limits<double>::infinity();
    double periodPixels = 8.0;  // of the chart's waves, in the middle of the picture

    double pixelMm() const { return sensorWidthMm / width; }
};

/// One lens as it is and as its fit has it, with one aperture, sensor and wavelength.
struct LensPair {
    ChartView view;
    LensFit fit;
    std::shared_ptr<const LensModel> traced, fitted;
    std::unique_ptr<Camera> tracedCamera, fittedCamera;
    Chart chart;
};
LensPair makeLensPair(const ChartView& view, int terms);

/// Of the fitted lens' picture less the traced one's, each a mean over film and aperture points of
/// a lattice.
struct Prediction {
    PixelMap firstOrder;  // equation (3): shift, throughput and clipping
    PixelMap exact;       // equation (2): the difference of the two integrands
    PixelMap remainder;   // the most that the second order, which (3) leaves out, can add
};

/// What a bound needs besides the fit's stated errors: the chart's own and the exact lens'. Weights
/// are 1 in the mean of the rays from the middle of the sensor.
struct ChartFacts {
    double steepest = 0.0;          // most of weight · |∂L/∂s|, 1/mm on the film
    double heaviest = 0.0;          // most weight
    double meanWeight = 0.0;        // of the rays that pass
    double shiftRmsMm = 0.0;        // of the rays that both let pass, as the fit states of others
    double normDifference = 0.0;    // of the N of docs/camera.md, equation (1), relative
    double decidedOtherwise = 0.0;  // share of the rays that one lens alone lets pass
};

struct PredictionSet {
    std::vector<Prediction> replicates;
    ChartFacts facts;

    std::vector<PixelMap> maps(PixelMap Prediction::*map, std::size_t from, std::size_t to) const;
};
/// `replicates` independent ones, each of `points` rays a pixel.
PredictionSet predict(const LensPair& pair, int replicates, int points, std::uint64_t seed);

/// What the fit's own stated errors allow a pixel to differ by; docs/lens-image-error.md.
struct StatedBound {
    double rms = 0.0;
    double most = 0.0;  // where no ray is decided otherwise
};
StatedBound statedBound(const LensPair& pair, const ChartFacts& facts);

}  // namespace etendue
