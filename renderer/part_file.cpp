#include "renderer/part_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <span>

#include "config/config.h"
#include "renderer/content_hash.h"
#include "renderer/part_header.h"

namespace etendue {

namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little,
              "parts are written as they lie in memory");

constexpr const char* suffix = ".part.exr";

/// The end of the file.
struct Trailer {
    std::array<char, 8> magic;
    std::uint64_t headerOffset, headerSize;
    std::array<char, 32> digest;  // of all bytes before it
};
static_assert(sizeof(Trailer) == 56);
constexpr std::array<char, 8> magic{'e', 't', 'e', 'n', 'p', 'a', 'r', 't'};

/// Writes, and hashes what it writes.
class Writer {
public:
    explicit Writer(AtomicFile& file) : file_(file) {}
    void write(const void* bytes, std::size_t size) {
        hasher_.add(bytes, size);
        file_.write(bytes, size);
        size_ += size;
    }
    template <class T>
    void write(const std::vector<T>& values) {
        write(values.data(), values.size() * sizeof(T));
    }
    std::uint64_t size() const { return size_; }
    std::string digest() const { return hasher_.digest(); }

private:
    AtomicFile& file_;
    ByteHasher hasher_;
    std::uint64_t size_ = 0;
};

InputError damaged(const fs::path& file, const std::string& how) {
    return InputError(fmt::format("{}: {}", file.string(), how));
}

/// A part that is open, and has been found whole.
class Reader {
public:
    explicit Reader(const fs::path& file) : file_(file) {
        std::error_code error;
        if (!fs::is_regular_file(file, error)) throw missingFileError(file);
        size_ = fs::file_size(file);
        stream_.open(file, std::ios::binary);
        if (!stream_) throw missingFileError(file);
        if (size_ < sizeof trailer_) throw damaged(file, "is no part file, or cut short");
        stream_.seekg(static_cast<std::streamoff>(size_ - sizeof trailer_));
        read(&trailer_, sizeof trailer_);
        if (trailer_.magic != magic) throw damaged(file, "is no part file, or cut short");
        if (digestOfFile() != std::string(trailer_.digest.begin(), trailer_.digest.end()))
            throw damaged(file, "is damaged: its checksum is not that of its content");
        const std::uint64_t end = size_ - sizeof trailer_;
        if (trailer_.headerOffset > end || trailer_.headerSize > end - trailer_.headerOffset)
            throw damaged(file, "is damaged: its header lies outside the file");
    }

    std::string header() {
        std::string text(trailer_.headerSize, '\0');
        stream_.seekg(static_cast<std::streamoff>(trailer_.headerOffset));
        read(text.data(), text.size());
        return text;
    }
    std::uint64_t bytesBehindHeader() const {
        return size_ - sizeof trailer_ - trailer_.headerOffset - trailer_.headerSize;
    }
    /// What follows what was read last.
    template <class T>
    void read(std::vector<T>& values, std::size_t count) {
        values.resize(count);
        read(values.data(), count * sizeof(T));
    }

private:
    void read(void* bytes, std::size_t size) {
        if (!stream_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(size)))
            throw damaged(file_, "cannot be read to its end");
    }
    std::string digestOfFile() {
        ByteHasher hasher;
        std::vector<char> block(std::size_t{1} << 20);
        stream_.seekg(0);
        for (std::uint64_t left = size_ - sizeof trailer_.digest; left > 0;) {
            const auto count =
                static_cast<std::size_t>(std::min<std::uint64_t>(left, block.size()));
            read(block.data(), count);
            hasher.add(block.data(), count);
            left -= count;
        }
        return hasher.digest();
    }

    fs::path file_;
    std::ifstream stream_;
    std::uint64_t size_ = 0;
    Trailer trailer_{};
};

/// Only a hostile part has others.
void requireFinite(const FilmState& state, const fs::path& file) {
    const auto isFinite = [](const auto& values) {
        return std::ranges::all_of(values, [](auto v) { return std::isfinite(v); });
    };
    const auto arePossible = [](const std::vector<ExactColor>& sums) {
        return std::ranges::all_of(sums, [](const ExactColor& s) { return s.isPossible(); });
    };
    // What is usable may add up to infinity; no more than that.
    const auto isSum = [](const SampleLight& sum) {
        const Vec3 light = sum.value();
        return light.x >= 0.0f && light.y >= 0.0f && light.z >= 0.0f;
    };
    if (!arePossible(state.colorSums) || !isFinite(state.layerSums.sums) ||
        !isFinite(state.layerSums.rests) || !std::ranges::all_of(state.sampleLight, isSum))
        throw damaged(file, "has sums that are not finite");
}

PartHeader readHeader(Reader& reader, const fs::path& file) {
    PartHeader header = parsePartHeader(reader.header(), file);
    if (bytesOfSums(header) != reader.bytesBehindHeader())
        throw damaged(file, "is damaged: its sums are not those of its header");
    return header;
}

std::string windowAsText(const FrameWindow& w) {
    return fmt::format("{},{},{},{} of {} × {}", w.x, w.y, w.width, w.height, w.fullWidth,
                       w.fullHeight);
}

}  // namespace

