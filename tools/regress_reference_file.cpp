// References as files: TOML, the pixels as base64.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "config/config.h"
#include "renderer/content_hash.h"
#include "tools/regress_reference.h"

namespace etendue {

namespace {

constexpr std::string_view digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// The upper 24 bits of each float, four digits a value: to one in 65,000.
std::string textOf(const Picture& pixels) {
    std::string text;
    text.reserve(4 * pixels.size());
    for (const float value : pixels) {
        const std::uint32_t bits = (std::bit_cast<std::uint32_t>(value) + 0x80u) >> 8;
        for (const int shift : {18, 12, 6, 0}) text += digits[(bits >> shift) & 63u];
    }
    return text;
}

/// Empty when it is not of `count` finite values.
std::optional<Picture> pixelsOf(const std::string& text, std::size_t count) {
    if (text.size() != 4 * count) return {};
    Picture pixels;
    pixels.reserve(count);
    for (std::size_t i = 0; i < text.size(); i += 4) {
        std::uint32_t bits = 0;
        for (std::size_t j = i; j < i + 4; ++j) {
            const std::size_t digit = digits.find(text[j]);
            if (digit == std::string_view::npos) return {};
            bits = (bits << 6) | static_cast<std::uint32_t>(digit);
        }
        pixels.push_back(std::bit_cast<float>(bits << 8));
        if (!std::isfinite(pixels.back())) return {};
    }
    return pixels;
}

/// Of all that a picture's verdicts depend on.
std::string bodyOf(const ReferencePicture& p) {
    std::string means;
    for (const std::vector<double>& batch : p.means)
        means += fmt::format("    [{:.9g}],\n", fmt::join(batch, ", "));
    return fmt::format(
        "estimator = \"{}\"\nby = \"{}\"\nleaves_out = {}\nsamples = {}\nlargest = {}\nnoise = {}\n"
        "means = [\n{}]\npixels = \"{}\"\n",
        p.estimator, p.by, p.leavesOut, p.samples, p.largest, p.noise, means, textOf(p.pixels));
}

ReferencePicture pictureIn(const ConfigTable& table, int width, int height) {
    ReferencePicture p;
    p.estimator = table.choice("estimator", estimatorKinds());
    p.by = table.choice("by", estimatorKinds());
    p.leavesOut = table.boolean("leaves_out", false);
    p.samples = static_cast<std::uint32_t>(table.integer("samples", {1, 1 << 24}));
    p.largest = table.number("largest", Range::nonNegative());
    p.noise = table.number("noise", Range::nonNegative());
    p.means = table.rows("means", 0, Range::any());
    if (p.means.size() < 2 || std::ranges::any_of(p.means, [&](const auto& batch) {
            return batch.empty() || batch.size() != p.means.front().size();
        }))
        table.fail("means", "expected two batches at least, of as many regions each");
    const auto pixels = pixelsOf(table.text("pixels"), 3 * static_cast<std::size_t>(width) *
                                                           static_cast<std::size_t>(height));
    if (!pixels) table.fail("pixels", "expected four base64 digits for each value of the picture");
    p.pixels = *pixels;
    if (table.text("hash") != contentHash({}, {bodyOf(p)}))
        table.fail("hash", "the picture is not the one that was written; make it again");
    table.finish();
    return p;
}

}  // namespace

std::filesystem::path referenceFile(const std::filesystem::path& folder, const std::string& scene,
                                    const std::string& camera) {
    return folder / fmt::format("{}.{}.toml", scene, camera);
}

RegressReference readReference(const std::filesystem::path& file) {
    const Config config = Config::load(file);
    const ConfigTable root = config.root();
    RegressReference reference;
    reference.scene = root.text("scene");
    reference.camera = root.text("camera");
    reference.sceneHash = root.text("scene_hash");
    reference.width = static_cast<int>(root.integer("width", {1, 4096}));
    reference.height = static_cast<int>(root.integer("height", {1, 4096}));
    for (const ConfigTable& table : root.tables("picture"))
        reference.pictures.push_back(pictureIn(table, reference.width, reference.height));
    root.finish();
    return reference;
}

std::string referenceText(const RegressReference& reference) {
    std::string text = fmt::format(
        "# What `etendue bench regress` holds pictures against; docs/regression.md. Made by\n"
        "# etendue bench regress {} --cameras {} --make-references\n"
        "scene = \"{}\"\ncamera = \"{}\"\nscene_hash = \"{}\"\nwidth = {}\nheight = {}\n",
        reference.scene, reference.camera, reference.scene, reference.camera, reference.sceneHash,
        reference.width, reference.height);
    for (ReferencePicture picture : reference.pictures) {
        // The hash is of what a reader finds.
        picture.pixels = pixelsOf(textOf(picture.pixels), picture.pixels.size()).value();
        const std::string body = bodyOf(picture);
        text += fmt::format("\n[[picture]]\n{}hash = \"{}\"\n", body, contentHash({}, {body}));
    }
    return text;
}

}  // namespace etendue
