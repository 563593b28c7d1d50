#include "renderer/image_io.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/config.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

namespace fs = std::filesystem;
using Floats = std::vector<float>;
using ByteValues = std::vector<std::uint8_t>;

/// The message with which readImage refuses the file; empty if it reads it.
std::string errorOf(const fs::path& file) {
    try {
        readImage(file);
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

/// Collects what the process writes to stderr in its lifetime: OpenImageIO and the libraries
/// behind it should leave it to the caller to report.
class CapturedStderr {
public:
    explicit CapturedStderr(const fs::path& file) : file_(file), old_(::dup(2)) {
        const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::dup2(fd, 2);
        ::close(fd);
    }
    ~CapturedStderr() { restore(); }
    CapturedStderr(const CapturedStderr&) = delete;
    CapturedStderr& operator=(const CapturedStderr&) = delete;

    std::string text() {
        restore();
        return readFile(file_);
    }

private:
    void restore() {
        if (old_ < 0) return;
        ::dup2(old_, 2);
        ::close(old_);
        old_ = -1;
    }
    fs::path file_;
    int old_;
};

OIIO::ImageSpec flatSpec(int width, int height, int channels, OIIO::TypeDesc format) {
    return {width, height, channels, format};
}

/// Writes with OpenImageIO itself; pixels of the type that T says, stored as `spec` says.
template <class T>
void writeSample(const fs::path& file, const OIIO::ImageSpec& spec, const std::vector<T>& pixels) {
    const auto output = OIIO::ImageOutput::create(file.string());
    REQUIRE(output);
    REQUIRE(output->open(file.string(), spec));
    REQUIRE(output->write_image(OIIO::BaseTypeFromC<T>::value, pixels.data()));
    REQUIRE(output->close());
}

ByteValues gradient(std::size_t count) {
    ByteValues values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<std::uint8_t>(i * 37 % 256);
    return values;
}

/// A file of every kind, small but larger than one compressed block.
std::vector<fs::path> sampleFiles(const TemporaryFolder& folder) {
    std::vector<fs::path> files;
    for (const char* name : {"a.png", "a.jpg", "a.tif", "a.tga", "a.bmp", "a.hdr", "a.exr"}) {
        files.push_back(folder / name);
        const bool isFloat = files.back().extension() == ".exr";
        writeSample(files.back(), flatSpec(12, 20, 3, isFloat ? OIIO::TypeFloat : OIIO::TypeUInt8),
                    gradient(std::size_t{12} * 20 * 3));
    }
    return files;
}

/// All channels of an EXR, read with OpenImageIO itself.
struct Exr {
    OIIO::ImageSpec spec;
    Floats pixels;

    explicit Exr(const fs::path& file) {
        const auto input = OIIO::ImageInput::open(file.string());
        REQUIRE(input);
        spec = input->spec();
        pixels.resize(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
        REQUIRE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.data()));
    }
    float at(std::size_t pixel, const char* channel) const {
        const int c = spec.channelindex(channel);
        REQUIRE(c >= 0);
        return pixels[pixel * static_cast<std::size_t>(spec.nchannels) +
                      static_cast<std::size_t>(c)];
    }
};

const FrameWindow onePixel{1, 1, 0, 0, 1, 1};

void writeOnePixel(const fs::path& file, const Metadata& metadata) {
    writeExr(file, onePixel, {{{"R", "G", "B"}, {1.0f, 2.0f, 3.0f}}}, metadata);
}

}  // namespace

