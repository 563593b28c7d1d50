// SamplePath: one sample of a picture traced again, with all that it met on its way. The same
// random numbers are drawn in the same order as by the estimator, so that it is the very same path.
#pragma once

#include <vector>

#include "renderer/estimator.h"
#include "renderer/subpath.h"

namespace etendue {

struct SamplePath {
    std::optional<CameraSample> camera;    // none: the estimator draws none
    CameraSubpath cameraPath;              // no vertices: no ray, or nothing is traced from there
    std::vector<LightSubpath> lightPaths;  // the camera's path is connected to the last one
    /// What the estimator found. Of path tracing, which has no techniques: its terms under the
    /// names of the techniques that they are, s = 0 for a light that was met and s = 1 for one that
    /// was sampled.
    std::vector<Contribution> contributions;
    /// The sum of those that are not splatted, weighted: to the bit what the sample adds to its own
    /// pixel, if the film takes it. As all values here: RGB, of a spectral render XYZ.
    Spectrum ownPixel;
    Spectrum splatted;  // the sum of the others, wherever they land
};

/// Traces a sample of the estimator that makeEstimator makes of `settings`. The memory of `result`
/// is used again. Floats flush denormals, as in a render, if the caller sees to it
/// (FlushDenormals).
void retraceSample(const View& view, const Estimator& estimator, const EstimatorSettings& settings,
                   SampleId id, SamplePath& result);

/// Makes the lens connectable if connecting what the camera's path met first to it finds the film
/// point where the path began, as bidirectional path tracing does. If not, no technique with t = 1
/// makes this path. To be called after retraceSample, where it matters: a connection takes time.
void markReachability(const View& view, SamplePath& path);

}  // namespace etendue
