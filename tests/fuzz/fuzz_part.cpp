// Part files: what is read can be taken up by a film, is written again as it was, and merges.
//
// An input is a byte of flags, the header's text, a byte 0, and what the sums are made of. The
// target puts a part file together from it, whose checksum is right: behind that the reader's work
// begins.
#include <algorithm>
#include <cstring>

#include "renderer/content_hash.h"
#include "renderer/part_file.h"
#include "renderer/part_header.h"
#include "tests/fuzz/scene_checks.h"

using namespace etendue;

namespace {

enum Flags : unsigned {
    keepsSize = 1,     // of the sums, rather than giving them the one that the header asks for
    isMisplaced = 2,   // the header is said to lie elsewhere
    isZeroBeyond = 4,  // where the input's sums end, and not from their start again
};

/// Of the sums that the header announces; nothing where it is none, or asks for more than a test
/// should write.
std::optional<std::size_t> bytesAnnounced(std::string_view header) {
    try {
        const PartHeader parsed = parsePartHeader(header, "header");
        const FrameWindow& window = parsed.part.info.window;
        if (static_cast<double>(window.width) * window.height > 4096) return {};
        return bytesOfSums(parsed);
    } catch (const InputError&) {
        return {};
    }
}

std::string partOf(std::string_view input) {
    const unsigned flags = input.empty() ? 0u : static_cast<unsigned char>(input[0]);
    input.remove_prefix(std::min<std::size_t>(1, input.size()));
    const std::size_t end = std::min(input.find('\0'), input.size());
    const std::string_view header = input.substr(0, end);
    std::string sums(input.substr(std::min(end + 1, input.size())));
    if (const auto bytes = bytesAnnounced(header); bytes && !(flags & keepsSize)) {
        const std::size_t had = sums.size();
        sums.resize(*bytes, '\0');
        if (had > 0 && !(flags & isZeroBeyond))
            for (std::size_t i = had; i < sums.size(); ++i) sums[i] = sums[i - had];
    }
    const std::string picture = "picture";
    std::uint64_t place[2] = {picture.size(), header.size()};
    if (flags & isMisplaced) std::memcpy(place, sums.data(), std::min(sums.size(), sizeof place));
    std::string part = picture + std::string(header) + sums + "etenpart";
    part.append(reinterpret_cast<const char*>(place), sizeof place);
    ByteHasher hasher;
    hasher.add(part.data(), part.size());
    return part + hasher.digest();
}

void checkWritten(const FuzzFolder& folder, const Part& part, const Film& film) {
    const std::filesystem::path file = folder / "again.part.exr";
    writePart(file, part.info, film, {});
    const Part again = readPart(file);
    require(differenceOf(part.info, again.info).empty() && part.info.ranges == again.info.ranges &&
                part.info.unfinishedSamples == again.info.unfinishedSamples &&
                part.info.picture == again.info.picture,
            "a part's header is written otherwise than it was read");
    require(part.state == again.state, "a part's sums are written otherwise than read");
}

void checkMerged(const Part& part) {
    PartInfo info = part.info;
    info.ranges = {};
    info.unfinishedSamples.clear();
    Film film(info.window, info.layers, info.color);
    mergePart(info, film, part, "part");
    require(info.ranges == part.info.ranges, "a merge has other samples than its part");
    if (info.ranges.empty() && info.unfinishedSamples.empty()) return;
    try {
        mergePart(info, film, part, "part");
        require(false, "a part merges with itself");
    } catch (const InputError&) {
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FuzzFolder folder;
    const std::filesystem::path file = folder.write("a.part.exr", partOf(textOf(data, size)));
    try {
        const PartInfo info = readPartInfo(file);
        const Part part = readPart(file);
        require(differenceOf(info, part.info).empty(), "a part has two headers");
        Film film(part.info.window, part.info.layers, part.info.color);
        film.restore(part.state);
        film.channels();
        checkWritten(folder, part, film);
        checkMerged(part);
    } catch (const InputError&) {
    }
    return 0;
}