TEST_CASE("Image I/O: a float EXR comes back bit for bit") {
    using Limits = std::numeric_limits<float>;
    const TemporaryFolder folder;
    Floats pixels{0.0f,
                  -0.0f,
                  1.0f / 3.0f,
                  -70000.0f,
                  Limits::max(),
                  Limits::min(),
                  Limits::lowest(),
                  1e-20f,
                  0.18f,
                  Limits::denorm_min(),
                  65504.0f,
                  65520.0f};
    writeExr(folder / "a.exr", {2, 2, 0, 0, 2, 2}, {{{"R", "G", "B"}, pixels}}, {});
    const Image image = readImage(folder / "a.exr");
    CHECK(image.width == 2);
    CHECK(image.height == 2);
    CHECK(image.channels == 3);
    CHECK_FALSE(image.isEncoded);
    const Floats back = std::get<Floats>(image.pixels);
    REQUIRE(back.size() == pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i)
        CHECK(std::bit_cast<std::uint32_t>(back[i]) == std::bit_cast<std::uint32_t>(pixels[i]));

    // Written as they are, for the eye to find; it is readImage that refuses them.
    pixels[1] = Limits::quiet_NaN();
    pixels[2] = Limits::infinity();
    writeExr(folder / "b.exr", {2, 2, 0, 0, 2, 2}, {{{"R", "G", "B"}, pixels}}, {});
    const Exr exr(folder / "b.exr");
    CHECK(std::isnan(exr.at(0, "G")));
    CHECK(std::isinf(exr.at(0, "B")));
}

TEST_CASE("Image I/O: an EXR is ZIP-compressed float") {
    const TemporaryFolder folder;
    writeOnePixel(folder / "a.exr", {});
    const Exr exr(folder / "a.exr");
    CHECK(exr.spec.format == OIIO::TypeFloat);
    CHECK(exr.spec.get_string_attribute("compression") == "zip");
}

TEST_CASE("Image I/O: a crop lies in the EXR where it lay in the frame") {
    const TemporaryFolder folder;
    Floats pixels(12);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(i);
    writeExr(folder / "a.exr", {100, 80, 30, 40, 4, 3}, {{{"Y"}, pixels}}, {});
    const Exr exr(folder / "a.exr");
    CHECK(std::array{exr.spec.x, exr.spec.y, exr.spec.width, exr.spec.height} ==
          std::array{30, 40, 4, 3});
    CHECK(std::array{exr.spec.full_x, exr.spec.full_y, exr.spec.full_width, exr.spec.full_height} ==
          std::array{0, 0, 100, 80});
    CHECK(exr.pixels == pixels);
    CHECK(std::get<Floats>(readImage(folder / "a.exr").pixels) == pixels);
}

TEST_CASE("Image I/O: layers keep their names, and the unnamed one is what is read back") {
    const TemporaryFolder folder;
    writeExr(folder / "a.exr", {2, 1, 0, 0, 2, 1},
             {{{"albedo.R", "albedo.G", "albedo.B"}, {10, 11, 12, 13, 14, 15}},
              {{"R", "G", "B", "A"}, {1, 2, 3, 4, 5, 6, 7, 8}},
              {{"sampleCount"}, {20, 21}}},
             {});
    const Exr exr(folder / "a.exr");
    CHECK(exr.spec.nchannels == 8);
    CHECK(exr.at(0, "albedo.R") == 10.0f);
    CHECK(exr.at(1, "albedo.B") == 15.0f);
    CHECK(exr.at(1, "R") == 5.0f);
    CHECK(exr.at(1, "sampleCount") == 21.0f);

    const Image image = readImage(folder / "a.exr");
    CHECK(image.channels == 4);
    CHECK(std::get<Floats>(image.pixels) == Floats{1, 2, 3, 4, 5, 6, 7, 8});
}

TEST_CASE("Image I/O: alpha comes last, and another layer's is not the image's") {
    const TemporaryFolder folder;
    writeExr(folder / "a.exr", onePixel, {{{"A", "luminance"}, {1, 2}}}, {});
    CHECK(std::get<Floats>(readImage(folder / "a.exr").pixels) == Floats{2, 1});
    writeExr(folder / "a.exr", onePixel, {{{"R", "G", "B", "albedo.A"}, {1, 2, 3, 4}}}, {});
    CHECK(std::get<Floats>(readImage(folder / "a.exr").pixels) == Floats{1, 2, 3});
}

