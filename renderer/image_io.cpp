#include "renderer/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <functional>
#include <memory>
#include <new>
#include <set>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include "config/config.h"
#include "renderer/image_check.h"

namespace etendue {
namespace {

using Bytes = std::vector<unsigned char>;

/// Once per process, before the first use. The renderer's own threads are all there should be.
void setUpOpenImageIo() {
    static const bool isDone = [] {
        OIIO::attribute("threads", 1);
        OIIO::attribute("exr_threads", -1);  // none but the caller
        OIIO::attribute("debug", 0);         // no remarks on stderr, whatever the build
        return true;
    }();
    static_cast<void>(isDone);
}

InputError unreadable(const std::filesystem::path& file, std::string reason) {
    // Readers quote damaged bytes.
    std::ranges::replace_if(
        reason, [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    return InputError(file.string() + ": " + reason);
}

/// OpenImageIO's name for the format that the file's extension stands for.
const char* formatOf(const std::filesystem::path& file) {
    struct Format {
        const char *extension, *name;
    };
    static constexpr std::array formats{
        Format{".exr", "openexr"}, Format{".hdr", "hdr"},   Format{".png", "png"},
        Format{".jpg", "jpeg"},    Format{".jpeg", "jpeg"}, Format{".tif", "tiff"},
        Format{".tiff", "tiff"},   Format{".tga", "targa"}, Format{".bmp", "bmp"}};
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto* format = std::ranges::find(formats, extension, &Format::extension);
    if (format == formats.end())
        throw unreadable(
            file, "unknown image format, expected .exr, .hdr, .png, .jpg, .tif, .tga or .bmp");
    return format->name;
}

Bytes readBytes(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) throw missingFileError(file);
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw missingFileError(file);
    Bytes bytes(std::filesystem::file_size(file));
    const auto size = static_cast<std::streamsize>(bytes.size());
    if (!stream.read(reinterpret_cast<char*>(bytes.data()), size))
        throw unreadable(file, "cannot be read to its end");
    return bytes;
}

/// A reader tells of damage that it survives (a JPEG that ends early) by a pending message alone.
void requireSuccess(bool isGood, OIIO::ImageInput& input, const std::filesystem::path& file) {
    const std::string reason = input.geterror();
    if (!isGood || !reason.empty())
        throw unreadable(file, reason.empty() ? "cannot be decoded" : reason);
}

/// Throws for what no Image can hold, before memory is asked for.
void checkSize(const OIIO::ImageSpec& spec, std::size_t fileSize,
               const std::filesystem::path& file) {
    const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height);
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
        throw unreadable(file, "has no pixels (" + size + ")");
    if (std::max(spec.width, spec.height) > largestImageSide)
        throw unreadable(file, sizeFault(spec.width, spec.height));
    if (spec.deep || spec.depth > 1)
        throw unreadable(file, "is a deep or volume image, expected a flat one");
    // The densest coding (constant blocks of an EXR, deflated) packs some 70,000 bytes into one.
    if (spec.image_bytes() / 100'000 > fileSize)
        throw unreadable(file, "truncated: too short for " + size + " pixels");
}

/// The channels of an Image, in its order.
std::vector<int> channelsToRead(const OIIO::ImageSpec& spec, const std::filesystem::path& file) {
    if (spec.nchannels == 1) return {0};
    std::vector<int> channels{spec.channelindex("R"), spec.channelindex("G"),
                              spec.channelindex("B")};
    int alpha = spec.channelindex("A");
    if (std::ranges::min(channels) < 0) {
        alpha = spec.alpha_channel;
        channels.clear();
        for (int c = 0; c < spec.nchannels; ++c)
            if (c != alpha) channels.push_back(c);
    }
    const bool isLuminanceAndChroma = spec.channelindex("RY") >= 0;
    if ((channels.size() != 1 && channels.size() != 3) || isLuminanceAndChroma)
        throw unreadable(file, "has " + std::to_string(spec.nchannels) +
                                   " channels, expected grey or R, G, B, with or without A");
    if (alpha >= 0) channels.push_back(alpha);
    return channels;
}

template <class T>
std::vector<T> readPixels(OIIO::ImageInput& input, const std::vector<int>& channels,
                          const std::filesystem::path& file) {
    const OIIO::ImageSpec& spec = input.spec();
    const auto [first, last] = std::ranges::minmax(channels);
    const auto span = static_cast<std::size_t>(last - first) + 1;
    std::vector<T> pixels(spec.image_pixels() * span);
    const bool isRead =
        input.read_image(0, 0, first, last + 1, OIIO::BaseTypeFromC<T>::value, pixels.data());
    requireSuccess(isRead, input, file);
    if (span == channels.size() && std::ranges::is_sorted(channels)) return pixels;

    std::vector<T> chosen;
    chosen.reserve(spec.image_pixels() * channels.size());
    for (std::size_t pixel = 0; pixel < spec.image_pixels(); ++pixel)
        for (const int c : channels)
            chosen.push_back(pixels[pixel * span + static_cast<std::size_t>(c - first)]);
    return chosen;
}

void requireFinite(const std::vector<float>& pixels, int channels, int width,
                   const std::filesystem::path& file) {
    const auto bad = std::ranges::find_if_not(pixels, [](float v) { return std::isfinite(v); });
    if (bad == pixels.end()) return;
    const auto pixel = (bad - pixels.begin()) / channels;
    throw unreadable(file, "pixel " + std::to_string(pixel % width) + ", " +
                               std::to_string(pixel / width) +
                               " is NaN or infinite, expected finite numbers");
}

/// A file, open for reading. The reader keeps where the bytes are.
class OpenFile {
public:
    explicit OpenFile(const std::filesystem::path& file)
        : bytes_(readBytes(file)), memory_(bytes_.data(), bytes_.size()) {
        const std::string format = formatOf(file);
        const std::string fault = format == "png"       ? pngFault(bytes_)
                                  : format == "openexr" ? exrFault(bytes_)
                                                        : std::string();
        if (!fault.empty()) throw unreadable(file, fault);
        input_ = OIIO::ImageInput::create(format);
        if (!input_) throw unreadable(file, OIIO::geterror());
        OIIO::ImageSpec asStored, spec;
        asStored.attribute("oiio:UnassociatedAlpha", 1);
        const bool canRead = input_->set_ioproxy(&memory_);
        requireSuccess(canRead && input_->open(file.filename().string(), spec, asStored), *input_,
                       file);
        checkSize(spec, bytes_.size(), file);
    }
    OIIO::ImageInput& input() { return *input_; }

private:
    Bytes bytes_;
    OIIO::Filesystem::IOMemReader memory_;
    std::unique_ptr<OIIO::ImageInput> input_;
};

Image decode(OIIO::ImageInput& input, const std::filesystem::path& file) {
    const OIIO::ImageSpec& spec = input.spec();
    const std::vector<int> channels = channelsToRead(spec, file);
    Image image{spec.width, spec.height, static_cast<int>(channels.size()), {}};
    const OIIO::TypeDesc type = spec.channelformat(channels.front());
    switch (type.basetype) {
        case OIIO::TypeDesc::UINT8:
            image.pixels = readPixels<std::uint8_t>(input, channels, file);
            return image;
        case OIIO::TypeDesc::UINT16:
        case OIIO::TypeDesc::HALF:
        case OIIO::TypeDesc::FLOAT:
        case OIIO::TypeDesc::DOUBLE: {
            auto pixels = readPixels<float>(input, channels, file);
            requireFinite(pixels, image.channels, image.width, file);
            image.pixels = std::move(pixels);
            image.isEncoded = type == OIIO::TypeUInt16;
            return image;
        }
        default:
            throw unreadable(file, std::string("has ") + type.c_str() +
                                       " pixels, expected float or 8- or 16-bit integers");
    }
}

/// Whatever goes wrong while a file is read is the file's fault.
template <class Read>
auto blamingFile(const std::filesystem::path& file, const Read& read) {
    setUpOpenImageIo();
    try {
        return read();
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw unreadable(file, "is too large for the memory of this machine");
    } catch (const std::exception& error) {
        throw unreadable(file, error.what());
    }
}

/// The bytes of an image file; row(y) is the y-th row of `spec.format`, valid until the next call.
Bytes encode(const char* format, const OIIO::ImageSpec& spec, const std::filesystem::path& file,
             const std::function<const void*(int)>& row) {
    setUpOpenImageIo();
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) throw std::runtime_error(file.string() + ": " + OIIO::geterror());
    Bytes bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    bool isGood = output->set_ioproxy(&memory) && output->open(file.filename().string(), spec);
    for (int y = 0; isGood && y < spec.height; ++y)
        isGood = output->write_scanline(spec.y + y, 0, spec.format, row(y));
    isGood = isGood && output->close();
    const std::string reason = output->geterror();
    if (!isGood) throw std::runtime_error(file.string() + ": cannot encode: " + reason);
    return bytes;
}

void setMetadata(OIIO::ImageSpec& spec, const std::string& name, const MetadataValue& value) {
    const auto set = [&](const auto& v) {
        if constexpr (std::is_same_v<decltype(v), const std::vector<float>&>) {
            if (v.empty()) throw std::invalid_argument("metadata \"" + name + "\" is empty");
            const OIIO::TypeDesc array(OIIO::TypeDesc::FLOAT, static_cast<int>(v.size()));
            spec.attribute(name, array, v.data());
        } else {
            spec.attribute(name, v);
        }
    };
    std::visit(set, value);
}

OIIO::ImageSpec exrSpec(const FrameWindow& window, const std::vector<ExrChannels>& layers,
                        const Metadata& metadata) {
    OIIO::ImageSpec spec(window.width, window.height, 0, OIIO::TypeFloat);
    spec.x = window.x;
    spec.y = window.y;
    spec.full_width = window.fullWidth;
    spec.full_height = window.fullHeight;
    for (const ExrChannels& layer : layers)
        spec.channelnames.insert(spec.channelnames.end(), layer.names.begin(), layer.names.end());
    spec.nchannels = static_cast<int>(spec.channelnames.size());
    for (const auto& [name, value] : metadata) setMetadata(spec, name, value);
    // OpenImageIO adds the time of writing unless it finds a date; one that is no text it drops.
    spec.attribute("DateTime", 0);
    return spec;
}

/// Throws std::invalid_argument for what writeExr cannot write.
void checkLayers(const FrameWindow& window, const std::vector<ExrChannels>& layers) {
    if (window.x < 0 || window.y < 0 || window.width < 1 || window.height < 1 ||
        window.width > window.fullWidth - window.x || window.height > window.fullHeight - window.y)
        throw std::invalid_argument("EXR data window outside the frame");
    const auto pixelCount =
        static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
    std::set<std::string> names;
    for (const ExrChannels& layer : layers) {
        if (layer.pixels.size() != pixelCount * layer.names.size())
            throw std::invalid_argument("EXR layer of the wrong size");
        for (const std::string& name : layer.names)
            if (name.empty() || !names.insert(name).second)
                throw std::invalid_argument("EXR channel without a name of its own: " + name);
    }
    if (names.empty()) throw std::invalid_argument("EXR without channels");
}

/// OpenEXR's name of the type that a value gets.
std::string exrType(const MetadataValue& value) {
    if (std::holds_alternative<int>(value)) return "int";
    if (std::holds_alternative<float>(value)) return "float";
    if (std::holds_alternative<std::string>(value)) return "string";
    switch (std::get<std::vector<float>>(value).size()) {
        case 2:
            return "v2f";
        case 3:
            return "v3f";
        case 9:
            return "m33f";
        case 16:
            return "m44f";
        default:
            return "floatvector";
    }
}

/// Throws std::invalid_argument for the first value that the encoded file lacks: OpenEXR has uses
/// of its own for some names ("name", "type", "tiles"), which OpenImageIO drops in silence.
void checkMetadata(const Bytes& exr, const Metadata& metadata) {
    const std::string_view bytes(reinterpret_cast<const char*>(exr.data()), exr.size());
    for (const auto& [name, value] : metadata) {
        const std::string entry = name + '\0' + exrType(value) + '\0';
        if (bytes.find(entry) == bytes.npos)
            throw std::invalid_argument("an EXR cannot hold \"" + name + "\" as " + exrType(value));
    }
}

}  // namespace

Image readImage(const std::filesystem::path& file) {
    return blamingFile(file, [&] {
        OpenFile open(file);
        return decode(open.input(), file);
    });
}

std::optional<ExrChannels> readExrChannels(const std::filesystem::path& file,
                                           const std::vector<std::string>& names) {
    return blamingFile(file, [&]() -> std::optional<ExrChannels> {
        OpenFile open(file);
        const OIIO::ImageSpec& spec = open.input().spec();
        std::vector<int> channels;
        for (const std::string& name : names) channels.push_back(spec.channelindex(name));
        if (std::ranges::min(channels) < 0) return std::nullopt;
        ExrChannels result{names, readPixels<float>(open.input(), channels, file)};
        requireFinite(result.pixels, static_cast<int>(names.size()), spec.width, file);
        return result;
    });
}

std::optional<FrameWindow> readExrWindow(const std::filesystem::path& file) {
    return blamingFile(file, [&]() -> std::optional<FrameWindow> {
        OpenFile open(file);
        if (std::string_view(open.input().format_name()) != "openexr") return std::nullopt;
        const OIIO::ImageSpec& spec = open.input().spec();
        return FrameWindow{spec.full_width, spec.full_height, spec.x,
                           spec.y,          spec.width,       spec.height};
    });
}

Bytes encodeExr(const std::filesystem::path& file, const FrameWindow& window,
                const std::vector<ExrChannels>& layers, const Metadata& metadata,
                ExrCompression compression) {
    checkLayers(window, layers);
    OIIO::ImageSpec spec = exrSpec(window, layers, metadata);
    spec.attribute("compression", compression == ExrCompression::zip ? "zip" : "none");
    const auto width = static_cast<std::size_t>(window.width);
    std::vector<float> row(width * static_cast<std::size_t>(spec.nchannels));
    const auto interleave = [&](int y) -> const void* {
        auto out = row.begin();
        for (std::size_t x = 0; x < width; ++x)
            for (const ExrChannels& layer : layers) {
                const std::size_t count = layer.names.size();
                const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
                out = std::copy_n(layer.pixels.data() + pixel * count, count, out);
            }
        return row.data();
    };
    Bytes bytes = encode("openexr", spec, file, interleave);
    checkMetadata(bytes, metadata);
    return bytes;
}

void writeExr(const std::filesystem::path& file, const FrameWindow& window,
              const std::vector<ExrChannels>& layers, const Metadata& metadata) {
    const Bytes bytes = encodeExr(file, window, layers, metadata);
    writeFileAtomically(file, bytes.data(), bytes.size());
}

void writePng(const std::filesystem::path& file, int width, int height,
              const std::vector<std::uint8_t>& pixels) {
    if (width < 1 || height < 1 ||
        pixels.size() !=
            std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
        throw std::invalid_argument("PNG pixels of the wrong size");
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    const Bytes bytes = encode("png", spec, file, [&](int y) -> const void* {
        return pixels.data() +
               std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(y);
    });
    writeFileAtomically(file, bytes.data(), bytes.size());
}

}  // namespace etendue
