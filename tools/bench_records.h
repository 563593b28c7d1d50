// What a benchmark has measured so far: a file of JSON lines that only grows, so that an
// interrupted suite goes on where it stopped. docs/benchmarks.md has the schema.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "statistics/image_error.h"

namespace etendue {

/// A run's picture after so many samples, against the reference.
struct BenchCheckpoint {
    std::uint32_t samples = 0;  // per pixel
    double seconds = 0.0;       // of rendering alone
    ImageErrors errors;         // the reference's noise included
};

/// Which estimator, under which settings. Names, as the suite has them.
struct BenchConfiguration {
    std::string scene, camera, variant, estimator;
    bool operator==(const BenchConfiguration&) const = default;
};
/// "cornell-box, double-gauss, 32 terms, bdpt".
std::string titleOf(const BenchConfiguration& configuration);

/// One progressive render.
struct BenchRun {
    BenchConfiguration configuration;
    int seed = 0;
    std::string sceneHash;
    double load = 0.0;  // of the machine, as it began: mean number of running processes
    std::uint64_t badSamples = 0;
    double flip = 0.0;  // mean HDR-FLIP of the last picture
    std::vector<BenchCheckpoint> checkpoints;
};

/// A picture that counts as the truth, and how far it can be trusted.
struct BenchReference {
    std::string scene, camera, estimator, key;
    std::uint64_t samples = 0;  // per pixel
    double seconds = 0.0;
    double relMse = 0.0;  // expected, from the spread of its independent parts
};

/// A camera under a variant, and what asking it costs.
struct BenchLens {
    std::string camera, variant, description;
    std::optional<double> terms, fitErrorMrad, fitErrorMicrometres;  // of a fit
    double rayNs = 0.0, connectNs = 0.0;
};

/// What the fit of a camera's lens does to a picture by itself (bench_fit_error.h).
struct BenchFitError {
    std::string scene, camera, variant;
    double relMse = 0.0, low = 0.0, high = 0.0;
    double noiseOfOneSample = 0.0;
};

/// Where and by what a suite was run.
struct BenchHeader {
    std::string title, key, command, version, started;
    std::string processor, isa, compiler, build, system;
    int cores = 0, threads = 0;
    double load = 0.0;
};

struct BenchRecords {
    std::optional<BenchHeader> header;
    std::vector<BenchReference> references;
    std::vector<BenchLens> lenses;
    std::vector<BenchFitError> fitErrors;
    std::vector<BenchRun> runs;

    /// Null if there is none.
    const BenchRun* find(const BenchConfiguration& configuration, int seed) const;
};

/// Empty for a file that is not there. A last line that was cut short is left out and removed from
/// the file: it was never finished. Throws InputError (file, line) for any other line that is not
/// of the schema, and for a run that is there twice, which would count as two independent ones.
BenchRecords readBenchRecords(const std::filesystem::path& file);

/// Appends a line and syncs the file. Throws std::system_error.
void appendRecord(const std::filesystem::path& file, const BenchHeader& header);
void appendRecord(const std::filesystem::path& file, const BenchReference& reference);
void appendRecord(const std::filesystem::path& file, const BenchLens& lens);
void appendRecord(const std::filesystem::path& file, const BenchFitError& error);
void appendRecord(const std::filesystem::path& file, const BenchRun& run);

/// A row for each checkpoint, with the names of the columns first.
std::string csvOf(const std::vector<BenchRun>& runs);

}  // namespace etendue
