#include "tools/compare_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/image_io.h"
#include "statistics/flip.h"
#include "statistics/image_error.h"
#include "statistics/tile_means.h"
#include "tools/false_color.h"
#include "tools/json.h"
#include "tools/progress.h"
#include "tools/text_table.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

/// A picture with what it knows of its noise.
struct LightPicture {
    std::filesystem::path file;
    int width = 0, height = 0;
    std::optional<FrameWindow> window;  // of an EXR
    Picture rgb;
    std::optional<Picture> variance;  // of each pixel's mean
    std::string missingVariance;      // why there is none
};

Picture lightOf(const Image& image, const std::filesystem::path& file) {
    const auto* pixels = std::get_if<std::vector<float>>(&image.pixels);
    if (!pixels || image.isEncoded)
        throw InputError(fmt::format(
            "{}: holds encoded colours, expected light: an EXR or HDR file", file.string()));
    const auto channels = static_cast<std::size_t>(image.channels);
    Picture rgb;
    rgb.reserve(pixels->size() / channels * 3);
    for (std::size_t i = 0; i < pixels->size(); i += channels)
        for (std::size_t c = 0; c < 3; ++c) rgb.push_back((*pixels)[i + (channels < 3 ? 0 : c)]);
    return rgb;
}

void readVariance(LightPicture& picture) {
    const auto layer = readExrChannels(picture.file, {"variance.R", "variance.G", "variance.B"});
    if (!layer) {
        picture.missingVariance =
            readExrChannels(picture.file, {"variance.X"})
                ? "has variance.X, variance.Y and variance.Z, of a picture with wavelengths, but "
                  "no layer variance.R, variance.G, variance.B"
                : "has no layer variance.R, variance.G, variance.B (etendue render --layers "
                  "variance writes it)";
        return;
    }
    const auto [least, most] = std::ranges::minmax(layer->pixels);
    if (least < 0.0F)
        throw InputError(fmt::format("{}: a variance is negative", picture.file.string()));
    const bool isBlack = std::ranges::all_of(picture.rgb, [](float v) { return v == 0.0F; });
    if (most > 0.0F)
        picture.variance = layer->pixels;
    else
        picture.missingVariance =
            fmt::format("has variance 0 everywhere, {}, and says nothing of its noise",
                        isBlack ? "since it is black" : "as one of a single sample a pixel has");
}

LightPicture readPicture(const std::filesystem::path& file) {
    const Image image = readImage(file);
    LightPicture picture{file, image.width, image.height, {}, lightOf(image, file), {}, {}};
    picture.window = readExrWindow(file);
    readVariance(picture);
    return picture;
}

/// Of picture and reference, empty for one that is exact.
struct Variances {
    Picture picture, reference;
};

/// Throws InputError if one is not known.
Variances variancesOf(const CompareCommand& command, const LightPicture& picture,
                      const LightPicture& reference) {
    const auto variance = [&](const LightPicture& of, ExactPicture self) {
        if (command.exact == self) return Picture();
        if (of.variance) return *of.variance;
        throw InputError(fmt::format("{}: {}", of.file.string(), of.missingVariance));
    };
    return {variance(picture, ExactPicture::picture), variance(reference, ExactPicture::reference)};
}

bool areVariancesKnown(const CompareCommand& command, const LightPicture& picture,
                       const LightPicture& reference) {
    return (picture.variance || command.exact == ExactPicture::picture) &&
           (reference.variance || command.exact == ExactPicture::reference);
}

struct Comparison {
    int width = 0, height = 0;
    ImageErrors errors;
    double meanErrorHalfWidth = 0.0;  // 99 %
    bool isByVariance = false;        // or by the scatter of the pixels
    double flip = 0.0;
    FlipExposures exposures;
    std::optional<TileZTest> z;
    std::vector<std::string> exceeded;  // one message for each limit
};

TileZTest testMeans(const CompareCommand& command, const LightPicture& picture,
                    const LightPicture& reference) {
    const Variances variances = variancesOf(command, picture, reference);
    Picture sum(picture.rgb.size(), 0.0F);
    for (const Picture& variance : {variances.picture, variances.reference})
        for (std::size_t i = 0; i < variance.size(); ++i) sum[i] += variance[i];
    return zTestOfTiles(picture.rgb, reference.rgb, sum, picture.width, command.tileSize);
}

