// Part files, "x.part.exr": some samples of a picture, as sums and counts, so that a render can go
// on from them and parts add up to the render of all their samples. docs/part-files.md.
//
// Any EXR viewer shows the picture so far. Behind it lie, where viewers do not look, a header in
// TOML, the film's sums byte for byte, and a checksum of the whole file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/film.h"
#include "renderer/image_io.h"
#include "renderer/sample_ranges.h"

namespace etendue {

struct PartInfo {
    FrameWindow window;
    FilmLayers layers;
    FilmColor color = FilmColor::rgb;
    SampleRanges ranges;  // of samples that every pixel has had
    /// Those that a part of the frame has had: one, or after a merge of such parts more.
    std::vector<std::uint32_t> unfinishedSamples;
    double seconds = 0.0;  // of rendering, over all processes
    /// What the samples are samples of: names and values, such as {"seed", "0"}. Only parts whose
    /// lists are equal belong to the same picture.
    std::vector<std::pair<std::string, std::string>> madeFrom;
    /// What a picture's file says of scene and camera, as that of merged parts is to say, too: some
    /// of etendue:scene, etendue:estimator, worldToCamera, aperture, focus.
    Metadata picture;
};

struct Part {
    PartInfo info;
    FilmState state;
};

/// "x.part.exr" of a picture "x.exr", and of a part its own name.
std::filesystem::path partFileFor(const std::filesystem::path& picture);
bool isPartFile(const std::filesystem::path& file);
/// Where writePart() leaves the part that it replaces: "x.part.old.exr".
std::filesystem::path previousPart(const std::filesystem::path& part);

/// Writes as AtomicFile does. `info` has the film's window, layers and color.
void writePart(const std::filesystem::path& file, const PartInfo& info, const Film& film,
               const Metadata& metadata);

/// Throws InputError for a file that is missing, no part, damaged anywhere, or of another version.
Part readPart(const std::filesystem::path& file);
/// The same without the sums, but for the check of the whole file.
PartInfo readPartInfo(const std::filesystem::path& file);

/// What keeps two parts from being of the same picture: the first name of `madeFrom`, or "window",
/// "layers" or "color", that differs, with both values. Empty if nothing does.
std::string differenceOf(const PartInfo& expected, const PartInfo& found);

/// Adds a part's samples to those of `info` and `film`. Throws InputError, naming `file`, and
/// changes nothing, if it is of another picture or has samples that are there already. Of one that
/// is not finished, and of which the sums have nothing, nothing is taken, and another part may have
/// it.
void mergePart(PartInfo& info, Film& film, const Part& part, const std::filesystem::path& file);

}  // namespace etendue
