#include "tools/merge_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "renderer/output_lock.h"
#include "renderer/part_file.h"
#include "tools/part_keeper.h"
#include "tools/progress.h"
#include "tools/version.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

struct Merged {
    PartInfo info;
    Film film;
};

Merged mergeAll(const std::vector<std::filesystem::path>& parts) {
    std::optional<Merged> merged;
    for (const std::filesystem::path& file : parts) {
        const Part part = readPart(file);
        if (!merged) {
            PartInfo empty = part.info;
            empty.ranges = {};
            empty.unfinishedSamples.clear();
            empty.seconds = 0.0;
            merged =
                Merged{std::move(empty), Film(part.info.window, part.info.layers, part.info.color)};
        }
        mergePart(merged->info, merged->film, part, file);
        if (part.state.sampleLight.empty()) continue;
        const char* what = merged->film.wantsFeatures() ? "the light of sample" : "sample";
        for (const std::uint32_t sample : part.info.unfinishedSamples)
            say(fmt::format("{}: {} {} is unfinished and left out\n", file.string(), what, sample));
    }
    return std::move(*merged);
}

Metadata metadataFor(const MergeCommand& command, const Merged& merged) {
    Metadata m = merged.info.picture;
    m["software"] = fmt::format("etendue {}", version);
    m["etendue:version"] = std::string(version);
    m["etendue:command"] = command.commandLine;
    m["etendue:samples"] = static_cast<int>(merged.film.samples());
    m["etendue:ranges"] = merged.info.ranges.text();
    m["etendue:renderSeconds"] = static_cast<float>(merged.info.seconds);
    for (const auto& [name, value] : merged.info.madeFrom) {
        if (name == "seed") m["etendue:seed"] = value;
        if (name == "scene") m["etendue:sceneHash"] = value;
    }
    return m;
}

void writeMerged(const MergeCommand& command, const Merged& merged) {
    const Metadata metadata = metadataFor(command, merged);
    const std::vector<ExrChannels> channels = merged.film.channels();
    if (isPartFile(command.output))
        writePart(command.output, merged.info, merged.film, metadata);
    else
        writeExr(command.output, merged.film.window(), channels, metadata);
    writePreview(command.preview, merged.film.window(), channels.front().pixels);
}

/// What the picture is, compared with that of one render of all its samples.
std::string exactnessText(const Merged& merged) {
    const FilmState& state = merged.film.state();
    if (!merged.info.unfinishedSamples.empty())
        return "parts of the frame have had samples that others have not";
    if (state.roundedTerms == 0) return "bit for bit the render of all of them at once";
    return fmt::format(
        "the render of all of them at once but for {} terms, rounded at 2⁻⁷⁷ of their sums",
        state.roundedTerms);
}

std::string contentText(const Merged& merged) {
    if (merged.film.samples() == 0 && merged.film.isSplattedOn())
        return "black, since no sample is whole";
    return fmt::format("samples {}, {}", merged.info.ranges.text(), exactnessText(merged));
}

void checkFiles(const MergeCommand& command) {
    checkWritable(command.output, ".exr");
    checkWritable(command.preview.file, ".png");
    std::vector<GivenFile> written{{"--preview", command.preview.file}}, read;
    for (const std::filesystem::path& part : command.parts) read.push_back({"a part", part});
    // A part that others are added to loses no sample that is whole.
    (isPartFile(command.output) ? read : written).push_back({"-o", command.output});
    checkDistinct(written, read);
}

/// Whether there is a part in the output's place whose samples the merge does not have.
bool replacesPart(const MergeCommand& command) {
    const auto isOutput = [&](const std::filesystem::path& part) {
        std::error_code error;  // of one that is not there, which is another
        return std::filesystem::equivalent(part, command.output, error);
    };
    return isPartFile(command.output) && std::ranges::none_of(command.parts, isOutput);
}

}  // namespace

ExitCode runMerge(const MergeCommand& command) {
    checkFiles(command);
    const OutputLock lock(lockedFor(command.output));
    if (!command.restarts && replacesPart(command))
        refuseToReplacePart(command.output, "named among the parts it adds to them");
    const Merged merged = mergeAll(command.parts);
    writeMerged(command, merged);
    fmt::print("{}: {}\n", command.output.string(), contentText(merged));
    tellBadSamplesOfParts(merged.film.badSamples());
    if (!command.required) return ExitCode::success;
    const std::vector<SampleRange> holes = merged.info.ranges.holes(*command.required);
    for (const SampleRange& hole : holes) say(fmt::format("hole {}\n", textOf(hole)));
    return holes.empty() ? ExitCode::success : ExitCode::stoppedEarly;
}

}  // namespace etendue
