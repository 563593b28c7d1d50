// Scenes for tests, and the comparison of pictures by statistics.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/render.h"
#include "renderer/scene_loader.h"
#include "tests/support/temporary_folder.h"

namespace etendue {

/// Loads a scene from the text of its file.
LoadedScene sceneFromText(const std::string& text, const std::vector<std::string>& overrides = {});

/// The linear RGB pixels of one render, three floats each.
std::vector<float> renderPixels(const LoadedScene& loaded, std::uint32_t samples,
                                std::uint64_t seed, int threads = 1);

/// Radiance along one ray, averaged over `samples` in each of `batches` independent batches; lane
/// 0.
std::vector<double> batchRadiances(const LoadedScene& loaded, Vec3 origin, Vec3 direction,
                                   int batches, int samples);

/// Welch's t-test per tile of the means over seeds (Jung, Hanika and Dachsbacher 2020), corrected
/// for the number of tiles, and the bias of the whole picture with its confidence interval.
struct PictureComparison {
    double smallestP = 1.0;              // over tiles; to be compared with `level`
    double level = 0.0;                  // per tile, Šidák-corrected from 0.01 overall
    double relativeBias = 0.0;           // (mean a − mean b) / mean b
    double relativeBiasHalfWidth = 0.0;  // of its 99 % confidence interval
    bool agree() const { return smallestP > level; }
    /// The bias is below `bound` with 99 % confidence: agreement that noise cannot fake.
    bool isEquivalent(double bound) const {
        return std::abs(relativeBias) + relativeBiasHalfWidth < bound;
    }
};
/// Each picture of `a` and `b` was rendered with a seed of its own; `width` in pixels.
PictureComparison comparePictures(const std::vector<std::vector<float>>& a,
                                  const std::vector<std::vector<float>>& b, int width,
                                  int tileSize);

}  // namespace etendue