TEST_CASE("Image I/O: metadata comes back with its type") {
    const TemporaryFolder folder;
    Floats matrix(16);
    for (std::size_t i = 0; i < 16; ++i) matrix[i] = static_cast<float>(i) + 0.5f;
    writeOnePixel(folder / "a.exr", {{"samples", 64},
                                     {"secondsÉ", 1.5f},
                                     {"scene", std::string("a \"long\" road\n")},
                                     {"empty", std::string()},
                                     {"shift", Floats{1, 2}},
                                     {"fiveTerms", Floats{1, 2, 3, 4, 5}},
                                     {"rotation", Floats(9, 0.25f)},
                                     {"normal", Floats{0, 0, 1}},
                                     {"worldToCamera", matrix},
                                     {"worldToNDC", matrix}});
    const OIIO::ImageSpec spec = Exr(folder / "a.exr").spec;
    CHECK(spec.get_int_attribute("samples") == 64);
    CHECK(spec.get_float_attribute("secondsÉ") == 1.5f);
    CHECK(spec.get_string_attribute("scene") == "a \"long\" road\n");
    REQUIRE(spec.find_attribute("shift"));
    CHECK(static_cast<const float*>(spec.find_attribute("shift")->data())[1] == 2.0f);
    REQUIRE(spec.find_attribute("fiveTerms"));
    CHECK(static_cast<const float*>(spec.find_attribute("fiveTerms")->data())[4] == 5.0f);
    for (const char* name : {"worldToCamera", "worldToNDC"}) {
        const OIIO::ParamValue* value = spec.find_attribute(name);
        REQUIRE(value);
        REQUIRE(value->type() == OIIO::TypeMatrix);
        for (std::size_t i = 0; i < 16; ++i)
            CHECK(static_cast<const float*>(value->data())[i] == matrix[i]);
    }
    // The standard attribute, not one that OpenImageIO alone would know.
    const std::string bytes = readFile(folder / "a.exr");
    CHECK(bytes.find(std::string("worldToCamera\0m44f\0", 19)) != bytes.npos);
    CHECK(bytes.find(std::string("worldToNDC\0m44f\0", 16)) != bytes.npos);
    // OpenImageIO does not show it, but there it is.
    CHECK(bytes.find(std::string("empty\0string\0\0\0\0\0", 17)) != bytes.npos);
}

TEST_CASE("Image I/O: metadata that an EXR would lose is refused, and the file not written") {
    const TemporaryFolder folder;
    const Metadata lost[] = {{{"name", 3}},
                             {{"type", std::string("path")}},
                             {{"tiles", 4}},
                             {{"description", std::string("a scene")}},
                             {{"worldToCamera", 1.0f}},
                             {{"oiio:any", 1}},
                             {{"none", Floats{}}}};
    for (const Metadata& metadata : lost)
        CHECK_THROWS_AS(writeOnePixel(folder / "a.exr", metadata), std::invalid_argument);
    CHECK(folder.names().empty());
}

TEST_CASE("Image I/O: equal arguments give equal bytes, without the time of writing or a remark") {
    const TemporaryFolder folder;
    CapturedStderr captured(folder / "stderr");
    writeOnePixel(folder / "a.exr", {{"seed", 7}});
    writeOnePixel(folder / "b.exr", {{"seed", 7}});
    CHECK(readFile(folder / "a.exr") == readFile(folder / "b.exr"));
    CHECK(readFile(folder / "a.exr").find("capDate") == std::string::npos);
    writeOnePixel(folder / "a.exr", {{"capDate", std::string("2001:02:03 04:05:06")}});
    CHECK(readFile(folder / "a.exr").find("2001:02:03 04:05:06") != std::string::npos);

    writePng(folder / "a.png", 2, 2, gradient(12));
    writePng(folder / "b.png", 2, 2, gradient(12));
    CHECK(readFile(folder / "a.png") == readFile(folder / "b.png"));
    CHECK(readFile(folder / "a.png").find("tIME") == std::string::npos);
    CHECK(captured.text() == "");
}