std::vector<std::string> exceededLimits(const CompareCommand& command, const Comparison& c) {
    std::vector<std::string> exceeded;
    const auto hold = [&](const char* name, double value, const char* option,
                          const std::optional<double>& limit) {
        // NaN is within no limit.
        if (limit && !(value <= *limit))
            exceeded.push_back(
                fmt::format("{} {:.4g} exceeds {} {:g}", name, value, option, *limit));
    };
    hold("relMSE", c.errors.relMse, "--max-relmse", command.maxRelMse);
    if (command.maxMeanErrorPercent && std::isnan(c.errors.meanError))
        exceeded.push_back(
            fmt::format("mean error is undefined, since the reference is black: it is within no "
                        "--max-mean-error {:g}",
                        *command.maxMeanErrorPercent));
    else
        hold("mean error in percent", 100.0 * std::abs(c.errors.meanError), "--max-mean-error",
             command.maxMeanErrorPercent);
    hold("FLIP", c.flip, "--max-flip", command.maxFlip);
    return exceeded;
}

Comparison compare(const CompareCommand& command, const LightPicture& picture,
                   const LightPicture& reference) {
    Comparison c{picture.width,
                 picture.height,
                 imageErrors(picture.rgb, reference.rgb),
                 0.0,
                 false,
                 0.0,
                 {},
                 {},
                 {}};
    c.isByVariance = areVariancesKnown(command, picture, reference);
    if (c.isByVariance) {
        const Variances variances = variancesOf(command, picture, reference);
        c.meanErrorHalfWidth =
            meanErrorHalfWidth(picture.rgb, reference.rgb, variances.picture, variances.reference);
    } else {
        c.meanErrorHalfWidth = meanErrorHalfWidthByScatter(picture.rgb, reference.rgb);
    }
    c.flip = meanHdrFlip(picture.rgb, reference.rgb, picture.width);
    c.exposures = flipExposures(reference.rgb);
    if (command.testsMeans) c.z = testMeans(command, picture, reference);
    c.exceeded = exceededLimits(command, c);
    return c;
}

constexpr const char* colorNames[] = {"red", "green", "blue"};

std::string zText(const TileZTest& z, int tileSize) {
    std::string text = fmt::format(
        "z-test of tiles of {} x {} pixels, {} tests: p = {:.2g} where the means differ the most, "
        "below {:.2g} counts: ",
        tileSize, tileSize, z.tests, z.smallestP, z.level);
    if (z.agree()) return text + "not told apart\n";
    return text + fmt::format(
                      "told apart\n  {} of the {} x {} pixels at {}, {}: {:+.3g} ± {:.2g} "
                      "(standard error)\n",
                      colorNames[z.color], z.width, z.height, z.x, z.y, z.difference,
                      z.standardError);
}

/// A row of the table.
std::vector<std::string> meanErrorRow(const Comparison& c) {
    if (std::isnan(c.errors.meanError))
        return {"mean error", "undefined", "since the reference is black"};
    const std::string halfWidth = std::isnan(c.meanErrorHalfWidth)
                                      ? "–"
                                      : fmt::format("± {:.3f} %", 100.0 * c.meanErrorHalfWidth);
    return {"mean error", fmt::format("{:+.3f} %", 100.0 * c.errors.meanError),
            fmt::format("{} (99 %, by {})", halfWidth,
                        c.isByVariance ? "the variance layers" : "the scatter of the pixels")};
}

std::string comparisonText(const CompareCommand& command, const Comparison& c) {
    const auto number = [](double value) { return fmt::format("{:.4g}", value); };
    const ImageErrors& e = c.errors;
    std::string text = fmt::format("{} against {}, {} x {} pixels\n", command.picture.string(),
                                   command.reference.string(), c.width, c.height);
    text += alignedTable(
        {{"relMSE", number(e.relMse), ""},
         {"relMSE, trimmed", number(e.relMseTrimmed), "without the 0.1 % worst pixels"},
         {"MSE", number(e.mse), ""},
         {"MAE", number(e.mae), ""},
         meanErrorRow(c),
         {"FLIP", number(c.flip),
          fmt::format("HDR, {} exposures from {:+.2f} to {:+.2f} stops", c.exposures.count,
                      c.exposures.start, c.exposures.stop)}},
        "lrl");
    if (c.z) text += zText(*c.z, command.tileSize);
    return text;
}

