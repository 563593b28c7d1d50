// Scenes for tests, and their pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/render.h"
#include "renderer/scene_loader.h"
#include "statistics/picture_comparison.h"
#include "tests/support/temporary_folder.h"

namespace etendue {

/// A grey ball under an even sky, 30 × 20 pixels.
inline constexpr const char* ballScene = R"(
[film]
width = 30
height = 20
[camera]
from = [0, 0.5, 3]
to = [0, 0, 0]
[[material]]
name = "wall"
color = [0.5, 0.6, 0.7]
[[mesh]]
shape = "sphere"
material = "wall"
[[light]]
type = "constant"
radiance = [1, 1, 1]
)";

/// Loads a scene from the text of its file.
LoadedScene sceneFromText(const std::string& text, const std::vector<std::string>& overrides = {});

/// The linear RGB pixels of one render, three floats each.
std::vector<float> renderPixels(const LoadedScene& loaded, std::uint32_t samples,
                                std::uint64_t seed, int threads = 1);

/// Radiance along one ray, averaged over `samples` in each of `batches` independent batches; lane
/// 0.
std::vector<double> batchRadiances(const LoadedScene& loaded, Vec3 origin, Vec3 direction,
                                   int batches, int samples);

}  // namespace etendue
