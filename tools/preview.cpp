#include "tools/preview.h"

#include "renderer/srgb.h"

namespace etendue {

void writePreview(const Preview& preview, const FrameWindow& window,
                  const std::vector<float>& rgb) {
    if (preview.file.empty()) return;
    writePng(preview.file, window.width, window.height,
             srgbBytes(rgb, static_cast<float>(preview.exposureStops)));
}

}  // namespace etendue
