// Texture: a colour or a scalar over a surface, constant or from an image.
#pragma once

#include <filesystem>
#include <memory>

#include "renderer/image_io.h"
#include "renderer/spectrum.h"
#include "renderer/vec.h"

namespace etendue {

enum class ColorEncoding { sRgb, linear };
enum class TextureWrap { repeat, clamp };

/// Bilinear, in linear light; texel centres at half-integers; v = 0 is the bottom edge. 8-bit
/// texels stay 8-bit in memory; copies share them. Any uv will do: a coordinate that is not finite
/// counts as 0.
class Texture {
public:
    /// A constant.
    explicit Texture(Spectrum value);
    /// `encoding` applies to images of 8- or 16-bit integers (Image::isEncoded) only, and never to
    /// alpha; float images are linear. `image` has 1 to 4 channels and at least one pixel.
    Texture(Image image, ColorEncoding encoding, TextureWrap wrap = TextureWrap::repeat);

    /// Colours of images have 0 in the last lane; grey ones are equal in the others.
    Spectrum color(Vec2 uv) const { return image_ ? imageColor(uv) : constant_; }
    /// Images with alpha: alpha; else the first channel, in the given encoding.
    float scalar(Vec2 uv) const;

    bool isConstant() const { return image_ == nullptr; }
    int width() const;  // 1 for a constant
    int height() const;
    /// One texel, decoded. 0 ≤ x < width, 0 ≤ y < height, y down from the top.
    Spectrum texel(int x, int y) const;
    /// The mean of the texels, summed in double: that of color() over the unit square, too.
    Spectrum average() const;

private:
    Spectrum imageColor(Vec2 uv) const;

    Spectrum constant_;
    std::shared_ptr<const Image> image_;
    ColorEncoding encoding_ = ColorEncoding::linear;
    TextureWrap wrap_ = TextureWrap::repeat;
};

}  // namespace etendue
