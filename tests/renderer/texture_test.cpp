#include "renderer/texture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

using namespace etendue;

namespace {

using Floats = std::vector<float>;
using ByteValues = std::vector<std::uint8_t>;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

/// Uniform in [0, 1].
Image randomImage(int width, int height, int channels) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform;
    Floats pixels(static_cast<std::size_t>(width * height * channels));
    for (float& value : pixels) value = uniform(random);
    return {width, height, channels, pixels};
}

Image row(ByteValues pixels, int channels) {
    return {static_cast<int>(pixels.size()) / channels, 1, channels, std::move(pixels)};
}

Vec2 centerOf(int x, int y, const Texture& texture) {
    return {(static_cast<float>(x) + 0.5f) / static_cast<float>(texture.width()),
            1.0f - (static_cast<float>(y) + 0.5f) / static_cast<float>(texture.height())};
}

/// Bilinear interpolation as a sum of tents over all texels of the plane that can matter: the image
/// repeated three times each way, or its edge texels continued. `uv` in [-1, 2]².
double sumOfTents(const Texture& texture, TextureWrap wrap, Vec2 uv) {
    const int width = texture.width(), height = texture.height();
    double u = uv.x, v = uv.y;
    if (wrap == TextureWrap::clamp) {
        u = std::clamp(u, 0.0, 1.0);
        v = std::clamp(v, 0.0, 1.0);
    }
    const double atX = u * width, atY = (1.0 - v) * height;
    const auto wrapped = [wrap](int i, int size) {
        return wrap == TextureWrap::repeat ? (i + 4 * size) % size : std::clamp(i, 0, size - 1);
    };
    const auto tent = [](double d) { return std::max(0.0, 1.0 - std::abs(d)); };
    double sum = 0.0;
    for (int y = -2 * height; y < 3 * height; ++y)
        for (int x = -2 * width; x < 3 * width; ++x) {
            const double weight = tent(atX - x - 0.5) * tent(atY - y - 0.5);
            if (weight > 0.0)
                sum += weight * texture.texel(wrapped(x, width), wrapped(y, height))[0];
        }
    return sum;
}

}  // namespace

TEST_CASE("Texture: a constant is the same everywhere") {
    const Spectrum value(0.1f, 0.2f, 0.3f, 0.4f);
    const Texture texture(value);
    CHECK(texture.isConstant());
    CHECK(texture.width() == 1);
    CHECK(texture.height() == 1);
    CHECK(texture.color({0.3f, -7.0f}) == value);
    CHECK(texture.color({notANumber, infinity}) == value);
    CHECK(texture.texel(0, 0) == value);
    CHECK(texture.average() == value);
    CHECK(texture.scalar({0.3f, 0.7f}) == 0.1f);
}

TEST_CASE("Texture: at texel centres it is the texel, v upwards") {
    const Image image = randomImage(4, 8, 3);
    const Floats pixels = std::get<Floats>(image.pixels);
    const Texture texture(image, ColorEncoding::linear);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 4; ++x) {
            const std::size_t at = static_cast<std::size_t>(y * 4 + x) * 3;
            const Spectrum texel = rgb(pixels[at], pixels[at + 1], pixels[at + 2]);
            CHECK(texture.texel(x, y) == texel);
            // Exact, since halves and quarters are: all weight is on one texel.
            CHECK(texture.color(centerOf(x, y, texture)) == texel);
            CHECK(texture.scalar(centerOf(x, y, texture)) == texel[0]);
        }
}

TEST_CASE("Texture: between texel centres it is bilinear, across the seam too") {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(-1.0f, 2.0f);
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::clamp}) {
        const Texture texture(randomImage(5, 3, 3), ColorEncoding::linear, wrap);
        for (int i = 0; i < 500; ++i) {
            const Vec2 uv{uniform(random), uniform(random)};
            // The coordinate is rounded three times (wrapping, scaling, subtracting) by at most
            // 2^-24 of a value below 5, and moves the result by at most 1 a texel on each axis;
            // weights and sums of values up to 1 round fewer than 16 times.
            const double tolerance = 2 * 3 * 5 * 0x1p-24 + 16 * 0x1p-24;
            CHECK(std::abs(texture.color(uv)[0] - sumOfTents(texture, wrap, uv)) <= tolerance);
            CHECK(texture.scalar(uv) == texture.color(uv)[0]);
        }
    }
}

