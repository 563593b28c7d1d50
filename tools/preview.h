// The sRGB picture that some commands write beside the EXR.
#pragma once

#include <filesystem>
#include <vector>

#include "renderer/image_io.h"

namespace etendue {

struct Preview {
    std::filesystem::path file;  // empty: none is wanted
    double exposureStops = 0.0;
};

/// A PNG of linear `rgb`, three numbers a pixel of the window.
void writePreview(const Preview& preview, const FrameWindow& window, const std::vector<float>& rgb);

}  // namespace etendue