TEST_CASE("Image I/O: a PNG holds the bytes and says that they are sRGB") {
    const TemporaryFolder folder;
    const ByteValues pixels = gradient(std::size_t{31} * 17 * 3);
    writePng(folder / "a.png", 31, 17, pixels);
    CHECK(readFile(folder / "a.png").find("sRGB") != std::string::npos);
    const Image image = readImage(folder / "a.png");
    CHECK(image.width == 31);
    CHECK(image.height == 17);
    CHECK(image.channels == 3);
    CHECK(std::get<ByteValues>(image.pixels) == pixels);
}

TEST_CASE("Image I/O: what cannot be written as asked is refused") {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.exr";
    using Layers = std::vector<ExrChannels>;
    const auto write = [&](const FrameWindow& window, const Layers& layers) {
        writeExr(file, window, layers, {});
    };
    const Layers one{{{"Y"}, {1.0f}}};
    CHECK_THROWS_AS(write({4, 4, 4, 0, 1, 1}, one), std::invalid_argument);
    CHECK_THROWS_AS(write({4, 4, 0, -1, 1, 1}, one), std::invalid_argument);
    CHECK_THROWS_AS(write({4, 4, 0, 0, 0, 1}, {}), std::invalid_argument);
    CHECK_THROWS_AS(write(onePixel, {}), std::invalid_argument);
    CHECK_THROWS_AS(write(onePixel, {{{"Y"}, {1.0f, 2.0f}}}), std::invalid_argument);
    CHECK_THROWS_AS(write(onePixel, {{{""}, {1.0f}}}), std::invalid_argument);
    CHECK_THROWS_AS(write(onePixel, {{{"Y"}, {1.0f}}, {{"Y"}, {2.0f}}}), std::invalid_argument);
    CHECK_THROWS_AS(writePng(folder / "a.png", 2, 2, ByteValues(11)), std::invalid_argument);
    CHECK_THROWS_AS(writePng(folder / "a.png", 0, 2, {}), std::invalid_argument);
    CHECK(folder.names().empty());

    writeFile(folder / "file", "");
    const std::string below = (folder / "file/a.exr").string();
    CHECK_THROWS_WITH_AS(writeOnePixel(below, {}),
                         (below + ": cannot write: Not a directory").c_str(), std::runtime_error);
    CHECK_THROWS_AS(writePng(folder / "missing/a.png", 1, 1, ByteValues(3)), std::runtime_error);
}

TEST_CASE("Image I/O: 8-bit images of 1 to 4 channels keep their bytes") {
    const TemporaryFolder folder;
    struct Case {
        const char* name;
        int channels;
    };
    for (const Case& c :
         {Case{"1.png", 1}, Case{"2.png", 2}, Case{"3.png", 3}, Case{"4.png", 4}, Case{"1.tif", 1},
          Case{"3.TIFF", 3}, Case{"4.tga", 4}, Case{"3.bmp", 3}}) {
        CAPTURE(std::string(c.name));
        const ByteValues pixels = gradient(static_cast<std::size_t>(12 * c.channels));
        OIIO::ImageSpec spec = flatSpec(4, 3, c.channels, OIIO::TypeUInt8);
        if (c.channels % 2 == 0) spec.alpha_channel = c.channels - 1;
        // So that the writer does not divide by an alpha that it takes to be multiplied in already.
        spec.attribute("oiio:UnassociatedAlpha", 1);
        writeSample(folder / c.name, spec, pixels);
        const Image image = readImage(folder / c.name);
        CHECK(image.channels == c.channels);
        CHECK_FALSE(image.isEncoded);
        REQUIRE(std::holds_alternative<ByteValues>(image.pixels));
        CHECK(std::get<ByteValues>(image.pixels) == pixels);
    }
}

TEST_CASE("Image I/O: 16-bit integers become floats in [0, 1] that are marked as encoded") {
    const TemporaryFolder folder;
    const std::vector<std::uint16_t> values{0, 1, 32768, 65535, 257, 40000};
    for (const char* name : {"a.png", "a.tif"}) {
        CAPTURE(std::string(name));
        writeSample(folder / name, flatSpec(2, 1, 3, OIIO::TypeUInt16), values);
        const Image image = readImage(folder / name);
        CHECK(image.isEncoded);
        const Floats pixels = std::get<Floats>(image.pixels);
        REQUIRE(pixels.size() == values.size());
        for (std::size_t i = 0; i < values.size();
             ++i)  // two roundings, of 1/65535 and the product
            CHECK(std::abs(pixels[i] - values[i] / 65535.0) <= 0x1p-23 * pixels[i]);
    }
}