TEST_CASE("Texture: repeat joins the edges, clamp continues them") {
    const Image image{2, 2, 1, Floats{1, 2, 3, 4}};  // 1 2 above 3 4
    const Texture repeated(image, ColorEncoding::linear, TextureWrap::repeat);
    const Texture clamped(image, ColorEncoding::linear, TextureWrap::clamp);
    CHECK(repeated.scalar({0.0f, 0.75f}) == 1.5f);
    CHECK(repeated.scalar({1.0f, 0.75f}) == 1.5f);
    CHECK(repeated.scalar({0.25f, 0.0f}) == 2.0f);
    CHECK(repeated.scalar({0.0f, 0.0f}) == 2.5f);
    CHECK(clamped.scalar({0.0f, 0.75f}) == 1.0f);
    CHECK(clamped.scalar({1.0f, 0.75f}) == 2.0f);
    CHECK(clamped.scalar({0.25f, 0.0f}) == 3.0f);
    CHECK(clamped.scalar({5.0f, -5.0f}) == 4.0f);
    CHECK(clamped.scalar({-5.0f, 5.0f}) == 1.0f);
}

TEST_CASE("Texture: repeat has period 1") {
    const Texture texture(randomImage(4, 4, 3), ColorEncoding::linear);
    for (const float u : {0.0f, 0.125f, 0.375f, 0.6875f})
        for (const float shift : {-100'000.0f, -3.0f, -1.0f, 1.0f, 2.0f, 65536.0f}) {
            // Sixteenths of such numbers are exact in float.
            CHECK(texture.color({u + shift, 0.3125f}) == texture.color({u, 0.3125f}));
            CHECK(texture.color({0.3125f, u + shift}) == texture.color({0.3125f, u}));
        }
}

TEST_CASE("Texture: any uv gives a value between the texels; one that is not finite counts as 0") {
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::clamp}) {
        const Texture texture(randomImage(7, 5, 4), ColorEncoding::linear, wrap);
        const float odd[] = {1e9f,     -1e9f,     3e38f,       -3e38f,      1e-45f,
                             -1e-45f,  -1e-9f,    0.99999994f, 1.0f,        -0.0f,
                             infinity, -infinity, notANumber,  -0.99999994f};
        for (const float u : odd)
            for (const float v : odd) {
                const Spectrum color = texture.color({u, v});
                CHECK(isFinite(color));
                CHECK(maxLane(color) <= 1.0f + 0x1p-21f);  // rounding of weights that sum to 1
                CHECK(std::min({color[0], color[1], color[2]}) >= 0.0f);
                CHECK(color[3] == 0.0f);
                const Vec2 counted{std::isfinite(u) ? u : 0.0f, std::isfinite(v) ? v : 0.0f};
                CHECK(color == texture.color(counted));
                CHECK(texture.scalar({u, v}) == texture.scalar(counted));
            }
    }
}

TEST_CASE("Texture: sRGB bytes decode by the inverse of the sRGB encoding") {
    ByteValues all(256);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);
    const Texture texture(row(all, 1), ColorEncoding::sRgb);
    for (int i = 0; i < 256; ++i) {
        const double linear = texture.texel(i, 0)[0];
        const double encoded =
            linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
        // The standard rounds its constants: where its two pieces meet they differ by 3e-8.
        // Float rounds `linear` by 2^-24 of it, which the encoding does not magnify.
        CHECK(std::abs(encoded - i / 255.0) <= 1e-7);
    }
    CHECK(texture.texel(0, 0)[0] == 0.0f);
    CHECK(texture.texel(255, 0)[0] == 1.0f);
}

TEST_CASE("Texture: linear bytes are 255ths") {
    const Texture texture(row({0, 51, 255}, 1), ColorEncoding::linear);
    CHECK(texture.texel(0, 0) == rgb(0.0f, 0.0f, 0.0f));
    CHECK(texture.texel(1, 0) == rgb(0.2f, 0.2f, 0.2f));
    CHECK(texture.texel(2, 0) == rgb(1.0f, 1.0f, 1.0f));
}

TEST_CASE("Texture: halfway from black to white is half the light, whatever the encoding") {
    for (const ColorEncoding encoding : {ColorEncoding::sRgb, ColorEncoding::linear}) {
        const Texture texture(row({0, 0, 0, 255, 255, 255}, 3), encoding, TextureWrap::clamp);
        CHECK(texture.color({0.5f, 0.5f}) == rgb(0.5f, 0.5f, 0.5f));
    }
}

