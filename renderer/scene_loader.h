// Scene files → Scene, Camera and settings. docs/scene-format.md describes the file.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/config.h"
#include "renderer/camera.h"
#include "renderer/estimator.h"
#include "renderer/film.h"
#include "renderer/filter.h"
#include "renderer/scene.h"

namespace etendue {

struct FilmSettings {
    int width = 720, height = 480;
    FilterKind filter = FilterKind::box;
    float filterRadius = 0.5f;         // pixels
    FilmColor color = FilmColor::rgb;  // xyz: the render is spectral

    FrameWindow fullFrame() const { return {width, height, 0, 0, width, height}; }
};

/// What a scene's lens was fitted by, and how well: rms on rays drawn anew (FitErrors).
struct FitSummary {
    int terms = 0, degree = 0;
    double directionMrad = 0.0, sensorMicrometres = 0.0;
    std::string hash;  // of all its numbers
};

struct LoadedScene {
    std::unique_ptr<Scene> scene;
    std::unique_ptr<Camera> camera;
    FilmSettings film;
    EstimatorSettings estimator;
    Sampler sampler = Sampler::independent;
    int samples = 64;
    std::string lensModel = "pinhole";  // in words: "thin lens", "two-point, 40 terms, degree 11"
    std::optional<FitSummary> fit;      // of a camera whose lens is a polynomial
    std::vector<std::string> notes;     // what the user should know, but what is not an error
    std::string hash;  // of the bytes of every file read and of the overrides, as 32 hex digits
    // For the image's metadata.
    double fNumber = 0.0;        // 0: pinhole
    double focusDistance = 0.0;  // m, 0: everything is sharp
};

struct LoadOptions {
    std::vector<std::string> overrides;  // "key=value", after the files
    int threads = 1;
    std::filesystem::path fitCache = {};  // folder of lens fits; empty: none is kept
    /// Hears how far a lens fit is: share in 0–1, and what is being done.
    std::function<void(double, std::string_view)> fitProgress = {};
    bool disperses = true;            // camera.dispersion where no file and no override says it
    std::optional<int> samples = {};  // in place of estimator.samples; no part of the hash
    /// A file whose [camera] is looked through in place of the scene's, from the scene's `from`,
    /// `to` and `up` unless it has its own; where neither has any, it sees the whole scene. Empty:
    /// none.
    std::filesystem::path camera = {};

    /// Overrides the picture's size.
    void setSize(int width, int height) {
        overrides.push_back("film.width=" + std::to_string(width));
        overrides.push_back("film.height=" + std::to_string(height));
    }
};

/// `file` is a scene (.toml) or a bare model (.obj), which gets a camera and, if nothing in it
/// emits, a soft light. Throws InputError.
LoadedScene loadScene(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace etendue