bool isPartFile(const fs::path& file) { return file.filename().string().ends_with(suffix); }

fs::path partFileFor(const fs::path& picture) {
    if (isPartFile(picture)) return picture;
    return picture.parent_path() / (picture.stem().string() + suffix);
}

fs::path previousPart(const fs::path& part) {
    const std::string name = part.filename().string();
    const std::string stem =
        isPartFile(part) ? name.substr(0, name.size() - std::strlen(suffix)) : part.stem().string();
    return part.parent_path() / (stem + ".part.old.exr");
}

void writePart(const fs::path& file, const PartInfo& info, const Film& film,
               const Metadata& metadata) {
    const FilmState& state = film.state();
    AtomicFile atomic(file);
    Writer writer(atomic);
    {
        const std::vector<unsigned char> picture =
            encodeExr(file, film.window(), film.channels(), metadata, ExrCompression::none);
        writer.write(picture);
    }
    Trailer trailer{magic, writer.size(), 0, {}};
    const std::string header =
        partHeaderText(info, state, {!state.extraSamples.empty(), !state.sampleLight.empty()});
    trailer.headerSize = header.size();
    writer.write(header.data(), header.size());
    writer.write(state.colorSums);
    writer.write(state.layerSums.sums);
    writer.write(state.layerSums.rests);
    writer.write(state.extraSamples);
    writer.write(state.sampleLight);
    writer.write(&trailer, sizeof trailer - sizeof trailer.digest);
    std::ranges::copy(writer.digest(), trailer.digest.begin());
    atomic.write(trailer.digest.data(), trailer.digest.size());
    atomic.commitKeeping(previousPart(file));
}

PartInfo readPartInfo(const fs::path& file) {
    Reader reader(file);
    return readHeader(reader, file).part.info;
}

Part readPart(const fs::path& file) {
    Reader reader(file);
    PartHeader header = readHeader(reader, file);
    FilmState& state = header.part.state;
    const FrameWindow& window = header.part.info.window;
    const std::size_t pixels =
        static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
    reader.read(state.colorSums, pixels);
    const std::size_t layerSums =
        pixels * static_cast<std::size_t>(Film::sumsPerPixel(header.part.info.layers));
    reader.read(state.layerSums.sums, layerSums);
    reader.read(state.layerSums.rests, layerSums);
    if (header.planes.extraSamples) reader.read(state.extraSamples, pixels);
    if (header.planes.sampleLight) reader.read(state.sampleLight, pixels);
    requireFinite(state, file);
    return std::move(header.part);
}

std::string differenceOf(const PartInfo& expected, const PartInfo& found) {
    const auto differ = [](const std::string& name, const std::string& wanted,
                           const std::string& is) {
        const auto orNone = [](const std::string& text) { return text.empty() ? "none" : text; };
        return fmt::format("{}: has {}, expected {}", name, orNone(is), orNone(wanted));
    };
    const auto &wanted = expected.madeFrom, &is = found.madeFrom;
    for (std::size_t i = 0; i < std::max(wanted.size(), is.size()); ++i) {
        if (i >= wanted.size()) return differ(is[i].first, "", is[i].second);
        if (i >= is.size()) return differ(wanted[i].first, wanted[i].second, "");
        if (wanted[i].first != is[i].first)
            return differ("made_from", wanted[i].first, is[i].first);
        if (wanted[i].second != is[i].second)
            return differ(wanted[i].first, wanted[i].second, is[i].second);
    }
    if (expected.window != found.window)
        return differ("window", windowAsText(expected.window), windowAsText(found.window));
    if (expected.layers != found.layers)
        return differ("layers", layersText(expected.layers), layersText(found.layers));
    const auto colorText = [](FilmColor color) { return color == FilmColor::rgb ? "RGB" : "XYZ"; };
    if (expected.color != found.color)
        return differ("color", colorText(expected.color), colorText(found.color));
    return {};
}

void mergePart(PartInfo& info, Film& film, const Part& part, const fs::path& file) {
    if (const std::string difference = differenceOf(info, part.info); !difference.empty())
        throw InputError(
            fmt::format("{}: is a part of another picture: {}", file.string(), difference));
    SampleRanges there = info.ranges, ranges = info.ranges;
    for (const std::uint32_t s : info.unfinishedSamples) there.add({s, s + 1});
    const auto claim = [&](SampleRange range) {
        if (const auto both = there.overlap(range))
            throw InputError(fmt::format("{}: its samples {} are in another part, too",
                                         file.string(), textOf(*both)));
        there.add(range);
    };
    for (const SampleRange& range : part.info.ranges.ranges()) {
        claim(range);
        ranges.add(range);
    }
    std::vector<std::uint32_t> unfinished;
    if (film.countsUnfinished(part.state)) unfinished = part.info.unfinishedSamples;
    for (const std::uint32_t s : unfinished) claim({s, s + 1});
    film.merge(part.state);
    info.ranges = std::move(ranges);
    info.unfinishedSamples.insert(info.unfinishedSamples.end(), unfinished.begin(),
                                  unfinished.end());
    std::ranges::sort(info.unfinishedSamples);
    info.seconds += part.info.seconds;
}

}  // namespace etendue