TEST_CASE("Texture: 16-bit integers are decoded as bytes are, light itself is not") {
    const Floats pixels{0.2f, 0.6f, 0.8f, 0.4f};
    const Image light{1, 1, 4, pixels};
    const Image encoded{1, 1, 4, pixels, true};
    const Texture bytes(row({51, 153, 204, 102}, 4), ColorEncoding::sRgb);

    CHECK(Texture(light, ColorEncoding::sRgb).texel(0, 0) == rgb(0.2f, 0.6f, 0.8f));
    CHECK(Texture(encoded, ColorEncoding::linear).texel(0, 0) == rgb(0.2f, 0.6f, 0.8f));
    const Texture decoded(encoded, ColorEncoding::sRgb);
    for (int c = 0; c < 3; ++c) {
        const float expected = bytes.texel(0, 0)[c];
        // 0.2f is not 51/255: half an ulp, which the power 2.4 magnifies less than fourfold.
        CHECK(std::abs(decoded.texel(0, 0)[c] - expected) <= expected * 0x1p-22f);
    }
    CHECK(decoded.scalar({0.5f, 0.5f}) == 0.4f);  // alpha is never encoded
}

TEST_CASE("Texture: a scalar is the alpha, or for want of one the first channel, decoded") {
    const Vec2 anywhere{0.3f, 0.6f};
    for (const ColorEncoding encoding : {ColorEncoding::sRgb, ColorEncoding::linear}) {
        const auto scalar = [&](const ByteValues& texel) {
            return Texture(row(texel, static_cast<int>(texel.size())), encoding).scalar(anywhere);
        };
        // sRGB 188 is the byte nearest to half the light: ((188/255 + 0.055)/1.055)^2.4.
        const double first = encoding == ColorEncoding::sRgb ? 0.502886458 : 188 / 255.0;
        const double tolerance = 8 * 0x1p-24;  // the sum of four weighted texels
        CHECK(std::abs(scalar({188}) - first) <= tolerance);
        CHECK(std::abs(scalar({188, 10, 20}) - first) <= tolerance);
        CHECK(std::abs(scalar({10, 188}) - 188 / 255.0) <= tolerance);
        CHECK(std::abs(scalar({10, 20, 30, 188}) - 188 / 255.0) <= tolerance);
    }
}

TEST_CASE("Texture: grey is the same in every colour, and alpha is no colour") {
    CHECK(Texture(row({51, 255}, 2), ColorEncoding::linear).texel(0, 0) == rgb(0.2f, 0.2f, 0.2f));
    CHECK(Texture(row({51, 102, 255, 0}, 4), ColorEncoding::linear).texel(0, 0) ==
          rgb(0.2f, 0.4f, 1.0f));
    const Texture grey(row({0, 255, 102, 255}, 2), ColorEncoding::linear);
    const Spectrum color = grey.color({0.6f, 0.5f});
    CHECK(color[0] > 0.0f);
    CHECK(color == rgb(color[0], color[0], color[0]));
}

TEST_CASE("Texture: the average of the texels is that of the surface") {
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::clamp}) {
        const Texture texture(randomImage(6, 3, 3), ColorEncoding::linear, wrap);
        // Bilinear within cells of half a texel, where the midpoint rule is exact.
        double sum = 0.0;
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 12; ++x)
                sum += texture.color({(static_cast<float>(x) + 0.5f) / 12.0f,
                                      (static_cast<float>(y) + 0.5f) / 6.0f})[1];
        const double rounding = (2 * 3 * 6 + 16) * 0x1p-24;  // of each lookup, as above
        CHECK(std::abs(sum / 72.0 - texture.average()[1]) <= rounding);
        CHECK(texture.average()[3] == 0.0f);
    }
}

TEST_CASE("Texture: the average of a million texels does not drift") {
    const Texture texture({1024, 1024, 1, Floats(std::size_t{1} << 20, 0.1f)},
                          ColorEncoding::linear);
    CHECK(texture.average() == rgb(0.1f, 0.1f, 0.1f));
}

TEST_CASE("Texture: copies and moves look the same") {
    const Texture texture(randomImage(4, 4, 3), ColorEncoding::linear, TextureWrap::clamp);
    Texture copy = texture;
    CHECK(copy.color({0.9f, 1.3f}) == texture.color({0.9f, 1.3f}));
    const Texture moved = std::move(copy);
    CHECK(moved.color({0.9f, 1.3f}) == texture.color({0.9f, 1.3f}));
    CHECK(sizeof(Texture) <= 64);
}