TEST_CASE("Image I/O: half and RGBE pixels become linear floats") {
    const TemporaryFolder folder;
    const Floats values{0.5f, 1.0f, 0.25f, 100.0f, 64.0f, 80.0f};
    writeSample(folder / "a.exr", flatSpec(2, 1, 3, OIIO::TypeHalf), values);
    const Image half = readImage(folder / "a.exr");
    CHECK_FALSE(half.isEncoded);
    CHECK(std::get<Floats>(half.pixels) == values);  // halves hold these exactly

    writeSample(folder / "a.hdr", flatSpec(2, 1, 3, OIIO::TypeFloat), values);
    const Image rgbe = readImage(folder / "a.hdr");
    CHECK_FALSE(rgbe.isEncoded);
    const Floats pixels = std::get<Floats>(rgbe.pixels);
    REQUIRE(pixels.size() == values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        // 8-bit mantissas under the largest channel's exponent: one part in 128 of it.
        const float largest = i < 3 ? 1.0f : 100.0f;
        CHECK(std::abs(pixels[i] - values[i]) <= largest / 128.0f);
    }
}

TEST_CASE("Image I/O: 32-bit integers are refused as colours, not beside them") {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec = flatSpec(1, 1, 4, OIIO::TypeHalf);
    spec.channelnames = {"R", "G", "B", "objectId"};
    spec.channelformats.assign(4, OIIO::TypeHalf);
    spec.channelformats[3] = OIIO::TypeUInt32;
    writeSample(folder / "a.exr", spec, Floats{0.5f, 1.0f, 2.0f, 1.0f});
    CHECK(std::get<Floats>(readImage(folder / "a.exr").pixels) == Floats{0.5f, 1.0f, 2.0f});

    spec.channelformats.assign(4, OIIO::TypeUInt32);
    spec.channelformats[3] = OIIO::TypeFloat;
    writeSample(folder / "b.exr", spec, Floats{0.5f, 1.0f, 0.25f, 1.0f});
    CHECK(errorOf(folder / "b.exr").find("has uint pixels") != std::string::npos);
}

TEST_CASE("Image I/O: a JPEG is read") {
    const TemporaryFolder folder;
    writeSample(folder / "a.jpeg", flatSpec(16, 16, 3, OIIO::TypeUInt8), ByteValues(768, 128));
    const Image image = readImage(folder / "a.jpeg");
    CHECK(image.channels == 3);
    // Mid-grey is 0 to the cosine transform, in every channel.
    CHECK(std::get<ByteValues>(image.pixels) == ByteValues(768, 128));
}

TEST_CASE("Image I/O: reading and writing stay in the caller's thread") {
    const TemporaryFolder folder;
    writeOnePixel(folder / "a.exr", {});
    int threads = 0, exrThreads = 0;
    CHECK(OIIO::getattribute("threads", threads));
    CHECK(OIIO::getattribute("exr_threads", exrThreads));
    CHECK(threads == 1);
    CHECK(exrThreads == -1);
}

TEST_CASE("Image I/O: a missing file is told from a bad one by its exit code") {
    const TemporaryFolder folder;
    fs::create_directory(folder / "folder.png");
    writeFile(folder / "bad.png", "bad");
    const auto codeOf = [](const fs::path& file) {
        try {
            readImage(file);
        } catch (const InputError& error) {
            return error.code();
        }
        return ExitCode::success;
    };
    CHECK(codeOf(folder / "missing.png") == ExitCode::missingFile);
    CHECK(codeOf(folder / "folder.png") == ExitCode::missingFile);
    CHECK(codeOf(folder / "bad.png/a.png") == ExitCode::missingFile);
    REQUIRE(::mkfifo((folder / "pipe.png").c_str(), 0600) == 0);
    CHECK(codeOf(folder / "pipe.png") == ExitCode::missingFile);
    CHECK(codeOf(folder / "missing") == ExitCode::missingFile);
    CHECK(codeOf(folder / "bad.png") == ExitCode::badInput);
}

