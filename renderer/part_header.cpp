#include "renderer/part_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "config/config.h"
#include "renderer/image_check.h"

namespace etendue {

namespace {

constexpr int version = 5;
constexpr double mostCount = 0x1p62;

struct LayerName {
    const char* name;
    bool FilmLayers::*isWanted;
};
constexpr std::array layerNames{LayerName{"albedo", &FilmLayers::albedo},
                                LayerName{"normal", &FilmLayers::normal},
                                LayerName{"depth", &FilmLayers::depth},
                                LayerName{"position", &FilmLayers::position},
                                LayerName{"variance", &FilmLayers::variance},
                                LayerName{"luminance-variance", &FilmLayers::luminanceVariance}};

struct PlaneName {
    const char* name;
    bool PartPlanes::*isThere;
};
constexpr std::array planeNames{PlaneName{"extra-samples", &PartPlanes::extraSamples},
                                PlaneName{"sample-light", &PartPlanes::sampleLight}};

/// Metadata of a picture: a text, or so many numbers.
struct MetadataName {
    const char* name;
    std::size_t numbers;  // none: a text
};
constexpr std::array metadataNames{
    MetadataName{"etendue:scene", 0}, MetadataName{"etendue:estimator", 0},
    MetadataName{"worldToCamera", 16}, MetadataName{"aperture", 1}, MetadataName{"focus", 1}};

/// A TOML string. What is no UTF-8 is replaced: a part that cannot be read helps nobody.
std::string tomlString(std::string_view text) {
    std::string result = "\"";
    for (const char c : asUtf8(text)) {
        if (c == '"' || c == '\\')
            result += {'\\', c};
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            result += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else
            result += c;
    }
    return result + '"';
}

/// "[a, b]" of what `textOf` makes of each.
template <class Items, class TextOf>
std::string listOf(const Items& items, const TextOf& textOf) {
    std::string result;
    for (const auto& item : items)
        if (const std::string text = textOf(item); !text.empty())
            result += (result.empty() ? "" : ", ") + text;
    return '[' + result + ']';
}

template <class Named, std::size_t count, class Flags, class Member>
void setFlags(const ConfigTable& table, const char* key, const std::array<Named, count>& names,
              Member Named::*member, Flags& flags) {
    for (const std::string& text : table.texts(key)) {
        const auto found = std::ranges::find(names, text, &Named::name);
        if (found == names.end()) table.fail(key, fmt::format("\"{}\" is not known", text));
        flags.*((*found).*member) = true;
    }
}

std::string textOf(const MetadataValue& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return tomlString(*text);
    if (const auto* number = std::get_if<float>(&value)) return fmt::format("{}", *number);
    return listOf(std::get<std::vector<float>>(value),
                  [](float number) { return fmt::format("{}", number); });
}

Metadata parsePicture(const ConfigTable& table) {
    const Range any{-Range::infinity, Range::infinity};  // focus may be at infinity
    Metadata picture;
    for (const auto& [name, count] : metadataNames) {
        if (!table.has(name)) continue;
        if (count == 0) {
            picture[name] = table.text(name);
        } else if (count == 1) {
            picture[name] = static_cast<float>(table.number(name, any));
        } else {
            std::vector<float> numbers;
            for (const double number : table.numbers(name, count, any))
                numbers.push_back(static_cast<float>(number));
            picture[name] = std::move(numbers);
        }
    }
    return picture;
}

FrameWindow parseWindow(const ConfigTable& table) {
    const auto number = [&](const char* key, double lowest) {
        return static_cast<int>(table.integer(key, {lowest, double{largestImageSide}}));
    };
    const FrameWindow window{number("width", 1),      number("height", 1),
                             number("crop_x", 0),     number("crop_y", 0),
                             number("crop_width", 1), number("crop_height", 1)};
    if (window.x + window.width > window.fullWidth || window.y + window.height > window.fullHeight)
        table.fail("crop_width", "the crop lies outside the frame");
    return window;
}

void parseSamples(const ConfigTable& table, PartInfo& info, FilmState& state) {
    const Range index{0.0, 0x1p30};
    for (const std::vector<double>& row : table.rows("ranges", 2, index)) {
        const SampleRange range{static_cast<std::uint32_t>(row[0]),
                                static_cast<std::uint32_t>(row[1])};
        if (range.begin != row[0] || range.end != row[1] || range.begin >= range.end ||
            info.ranges.overlap(range))
            table.fail("ranges", "expected whole numbers, rising, of ranges that do not overlap");
        info.ranges.add(range);
    }
    state.samples = info.ranges.count();
    if (table.has("unfinished"))
        for (const double sample : table.numbers("unfinished", 0, index)) {
            const auto number = static_cast<std::uint32_t>(sample);
            if (number != sample || info.ranges.overlap({number, number + 1}))
                table.fail("unfinished", "expected numbers of samples that are in no range");
            info.unfinishedSamples.push_back(number);
        }
    const auto count = [&](const char* key) {
        return static_cast<std::uint64_t>(table.integer(key, {0.0, mostCount}));
    };
    state.unfinishedParts = count("unfinished_parts");
    state.badSamples = count("bad_samples");
    state.roundedTerms = count("rounded_terms");
    info.seconds = table.number("seconds", Range::nonNegative());
}

}  // namespace

std::string layersText(const FilmLayers& layers) {
    return listOf(layerNames, [&](const LayerName& l) {
        return layers.*l.isWanted ? tomlString(l.name) : std::string();
    });
}

std::uint64_t bytesOfSums(const PartHeader& header) {
    const PartInfo& info = header.part.info;
    const auto pixels = static_cast<std::uint64_t>(info.window.width) *
                        static_cast<std::uint64_t>(info.window.height);
    constexpr std::uint64_t perSum = sizeof(double) + sizeof(float);
    std::uint64_t perPixel =
        sizeof(ExactColor) + static_cast<std::uint64_t>(Film::sumsPerPixel(info.layers)) * perSum;
    if (header.planes.extraSamples) perPixel += sizeof(std::uint16_t);
    if (header.planes.sampleLight) perPixel += sizeof(SampleLight);
    return pixels * perPixel;
}

std::string partHeaderText(const PartInfo& info, const FilmState& state, PartPlanes planes) {
    const FrameWindow& w = info.window;
    std::string text = fmt::format(
        "[part]\nversion = {}\nranges = {}\nunfinished = {}\nunfinished_parts = {}\n"
        "bad_samples = {}\nrounded_terms = {}\nseconds = {}\nplanes = {}\n\n",
        version,
        listOf(info.ranges.ranges(),
               [](SampleRange r) { return fmt::format("[{}, {}]", r.begin, r.end); }),
        listOf(info.unfinishedSamples, [](std::uint32_t s) { return std::to_string(s); }),
        state.unfinishedParts, state.badSamples, state.roundedTerms,
        fmt::format("{:.6f}", info.seconds), listOf(planeNames, [&](const PlaneName& p) {
            return planes.*p.isThere ? tomlString(p.name) : std::string();
        }));
    text += fmt::format(
        "[film]\nwidth = {}\nheight = {}\ncrop_x = {}\ncrop_y = {}\ncrop_width = {}\n"
        "crop_height = {}\nlayers = {}\ncolor = {}\n\n[made_from]\n",
        w.fullWidth, w.fullHeight, w.x, w.y, w.width, w.height, layersText(info.layers),
        tomlString(info.color == FilmColor::xyz ? "xyz" : "rgb"));
    for (const auto& [name, value] : info.madeFrom)
        text += fmt::format("{} = {}\n", name, tomlString(value));
    text += "\n[picture]\n";
    for (const auto& [name, value] : info.picture)
        text += fmt::format("{} = {}\n", tomlString(name), textOf(value));
    return text;
}

PartHeader parsePartHeader(std::string_view text, const std::filesystem::path& file) {
    const Config config = Config::parse(text, file);
    const ConfigTable root = config.root();
    const ConfigTable part = root.table("part"), film = root.table("film"),
                      madeFrom = root.table("made_from"), picture = root.table("picture");
    PartHeader header;
    PartInfo& info = header.part.info;
    if (part.integer("version", {1, 1e6}) != version)
        part.fail("version", "this part was written by another version of the program");
    parseSamples(part, info, header.part.state);
    setFlags(part, "planes", planeNames, &PlaneName::isThere, header.planes);
    info.window = parseWindow(film);
    setFlags(film, "layers", layerNames, &LayerName::isWanted, info.layers);
    info.color = film.choice("color", {"rgb", "xyz"}) == "xyz" ? FilmColor::xyz : FilmColor::rgb;
    for (const std::string& key : madeFrom.keys())
        info.madeFrom.emplace_back(key, madeFrom.text(key));
    info.picture = parsePicture(picture);
    for (const ConfigTable& table : {part, film, madeFrom, picture, root}) table.finish();
    return header;
}

}  // namespace etendue
