// BenchSuite: what `etendue bench` measures (docs/benchmarks.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/config.h"
#include "tools/scene_names.h"

namespace etendue {

/// A setting of the scene under which the same picture is rendered, such as the terms of a lens.
struct BenchVariant {
    std::string name;                       // empty: the scene as it is
    std::vector<std::string> overrides;     // "key=value"
    std::optional<ConfigTable> table = {};  // of a suite's file, if it is there
};

/// What is compared with each other: one scene through one camera.
struct BenchView {
    NamedFile scene, camera;
    std::vector<std::string> overrides;  // of the reference, too
    std::vector<BenchVariant> variants;
    std::vector<std::string> estimators;
    std::optional<ConfigTable> group = {};  // of a suite's file; none: named on the command line
};

struct BenchSuite {
    std::string title;
    int width = 96, height = 64;
    int seeds = 8;         // runs of each estimator and variant; at least two
    double seconds = 2.0;  // of each run
    std::uint32_t mostSamples = 1u << 20;
    double targetRelMse = 0.01;
    double referenceSeconds = 60.0;
    std::string referenceEstimator = "bdpt";
    bool wantsTechniques = true;  // pictures of bdpt's techniques
    bool wantsFitErrors = false;  // what the fits of lenses do to the pictures by themselves
    std::vector<BenchView> views;

    /// Of everything that its results depend on, but for the contents of scenes.
    std::string key() const;
    std::size_t runCount() const;
};

/// Why the view cannot be one more of the suite's, in words: results are kept by names, and it has
/// another's.
std::optional<std::string> nameClash(const BenchSuite& suite, const BenchView& view);

/// Throws the error, met when the view was loaded under the variant, with the line and key of the
/// suite that ask for what is wrong. The view without a variant's overrides is known to be right by
/// the time that one with some is loaded.
[[noreturn]] void failLoading(const BenchView& view, const BenchVariant& variant,
                              const InputError& error);

/// Throws InputError for what the file says amiss, and for names of scenes and cameras that are not
/// there. Scenes and cameras by name are those of the folder above the file's, or of its `folder`.
BenchSuite loadBenchSuite(const std::filesystem::path& file);

}  // namespace etendue