Json comparisonJson(const CompareCommand& command, const Comparison& c) {
    Json json = Json::object(
        {{"picture", command.picture.string()},
         {"reference", command.reference.string()},
         {"width", c.width},
         {"height", c.height},
         {"rel_mse", c.errors.relMse},
         {"rel_mse_trimmed", c.errors.relMseTrimmed},
         {"mse", c.errors.mse},
         {"mae", c.errors.mae},
         {"mean_error_percent", 100.0 * c.errors.meanError},
         {"mean_error_half_width_percent", 100.0 * c.meanErrorHalfWidth},
         {"mean_error_half_width_by", c.isByVariance ? "variance layers" : "scatter of pixels"},
         {"flip", c.flip},
         {"flip_exposures", Json::object({{"start", c.exposures.start},
                                          {"stop", c.exposures.stop},
                                          {"count", c.exposures.count}})}});
    if (c.z)
        json.add("z_test",
                 Json::object({{"tests", c.z->tests},
                               {"smallest_p", c.z->smallestP},
                               {"level", c.z->level},
                               {"agree", c.z->agree()},
                               {"tile", Json::numbers({static_cast<double>(c.z->x),
                                                       static_cast<double>(c.z->y),
                                                       static_cast<double>(c.z->width),
                                                       static_cast<double>(c.z->height)})},
                               {"color", colorNames[c.z->color]},
                               {"difference", c.z->difference},
                               {"standard_error", c.z->standardError}}));
    Json exceeded = Json::array();
    for (const std::string& message : c.exceeded) exceeded.add(message);
    json.add("exceeded", exceeded);
    return json;
}

std::string textOf(const FrameWindow& w) {
    return fmt::format("{},{},{},{} of {} x {}", w.x, w.y, w.width, w.height, w.fullWidth,
                       w.fullHeight);
}

/// Frames may be of two sizes, if their pixels lie in one place.
void checkSamePlace(const LightPicture& picture, const LightPicture& reference) {
    if (picture.width != reference.width || picture.height != reference.height)
        throw InputError(
            fmt::format("{} has {} x {} pixels, {} has {} x {}: they cannot be compared",
                        picture.file.string(), picture.width, picture.height,
                        reference.file.string(), reference.width, reference.height));
    const std::optional<FrameWindow>&a = picture.window, &b = reference.window;
    if (a && b && (a->x != b->x || a->y != b->y))
        throw InputError(
            fmt::format("{} is the window {}, {} the window {}: they cannot be compared",
                        picture.file.string(), textOf(*a), reference.file.string(), textOf(*b)));
}

void checkErrorImage(const CompareCommand& command) {
    const std::filesystem::path& file = command.errorImage;
    if (!file.empty() && file.extension() != ".exr" && file.extension() != ".png")
        throw InputError(fmt::format("--error-image {}: expected a name that ends in .exr or .png",
                                     file.string()),
                         ExitCode::usage);
    checkDistinct({{"--error-image", file}},
                  {{"the picture", command.picture}, {"the reference", command.reference}});
}

void writeErrorImage(const std::filesystem::path& file, const LightPicture& picture,
                     const LightPicture& reference) {
    if (file.empty()) return;
    const std::vector<float> errors = relativeSquaredErrors(picture.rgb, reference.rgb);
    const int width = picture.width, height = picture.height;
    // Errors of 1 % and of 100 % of the light, in every picture alike.
    if (file.extension() == ".png")
        writePng(file, width, height, falseColors(errors, 1e-4, 1.0));
    else
        writeExr(file, {width, height, 0, 0, width, height}, {{{"Y"}, errors}}, {});
}

}  // namespace

CompareReport compareFiles(const CompareCommand& command) {
    checkErrorImage(command);
    const LightPicture picture = readPicture(command.picture);
    const LightPicture reference = readPicture(command.reference);
    checkSamePlace(picture, reference);
    const Comparison comparison = compare(command, picture, reference);
    writeErrorImage(command.errorImage, picture, reference);
    const bool isTold = comparison.z && !comparison.z->agree();
    return {command.asJson ? comparisonJson(command, comparison).text() + "\n"
                           : comparisonText(command, comparison),
            comparison.exceeded,
            isTold || !comparison.exceeded.empty() ? ExitCode::failure : ExitCode::success};
}

ExitCode runCompare(const CompareCommand& command) {
    const CompareReport report = compareFiles(command);
    fmt::print("{}", report.text);
    for (const std::string& message : report.exceeded) say(fmt::format("etendue: {}\n", message));
    return report.code;
}

}  // namespace etendue
