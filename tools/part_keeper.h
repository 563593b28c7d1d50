// PartKeeper: the part file of a render, which the render goes on from and writes on its way.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "renderer/film.h"
#include "renderer/image_io.h"
#include "renderer/part_file.h"
#include "renderer/sample_ranges.h"

namespace etendue {

/// From the end of a checkpoint to the next, where nobody says: writing, which took so long the
/// last time, is to take less than a hundredth of a render.
double defaultCheckpointInterval(double writeSeconds);

class PartKeeper {
public:
    /// Without an interval one that keeps what writing takes below a hundredth of the time. `info`:
    /// of a part that has no samples yet. Without a file nothing is ever written.
    PartKeeper(std::filesystem::path file, PartInfo info, std::uint32_t firstSample,
               std::optional<double> intervalSeconds);

    /// Takes up the part that is there, or if it is damaged the one before it, and returns the next
    /// sample to take: the first one if there is neither. Throws InputError for a part of another
    /// picture, or one that cannot go on.
    std::uint32_t resume(Film& film);

    /// Whether it is time to write, by the clock or by SIGUSR1.
    bool isDue() const;
    /// All samples until `end`, of the film's, and what it has of that one. `seconds`: that this
    /// process has rendered.
    void write(const Film& film, std::uint32_t end, double seconds, const Metadata& metadata);
    /// The same, but a failure is no reason to end the render: it is said, and tried again later.
    void writeCheckpoint(const Film& film, std::uint32_t end, double seconds,
                         const Metadata& metadata);
    /// The picture is finished and written: the parts are needed no more.
    void remove() const;

    const std::filesystem::path& file() const { return file_; }
    /// Rendered before resume().
    double earlierSeconds() const { return earlierSeconds_; }

private:
    using Clock = std::chrono::steady_clock;

    std::filesystem::path file_;
    PartInfo info_;
    std::uint32_t first_ = 0;      // of the range that grows
    double earlierSeconds_ = 0.0;  // rendered by other processes
    std::optional<double> intervalSeconds_;
    double writeSeconds_ = 0.0;  // that the last part took
    Clock::time_point last_ = Clock::now();
};

/// The part of a picture; none of one that goes into a pipe or a device.
std::filesystem::path keptPartOf(const std::filesystem::path& output);

/// What to lock before writing an output: the part that "x.exr", "x" and "x.part.exr" have in
/// common, since whoever writes one of them may write and remove it.
std::filesystem::path lockedFor(const std::filesystem::path& output);

/// Throws InputError if there is a part already, whose samples would be lost. `remedy`: how to keep
/// them, "--resume goes on from them".
void refuseToReplacePart(const std::filesystem::path& part, const std::string& remedy);

/// Says aloud what the parts of a picture have left out, if anything.
void tellBadSamplesOfParts(std::uint64_t count);

}  // namespace etendue