TEST_CASE("Image I/O: NaN and infinite pixels are refused with their place") {
    const TemporaryFolder folder;
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
        Floats pixels(std::size_t{5} * 4 * 3, 1.0f);
        pixels[(3 * 5 + 2) * 3 + 1] = bad;
        writeExr(folder / "a.exr", {5, 4, 0, 0, 5, 4}, {{{"R", "G", "B"}, pixels}}, {});
        CHECK(errorOf(folder / "a.exr") == (folder / "a.exr").string() +
                                               ": pixel 2, 3 is NaN or infinite, expected finite "
                                               "numbers");
    }
}

TEST_CASE("Image I/O: bad input gives one message that names the file and the reason") {
    const TemporaryFolder folder;
    const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    writeSample(folder / "good.png", flatSpec(2, 2, 3, OIIO::TypeUInt8), gradient(12));
    const std::string png = readFile(folder / "good.png");
    std::string flipped = png;
    flipped[flipped.find("IDAT") + 6] ^= 1;

    const OIIO::TypeDesc uint32 = OIIO::TypeUInt32, byte = OIIO::TypeUInt8;
    const auto sample = [&](const char* name, const OIIO::ImageSpec& spec) {
        writeSample(folder / name, spec,
                    ByteValues(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels)));
    };
    sample("wide.exr", flatSpec(32769, 1, 1, OIIO::TypeHalf));
    sample("tall.png", flatSpec(1, 32769, 1, byte));
    sample("two.exr", [] {
        OIIO::ImageSpec spec = flatSpec(2, 2, 2, OIIO::TypeHalf);
        spec.channelnames = {"motion.X", "motion.Y"};
        return spec;
    }());
    writeExr(folder / "chroma.exr", onePixel, {{{"Y", "RY", "BY"}, {1, 2, 3}}}, {});
    sample("integer.exr", flatSpec(2, 2, 3, uint32));

    struct Case {
        const char* name;
        std::optional<std::string> bytes;  // none: the sample above
        const char* reason;
    };
    const Case cases[] = {
        {"empty.png", "", "not a PNG file"},
        {"text.png", "This is a text.", "not a PNG file"},
        {"short.png", png.substr(0, png.size() - 1), "truncated PNG file"},
        {"flipped.png", flipped, "damaged PNG file: wrong checksum of the chunk at byte "},
        {"empty.exr", "", "not an OpenEXR file"},
        {"text.exr", "This is a text.", "not an OpenEXR file"},
        {"png.exr", png, "not an OpenEXR file"},
        {"png.jpg", png, "JPEG"},
        {"png.hdr", png, ""},
        {"png.tif", png, ""},
        {"png.tga", png, ""},
        {"png.bmp", png, ""},
        {"a.gif", "GIF89a", "unknown image format, expected .exr, .hdr, .png,"},
        {"none", png, "unknown image format"},
        {"huge.hdr", hdr + "-Y 30000 +X 30000\n", "too short for 30000 x 30000 pixels"},
        {"wide.hdr", hdr + "-Y 1 +X 2000000000\n", "is 2000000000 x 1 pixels, expected at most"},
        {"zero.hdr", hdr + "-Y 0 +X 7\n", "has no pixels (7 x 0)"},
        {"negative.hdr", hdr + "-Y -4 +X 4\n", "has no pixels (4 x -4)"},
        {"wide.exr", {}, "is 32769 x 1 pixels, expected at most 32768 on a side"},
        {"tall.png", {}, "is 1 x 32769 pixels, expected at most 32768 on a side"},
        {"two.exr", {}, "has 2 channels, expected grey or R, G, B"},
        {"chroma.exr", {}, "has 3 channels, expected grey or R, G, B"},
        {"integer.exr", {}, "has uint pixels, expected float or 8- or 16-bit integers"},
    };
    CapturedStderr captured(folder / "stderr");
    for (const Case& c : cases) {
        CAPTURE(std::string(c.name));
        if (c.bytes) writeFile(folder / c.name, *c.bytes);
        const std::string message = errorOf(folder / c.name);
        CHECK(message.starts_with((folder / c.name).string() + ": "));
        CHECK(message.find(c.reason) != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    }
    CHECK(captured.text() == "");
}

