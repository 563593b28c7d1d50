// Fit files: a LensFit as JSON, with what it was fitted to and its measured errors, so that a lens
// is fitted once. nlohmann-json is known to fit_file.cpp alone.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "lens/lens_fit.h"

namespace etendue {

/// What a fit file holds.
std::string fitFileText(const LensFit& fit);

/// Written beside `file` and renamed over it, so that no reader ever meets half a file, and
/// whatever was there is replaced, a link too: for files of our own, such as the cache's. Throws
/// std::runtime_error, naming the file, when that fails.
void writeFitFile(const std::filesystem::path& file, const LensFit& fit);

/// Removes what writes that were killed left in the folder a day ago or longer.
void removeStaleParts(const std::filesystem::path& directory);

/// What a fit must have been made for.
struct FitKey {
    std::uint64_t prescriptionHash = 0;
    FitDomain domain;
    FitSettings settings;
    int algorithm = fitAlgorithmVersion;

    bool operator==(const FitKey&) const = default;
};
FitKey fitKey(const Prescription& prescription, const FitDomain& domain,
              const FitSettings& settings);

/// A fit, or why there is none: the file is missing, truncated, changed, none of ours, not built as
/// a fit is (fit_check.h), or of another lens, domain, settings or version. Every number comes back
/// with the bits it was written with.
struct FitFileContent {
    std::optional<LensFit> fit;
    std::string refusal;
};
FitFileContent readFitFile(const std::filesystem::path& file);
FitFileContent readFitFile(const std::filesystem::path& file, const FitKey& key);

}  // namespace etendue
