#include "tools/part_keeper.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "config/config.h"
#include "renderer/atomic_file.h"
#include "tools/progress.h"
#include "tools/stop_request.h"

namespace etendue {

namespace {

namespace fs = std::filesystem;

constexpr double defaultIntervalSeconds = 60.0;
/// By default writing takes no more than one part in so many of the time.
constexpr double timesWriting = 150.0;

/// The newer part that is whole.
std::optional<Part> newestPart(const fs::path& file) {
    if (!fs::exists(file)) {
        say(fmt::format("{}: no such part yet: the render begins\n", file.string()));
        return std::nullopt;
    }
    try {
        return readPart(file);
    } catch (const InputError& error) {
        const fs::path previous = previousPart(file);
        if (!fs::exists(previous)) throw;
        say(fmt::format("etendue: {}\n", error.what()));
        Part part = readPart(previous);
        say(fmt::format("etendue: the render goes on from {} in its place\n", previous.string()));
        return part;
    }
}

}  // namespace

double defaultCheckpointInterval(double writeSeconds) {
    return std::max(defaultIntervalSeconds, timesWriting * writeSeconds);
}

PartKeeper::PartKeeper(fs::path file, PartInfo info, std::uint32_t firstSample,
                       std::optional<double> intervalSeconds)
    : file_(std::move(file)),
      info_(std::move(info)),
      first_(firstSample),
      intervalSeconds_(intervalSeconds) {}

std::uint32_t PartKeeper::resume(Film& film) {
    std::optional<Part> part = newestPart(file_);
    if (!part) return first_;
    const auto fail = [&](const std::string& reason) {
        throw InputError(fmt::format("{}: {}", file_.string(), reason));
    };
    if (const std::string difference = differenceOf(info_, part->info); !difference.empty())
        fail("is a part of another picture than the one asked for: " + difference +
             "; --samples asks for more without a change of files or settings");
    const std::vector<SampleRange>& ranges = part->info.ranges.ranges();
    if (ranges.size() > 1 || (ranges.size() == 1 && ranges.front().begin != first_))
        fail(
            fmt::format("holds the samples {}, which do not go on from {}; --range and \"etendue "
                        "merge\" fill holes",
                        part->info.ranges.text(), first_));
    const std::uint32_t next = ranges.empty() ? first_ : ranges.front().end;
    const std::vector<std::uint32_t>& unfinished = part->info.unfinishedSamples;
    const bool isOwn = unfinished == std::vector{next} && part->state.unfinishedParts > 0;
    if (!unfinished.empty() && !isOwn)
        fail("has unfinished samples that do not go on from its others; a merge can leave such");
    film.restore(std::move(part->state));
    earlierSeconds_ = part->info.seconds;
    return next;
}

bool PartKeeper::isDue() const {
    const double interval = intervalSeconds_.value_or(defaultCheckpointInterval(writeSeconds_));
    const std::chrono::duration<double> since = Clock::now() - last_;
    return takeWriteRequest() || since.count() >= interval;
}

void PartKeeper::write(const Film& film, std::uint32_t end, double seconds,
                       const Metadata& metadata) {
    if (file_.empty()) return;
    const Clock::time_point start = Clock::now();
    PartInfo info = info_;
    if (end > first_) info.ranges.add({first_, end});
    if (film.state().unfinishedParts > 0) info.unfinishedSamples.push_back(end);
    info.seconds = earlierSeconds_ + seconds;
    writePart(file_, info, film, metadata);
    last_ = Clock::now();
    writeSeconds_ = std::chrono::duration<double>(last_ - start).count();
}

void PartKeeper::writeCheckpoint(const Film& film, std::uint32_t end, double seconds,
                                 const Metadata& metadata) {
    try {
        write(film, end, seconds, metadata);
    } catch (const std::exception& error) {
        say(fmt::format("etendue: {}; the render goes on and will try again\n", error.what()));
        last_ = Clock::now();
    }
}

void PartKeeper::remove() const {
    std::error_code ignored;  // a part too many is no failure
    fs::remove(file_, ignored);
    fs::remove(previousPart(file_), ignored);
}

fs::path keptPartOf(const fs::path& output) {
    return isWrittenDirectly(output) ? fs::path() : partFileFor(output);
}

fs::path lockedFor(const fs::path& output) {
    const fs::path part = keptPartOf(output);
    return part.empty() ? output : part;
}

void refuseToReplacePart(const fs::path& part, const std::string& remedy) {
    std::error_code error;
    if (!fs::exists(part, error)) return;
    throw InputError(
        fmt::format("{}: holds samples of an unfinished render; {}, --restart throws them away",
                    part.string(), remedy),
        ExitCode::usage);
}

void tellBadSamplesOfParts(std::uint64_t count) {
    if (count > 0)
        say(fmt::format(
            "etendue: {} samples of the parts were not finite or negative and were left out\n",
            count));
}

}  // namespace etendue