TEST_CASE("Image I/O: an EXR header that promises 10^12 pixels or a long text costs nothing") {
    const TemporaryFolder folder;
    const fs::path file = folder / "a.exr";
    writeOnePixel(file, {{"text", std::string("short")}});
    const std::string good = readFile(file);
    const auto patched = [&](const std::string& before, std::size_t distance, std::int32_t value) {
        std::string bytes = good;
        const std::size_t at = bytes.find(before) + before.size() + distance;
        for (std::size_t i = 0; i < 4; ++i)
            bytes[at + i] = static_cast<char>(value >> 8 * i & 0xff);
        return bytes;
    };
    const std::string box("dataWindow\0box2i\0\x10\0\0\0", 21);
    writeFile(file, patched(box, 8, 999'999));
    CHECK(errorOf(file) ==
          file.string() + ": is 1000000 x 1 pixels, expected at most 32768 on a side");
    writeFile(file, patched(box, 4, std::numeric_limits<std::int32_t>::min()));
    CHECK(errorOf(file) ==
          file.string() + ": is 1 x 2147483649 pixels, expected at most 32768 on a side");
    for (const std::int32_t length : {1000, 2'000'000'000, -1}) {
        writeFile(file, patched(std::string("text\0string\0", 12), 0, length));
        CHECK(errorOf(file) == file.string() + ": truncated or damaged OpenEXR header");
    }
}

TEST_CASE("Image I/O: a deep EXR is refused") {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec = flatSpec(2, 2, 2, OIIO::TypeFloat);
    spec.channelnames = {"R", "Z"};
    spec.deep = true;
    const OIIO::DeepData data(spec);
    const auto output = OIIO::ImageOutput::create("openexr");
    const std::string file = (folder / "deep.exr").string();
    REQUIRE(output->open(file, spec));
    REQUIRE(output->write_deep_image(data));
    REQUIRE(output->close());
    CHECK(errorOf(file) == file + ": is a deep or volume image, expected a flat one");
}

TEST_CASE("Image I/O: a file that ends before its last pixel is refused") {
    const TemporaryFolder folder;
    const std::vector<fs::path> files = sampleFiles(folder);
    CapturedStderr captured(folder / "stderr");
    for (const fs::path& file : files) {
        const std::string bytes = readFile(file);
        CAPTURE(file);
        REQUIRE(errorOf(file) == "");
        std::size_t end = bytes.size();
        if (file.extension() == ".tga") end = std::size_t{18} + 12 * 20 * 3;  // a footer follows
        if (file.extension() == ".jpg") end -= 2;                             // the end marker
        std::size_t accepted = 0;
        for (std::size_t length = 0; length < end; length += length < 300 ? 1 : 5) {
            writeFile(file, bytes.substr(0, length));
            accepted += errorOf(file).empty();
        }
        CHECK(accepted == 0);
    }
    CHECK(captured.text() == "");
}

TEST_CASE("Image I/O: damaged files are read or refused, never more") {
    const TemporaryFolder folder;
    const std::vector<fs::path> files = sampleFiles(folder);
    CapturedStderr captured(folder / "stderr");
    std::mt19937 random(1);
    for (const fs::path& file : files) {
        const std::string bytes = readFile(file);
        int refused = 0;
        for (int i = 0; i < 100; ++i) {
            std::string damaged = bytes;
            for (int flips = 0; flips < 4; ++flips)
                damaged[random() % std::min<std::size_t>(damaged.size(), 400)] =
                    static_cast<char>(random());
            writeFile(file, damaged);
            refused += !errorOf(file).empty();
        }
        CHECK(refused > 0);
    }
    captured.text();
}
