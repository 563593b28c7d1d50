#include "renderer/texture.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "renderer/srgb.h"

namespace etendue {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Floats = std::vector<float>;
using ByteTable = std::array<float, 256>;

ByteTable makeTable(ColorEncoding encoding) {
    ByteTable table;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double value = static_cast<double>(i) / 255.0;
        table[i] =
            static_cast<float>(encoding == ColorEncoding::sRgb ? linearFromSrgb(value) : value);
    }
    return table;
}

const ByteTable linearTable = makeTable(ColorEncoding::linear);
const ByteTable sRgbTable = makeTable(ColorEncoding::sRgb);

const ByteTable& tableOf(ColorEncoding encoding) {
    return encoding == ColorEncoding::sRgb ? sRgbTable : linearTable;
}

bool hasAlpha(const Image& image) { return image.channels == 2 || image.channels == 4; }

std::size_t texelCount(const Image& image) {
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

/// Where a texel's first channel lies.
std::size_t texelOffset(const Image& image, int x, int y) {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
            static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(image.channels);
}

/// Colours of a 16-bit image once and for all, so that float pixels are always linear.
void decodeFloats(Image& image) {
    Floats& values = std::get<Floats>(image.pixels);
    const int colors = hasAlpha(image) ? image.channels - 1 : image.channels;
    for (auto texel = values.begin(); texel != values.end(); texel += image.channels)
        for (int c = 0; c < colors; ++c) texel[c] = static_cast<float>(linearFromSrgb(texel[c]));
    image.isEncoded = false;
}

/// The texels on either side of a coordinate, along one axis, and the weight of the second.
struct Neighbors {
    int first, second;
    float weight;
};

// Inline: at -O2 gcc otherwise returns the struct through memory, at 15 ns a lookup.
inline Neighbors neighbors(float coordinate, int size, TextureWrap wrap) {
    if (!std::isfinite(coordinate)) coordinate = 0.0f;
    const bool repeats = wrap == TextureWrap::repeat;
    const float unit =
        repeats ? coordinate - std::floor(coordinate) : std::clamp(coordinate, 0.0f, 1.0f);
    const float x = unit * static_cast<float>(size) - 0.5f;
    const float below = std::floor(x);  // -1 to size - 1
    Neighbors result{static_cast<int>(below), static_cast<int>(below) + 1, x - below};
    if (result.first < 0) result.first = repeats ? size - 1 : 0;
    if (result.second >= size) result.second = repeats ? 0 : size - 1;
    return result;
}

/// The four texels around a point, by the places of their first channels, and their weights.
struct Footprint {
    std::array<std::size_t, 4> offset;
    std::array<float, 4> weight;
};

Footprint footprint(Vec2 uv, const Image& image, TextureWrap wrap) {
    const Neighbors column = neighbors(uv.x, image.width, wrap);
    const Neighbors row = neighbors(uv.y, image.height, wrap);
    const int first = image.height - 1 - row.first;  // counted from the top
    const int second = image.height - 1 - row.second;
    return {{texelOffset(image, column.first, first), texelOffset(image, column.second, first),
             texelOffset(image, column.first, second), texelOffset(image, column.second, second)},
            {(1.0f - column.weight) * (1.0f - row.weight), column.weight * (1.0f - row.weight),
             (1.0f - column.weight) * row.weight, column.weight * row.weight}};
}

float interpolate(const Image& image, const ByteTable& table, const Footprint& at,
                  std::size_t channel) {
    float sum = 0.0f;
    if (const auto* bytes = std::get_if<Bytes>(&image.pixels)) {
        for (std::size_t i = 0; i < 4; ++i)
            sum += at.weight[i] * table[(*bytes)[at.offset[i] + channel]];
    } else {
        const Floats& values = *std::get_if<Floats>(&image.pixels);
        for (std::size_t i = 0; i < 4; ++i) sum += at.weight[i] * values[at.offset[i] + channel];
    }
    return sum;
}

/// Distance between a texel's channels R, G and B; a grey one serves for all three.
std::size_t colorStep(const Image& image) { return image.channels < 3 ? 0 : 1; }

}  // namespace

Texture::Texture(Spectrum value) : constant_(value) {}

Texture::Texture(Image image, ColorEncoding encoding, TextureWrap wrap)
    : encoding_(encoding), wrap_(wrap) {
    assert(image.width > 0 && image.height > 0 && image.channels > 0 && image.channels <= 4);
    assert(std::visit([](const auto& pixels) { return pixels.size(); }, image.pixels) ==
           texelCount(image) * static_cast<std::size_t>(image.channels));
    if (image.isEncoded && encoding == ColorEncoding::sRgb) decodeFloats(image);
    image_ = std::make_shared<const Image>(std::move(image));
}

int Texture::width() const { return image_ ? image_->width : 1; }
int Texture::height() const { return image_ ? image_->height : 1; }

Spectrum Texture::texel(int x, int y) const {
    if (!image_) return constant_;
    const std::size_t offset = texelOffset(*image_, x, y);
    const std::size_t step = colorStep(*image_);
    if (const auto* bytes = std::get_if<Bytes>(&image_->pixels)) {
        const ByteTable& table = tableOf(encoding_);
        const std::uint8_t* byte = bytes->data() + offset;
        return rgb(table[byte[0]], table[byte[step]], table[byte[2 * step]]);
    }
    const float* value = std::get<Floats>(image_->pixels).data() + offset;
    return rgb(value[0], value[step], value[2 * step]);
}

Spectrum Texture::imageColor(Vec2 uv) const {
    const Footprint at = footprint(uv, *image_, wrap_);
    const ByteTable& table = tableOf(encoding_);
    const std::size_t step = colorStep(*image_);
    return rgb(interpolate(*image_, table, at, 0), interpolate(*image_, table, at, step),
               interpolate(*image_, table, at, 2 * step));
}

float Texture::scalar(Vec2 uv) const {
    if (!image_) return constant_[0];
    const Footprint at = footprint(uv, *image_, wrap_);
    if (hasAlpha(*image_))
        return interpolate(*image_, linearTable, at,
                           static_cast<std::size_t>(image_->channels) - 1);
    return interpolate(*image_, tableOf(encoding_), at, 0);
}

Spectrum Texture::average() const {
    if (!image_) return constant_;
    std::array<double, 3> sum{};
    for (int y = 0; y < height(); ++y)
        for (int x = 0; x < width(); ++x) {
            const Spectrum value = texel(x, y);
            for (int c = 0; c < 3; ++c) sum[static_cast<std::size_t>(c)] += value[c];
        }
    const auto count = static_cast<double>(texelCount(*image_));
    return rgb(static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count),
               static_cast<float>(sum[2] / count));
}

}  // namespace etendue
