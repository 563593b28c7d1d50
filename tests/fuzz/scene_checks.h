// A scene that loads renders: no bad sample, no ray that Embree would have to refuse.
#pragma once

#include <algorithm>
#include <exception>

#include "renderer/image_io.h"
#include "renderer/render.h"
#include "renderer/scene_loader.h"
#include "tests/fuzz/fuzz_support.h"

namespace etendue {

/// A folder with "t.png", "sky.exr" and nothing else.
inline FuzzFolder folderWithImages() {
    const FuzzFolder folder;
    writePng(folder / "t.png", 2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 99, 199});
    const ExrChannels sky{{"R", "G", "B"}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 1e3f}};
    writeExr(folder / "sky.exr", {2, 2, 0, 0, 2, 2}, {sky}, {});
    return folder;
}

/// A fit takes seconds, far more than a target may; all other input is known to be good by then.
/// No std::exception, so that nobody else catches it.
struct FitBegins {};

/// One sample of 4 × 4 pixels in the picture's middle. `isBright`: it may be brighter than a float
/// can say; the program then reports bad samples, as it should.
inline void renderMiddle(LoadedScene& loaded, bool isBright) {
    // A path may be as long as the file says, and a light tracer sends paths from every pixel of
    // the frame, as a lens that parts colours sends wavelengths: that is time that was asked for,
    // and no fault.
    loaded.estimator.maxDepth = std::min(loaded.estimator.maxDepth, 16);
    constexpr double mostPaths = 4096;
    const double pixels = static_cast<double>(loaded.film.width) * loaded.film.height;
    if (loaded.estimator.kind != "pt" && pixels * loaded.estimator.lightPaths > mostPaths)
        loaded.estimator.kind = "pt";
    if (pixels > mostPaths && isParted(*loaded.camera, loaded.film.color == FilmColor::xyz))
        loaded.film.color = FilmColor::rgb;

    FrameWindow window = loaded.film.fullFrame();
    window.width = std::min(4, window.fullWidth);
    window.height = std::min(4, window.fullHeight);
    window.x = (window.fullWidth - window.width) / 2;
    window.y = (window.fullHeight - window.height) / 2;
    Film film(window, {}, loaded.film.color);
    const Filter filter(loaded.film.filter, loaded.film.filterRadius);
    const auto estimator = makeEstimator(loaded.estimator);
    RenderSettings settings;
    settings.samples = 1;
    settings.sampler = loaded.sampler;
    const RenderResult result =
        render(*loaded.scene, *loaded.camera, *estimator, filter, film, settings, {});
    require(isBright || result.badSampleCount == 0, "a bad sample");
    require(result.refusedRays == 0, "a refused ray");
}

inline void checkRender(const std::filesystem::path& file, bool isBright = false) {
    LoadOptions options;
    options.fitProgress = [](double, std::string_view) { throw FitBegins(); };
    try {
        LoadedScene loaded = loadScene(file, options);
        renderMiddle(loaded, isBright);
    } catch (const FitBegins&) {
    }
}

}  // namespace etendue
