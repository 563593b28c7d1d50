#include "tools/compare_command.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <tuple>
#include <variant>

#include "renderer/image_io.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/command_outcome.h"
#include "tests/tools/every_material_scene.h"

using namespace etendue;

namespace {

constexpr int width = 32, height = 16;
constexpr std::size_t values = std::size_t{3} * width * height;

/// Some picture, brighter to the right.
std::vector<float> ramp(float scale) {
    std::vector<float> pixels;
    for (std::size_t i = 0; i < values; ++i)
        pixels.push_back(scale * (1.0F + static_cast<float>(i / 3 % width)));
    return pixels;
}

/// Pictures in a folder, and the command on two of them.
struct Pictures {
    void write(const std::string& name, const std::vector<float>& pixels,
               const std::vector<ExrChannels>& more = {}) const {
        std::vector<ExrChannels> layers{{{"R", "G", "B"}, pixels}};
        layers.insert(layers.end(), more.begin(), more.end());
        writeExr(folder / name, {width, height, 0, 0, width, height}, layers, {});
    }
    void writeWithVariance(const std::string& name, const std::vector<float>& pixels,
                           float variance) const {
        write(name, pixels,
              {{{"variance.R", "variance.G", "variance.B"}, std::vector<float>(values, variance)}});
    }
    /// Files of the folder, by name.
    CompareCommand command(const std::string& picture, const std::string& reference) const {
        CompareCommand c;
        c.picture = folder / picture;
        c.reference = folder / reference;
        c.asJson = true;
        return c;
    }
    std::string text(const std::string& picture, const std::string& reference) const {
        CompareCommand c = command(picture, reference);
        c.asJson = false;
        return compareFiles(c).text;
    }
    std::string json(const std::string& picture, const std::string& reference) const {
        return compareFiles(command(picture, reference)).text;
    }
    TemporaryFolder folder;
};

/// What is wrong with the input, without the folder's name.
std::string faultOf(const CompareCommand& command, ExitCode code = ExitCode::badInput) {
    try {
        compareFiles(command);
    } catch (const InputError& error) {
        CHECK(error.code() == code);
        std::string text = error.what();
        const std::string folder = command.picture.parent_path().string() + "/";
        for (std::size_t at = 0; (at = text.find(folder)) != text.npos;)
            text.erase(at, folder.size());
        return text;
    }
    return "";
}

/// One grey pixel of 16 bits, which the image reader makes a float.
std::string deepPng() {
    static constexpr char bytes[] =
        "\211\120\116\107\015\012\032\012\000\000\000\015\111\110\104\122\000\000\000\001"
        "\000\000\000\001\020\000\000\000\000\152\356\107\026\000\000\000\013\111\104\101"
        "\124\170\234\143\020\062\001\000\000\133\000\107\226\373\033\145\000\000\000\000"
        "\111\105\116\104\256\102\140\202";
    return {bytes, sizeof bytes - 1};
}

/// The number after `key` in JSON, "null" being NaN.
double numberOf(const std::string& json, const std::string& key) {
    const std::size_t at = json.find("\"" + key + "\": ");
    REQUIRE(at != json.npos);
    const std::string text = json.substr(at + key.size() + 4, 30);
    return text.starts_with("null") ? std::nan("") : std::stod(text);
}

}  // namespace

TEST_CASE("Compare: a picture and itself have no errors") {
    const Pictures pictures;
    pictures.write("a.exr", ramp(1.0F));
    CompareCommand command = pictures.command("a.exr", "a.exr");
    command.maxRelMse = command.maxMeanErrorPercent = command.maxFlip = 0.0;
    const CompareReport report = compareFiles(command);
    CHECK(report.code == ExitCode::success);
    CHECK(report.exceeded.empty());
    for (const char* key : {"rel_mse", "rel_mse_trimmed", "mse", "mae", "mean_error_percent",
                            "mean_error_half_width_percent", "flip"}) {
        CAPTURE(key);
        CHECK(numberOf(report.text, key) == 0.0);
    }
    CHECK(contains(report.text, "\"exceeded\": []"));
}

TEST_CASE("Compare: a picture a tenth brighter is so by every error") {
    const Pictures pictures;
    pictures.write("a.exr", ramp(1.1F));
    pictures.write("r.exr", ramp(1.0F));
    const std::string json = pictures.json("a.exr", "r.exr");
    CHECK(numberOf(json, "mean_error_percent") == doctest::Approx(10.0).epsilon(1e-5));
    CHECK(numberOf(json, "mae") == doctest::Approx(0.1 * 16.5).epsilon(1e-5));
    CHECK(numberOf(json, "mse") == doctest::Approx(0.01 * 11440.0 / 32.0).epsilon(1e-5));
    CHECK(std::abs(numberOf(json, "rel_mse") - 0.01) < 1e-4);
    CHECK(numberOf(json, "flip") > 0.001);
    CHECK(numberOf(json, "width") == width);
    CHECK(numberOf(json, "height") == height);
    CHECK(contains(json, "\"mean_error_half_width_by\": \"scatter of pixels\""));

    const std::string text = pictures.text("a.exr", "r.exr");
    for (const char* part : {"r.exr, 32 x 16 pixels\n", "relMSE, trimmed", "+10.000 %  ± ",
                             "by the scatter of the pixels)", "FLIP"})
        CHECK(contains(text, part));
    // The sign is the picture's, and the reference divides.
    CHECK(contains(pictures.text("r.exr", "a.exr"), "-9.091 %"));
}

TEST_CASE("Compare: limits that are exceeded fail and say which, others do not") {
    const Pictures pictures;
    pictures.write("a.exr", ramp(1.1F));
    pictures.write("r.exr", ramp(1.0F));
    const auto exceeded = [&](CompareCommand command, auto limit, double value) {
        command.*limit = value;
        const CompareReport report = compareFiles(command);
        CHECK((report.code == ExitCode::failure) == !report.exceeded.empty());
        for (const std::string& message : report.exceeded) CHECK(contains(report.text, message));
        return report.exceeded.empty() ? "" : report.exceeded.front();
    };
    const CompareCommand brighter = pictures.command("a.exr", "r.exr");
    CHECK(exceeded(brighter, &CompareCommand::maxRelMse, 0.011) == "");
    CHECK(exceeded(brighter, &CompareCommand::maxMeanErrorPercent, 10.1) == "");
    CHECK(exceeded(brighter, &CompareCommand::maxFlip, 0.9) == "");
    const std::string relMse = exceeded(brighter, &CompareCommand::maxRelMse, 0.009);
    CHECK(relMse.starts_with("relMSE 0.0099"));
    CHECK(relMse.ends_with(" exceeds --max-relmse 0.009"));
    CHECK(exceeded(brighter, &CompareCommand::maxMeanErrorPercent, 9.9) ==
          "mean error in percent 10 exceeds --max-mean-error 9.9");
    CHECK(exceeded(brighter, &CompareCommand::maxFlip, 1e-4).ends_with("--max-flip 0.0001"));
    const CompareCommand darker = pictures.command("r.exr", "a.exr");
    CHECK(exceeded(darker, &CompareCommand::maxMeanErrorPercent, 9.0).ends_with("error 9"));
    // Nothing is 9 % brighter than black.
    pictures.write("black.exr", std::vector<float>(values, 0.0F));
    const CompareCommand black = pictures.command("a.exr", "black.exr");
    CHECK(exceeded(black, &CompareCommand::maxMeanErrorPercent, 9.0) ==
          "mean error is undefined, since the reference is black: it is within no "
          "--max-mean-error 9");
}

TEST_CASE("Compare: against black the mean error is undefined, and of black it is 0") {
    const Pictures pictures;
    pictures.write("a.exr", ramp(1.0F));
    pictures.write("black.exr", std::vector<float>(values, 0.0F));
    CHECK(contains(pictures.text("a.exr", "black.exr"), "undefined  since the reference is black"));
    const std::string json = pictures.json("a.exr", "black.exr");
    CHECK(contains(json, "\"mean_error_percent\": null,"));
    CHECK(contains(json, "\"mean_error_half_width_percent\": null,"));
    CompareCommand both = pictures.command("black.exr", "black.exr");
    both.asJson = false;
    both.maxRelMse = both.maxMeanErrorPercent = both.maxFlip = 0.0;
    const CompareReport report = compareFiles(both);
    CHECK(report.code == ExitCode::success);
    CHECK(contains(report.text, "+0.000 %  ± 0.000 % (99 %, by the scatter"));
    CHECK_FALSE(contains(report.text, "nan"));
}

TEST_CASE("Compare: of a single pixel there is no scatter, and no interval") {
    const Pictures pictures;
    writeExr(pictures.folder / "one.exr", {1, 1, 0, 0, 1, 1}, {{{"Y"}, {2.0F}}}, {});
    CHECK(contains(pictures.text("one.exr", "one.exr"), "+0.000 %  – (99 %, by the scatter"));
    CHECK(
        contains(pictures.json("one.exr", "one.exr"), "\"mean_error_half_width_percent\": null,"));
}

TEST_CASE("Compare: pictures of one size that lie in two places of the frame are refused") {
    const Pictures pictures;
    const auto crop = [&](const char* name, const FrameWindow& window) {
        writeExr(pictures.folder / name, window, {{{"R", "G", "B"}, ramp(1.0F)}}, {});
    };
    crop("a.exr", {80, 60, 10, 10, width, height});
    crop("right.exr", {80, 60, 40, 10, width, height});
    crop("below.exr", {80, 60, 10, 40, width, height});
    crop("other-frame.exr", {90, 70, 10, 10, width, height});
    CHECK(faultOf(pictures.command("a.exr", "right.exr")) ==
          "a.exr is the window 10,10,32,16 of 80 x 60, right.exr the window 40,10,32,16 of 80 x "
          "60: they cannot be compared");
    CHECK(faultOf(pictures.command("below.exr", "a.exr")).starts_with("below.exr is the window "));
    CHECK(faultOf(pictures.command("a.exr", "other-frame.exr")) == "");
    // An HDR file does not say where it lies.
    pictures.folder.write("two.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\naaaabbbb");
    writeExr(pictures.folder / "two.exr", {80, 60, 10, 10, 2, 1}, {{{"Y"}, {1.0F, 1.0F}}}, {});
    CHECK(faultOf(pictures.command("two.exr", "two.hdr")) == "");
}

TEST_CASE("Compare: what cannot be compared gets one message") {
    const Pictures pictures;
    pictures.write("a.exr", ramp(1.0F));
    std::vector<float> spoiled = ramp(1.0F);
    spoiled[3 * (2 * width + 5)] = std::numeric_limits<float>::quiet_NaN();
    pictures.write("nan.exr", spoiled);
    for (const auto& [name, w, h] :
         {std::tuple{"low.exr", 32, 8}, {"narrow.exr", 8, 16}, {"turned.exr", 16, 32}})
        writeExr(pictures.folder / name, {w, h, 0, 0, w, h},
                 {{{"Y"}, std::vector<float>(static_cast<std::size_t>(w * h), 1.0F)}}, {});
    writePng(pictures.folder / "a.png", 1, 1, {1, 2, 3});
    CHECK(faultOf(pictures.command("a.exr", "low.exr")) ==
          "a.exr has 32 x 16 pixels, low.exr has 32 x 8: they cannot be compared");
    CHECK(faultOf(pictures.command("a.exr", "narrow.exr")).ends_with("they cannot be compared"));
    CHECK(faultOf(pictures.command("turned.exr", "a.exr")).ends_with("they cannot be compared"));
    const std::string notFinite = "nan.exr: pixel 5, 2 is NaN or infinite, expected finite numbers";
    CHECK(faultOf(pictures.command("nan.exr", "a.exr")) == notFinite);
    CHECK(faultOf(pictures.command("a.exr", "nan.exr")) == notFinite);
    pictures.folder.write("deep.png", deepPng());
    for (const std::string name : {"a.png", "deep.png"})
        CHECK(faultOf(pictures.command("a.exr", name)) ==
              name + ": holds encoded colours, expected light: an EXR or HDR file");
    CHECK(faultOf(pictures.command("none.exr", "a.exr"), ExitCode::missingFile) ==
          "none.exr: no such file");
    CompareCommand toJpeg = pictures.command("a.exr", "a.exr");
    toJpeg.errorImage = "e.jpg";
    CHECK(faultOf(toJpeg, ExitCode::usage) ==
          "--error-image e.jpg: expected a name that ends in .exr or .png");
}

TEST_CASE("Compare: an error image in the place of a picture is refused, by whatever path") {
    const Pictures pictures;
    pictures.write("a.exr", ramp(1.1F));
    pictures.write("r.exr", ramp(1.0F));
    std::filesystem::create_symlink("a.exr", pictures.folder / "link.exr");
    const auto fault = [&](const std::string& errorImage) {
        CompareCommand command = pictures.command("a.exr", "r.exr");
        command.errorImage = pictures.folder / errorImage;
        return faultOf(command, ExitCode::usage);
    };
    const std::string rest = " and --error-image, and one would replace the other";
    CHECK(fault("a.exr") == "a.exr: is the picture" + rest);
    CHECK(fault("./r.exr") == "./r.exr: is the reference" + rest);
    CHECK(fault("link.exr") == "link.exr: is the picture" + rest);
    CHECK(fault("e.exr") == "");
}

TEST_CASE("Compare: grey pictures are compared with coloured ones, alpha is left out") {
    const Pictures pictures;
    const FrameWindow window{2, 1, 0, 0, 2, 1};
    writeExr(pictures.folder / "grey.exr", window, {{{"Y"}, {1.0F, 3.0F}}}, {});
    writeExr(pictures.folder / "rgba.exr", window,
             {{{"R", "G", "B", "A"}, {1.0F, 1.0F, 1.0F, 0.5F, 3.0F, 3.0F, 4.5F, 0.0F}}}, {});
    CHECK(numberOf(pictures.json("rgba.exr", "grey.exr"), "mean_error_percent") ==
          doctest::Approx(100.0 * 1.5 / 12.0));
}

TEST_CASE("Compare: writes the error of each pixel as numbers or as false colours") {
    const Pictures pictures;
    std::vector<float> picture(values, 1.0F);
    const std::vector<float> reference = picture;
    picture[0] = picture[1] = picture[2] = 3.0F;
    pictures.write("a.exr", picture);
    pictures.write("r.exr", reference);
    CompareCommand command = pictures.command("a.exr", "r.exr");
    command.errorImage = pictures.folder / "e.exr";
    compareFiles(command);
    const Image errors = readImage(command.errorImage);
    REQUIRE(errors.channels == 1);
    REQUIRE(errors.width == width);
    REQUIRE(errors.height == height);
    const auto& numbers = std::get<std::vector<float>>(errors.pixels);
    CHECK(numbers[0] == doctest::Approx(4.0 / 1.01).epsilon(1e-6));
    CHECK(numbers[1] == 0.0F);

    command.errorImage = pictures.folder / "e.png";
    compareFiles(command);
    const Image seen = readImage(command.errorImage);
    REQUIRE(seen.channels == 3);
    const auto& bytes = std::get<std::vector<std::uint8_t>>(seen.pixels);
    CHECK(bytes[0] == 255);  // more than 1: the palest
    CHECK(bytes[2] == 190);
    CHECK(bytes[3] == 0);
    CHECK(bytes[5] == 0);
}

TEST_CASE("Compare: the interval of the mean error comes from the variance layers of both") {
    const Pictures pictures;
    pictures.writeWithVariance("a.exr", std::vector<float>(values, 1.1F), 0.01F);
    pictures.writeWithVariance("r.exr", std::vector<float>(values, 1.0F), 0.01F);
    pictures.write("plain.exr", std::vector<float>(values, 1.0F));
    const std::string both = pictures.json("a.exr", "r.exr");
    const double ofOne = 2.5758293 * 100.0 * 0.1 / std::sqrt(width * height);
    const std::string key = "mean_error_half_width_percent";
    CHECK(numberOf(both, key) == doctest::Approx(ofOne * std::sqrt(1.0 + 1.21)).epsilon(1e-5));
    CHECK(contains(both, "\"mean_error_half_width_by\": \"variance layers\""));
    CHECK(contains(pictures.text("a.exr", "r.exr"), "(99 %, by the variance layers)"));
    CompareCommand exact = pictures.command("a.exr", "plain.exr");
    exact.exact = ExactPicture::reference;
    CHECK(numberOf(compareFiles(exact).text, key) == doctest::Approx(ofOne).epsilon(1e-5));
    CHECK(contains(pictures.json("a.exr", "plain.exr"), "scatter of pixels"));
    CHECK(contains(pictures.json("plain.exr", "a.exr"), "scatter of pixels"));
}

TEST_CASE("Compare --z: means that the noise allows pass, others fail with their tile") {
    const Pictures pictures;
    const std::vector<float> reference(values, 1.0F);
    pictures.writeWithVariance("r.exr", reference, 0.01F);
    std::vector<float> picture = reference;
    for (int y = 0; y < 16; ++y)
        for (int x = 16; x < 32; ++x)
            picture[static_cast<std::size_t>(3 * (y * width + x) + 2)] += 0.1F;
    pictures.writeWithVariance("a.exr", picture, 0.01F);
    pictures.writeWithVariance("near.exr", std::vector<float>(values, 1.005F), 0.01F);

    CompareCommand near = pictures.command("near.exr", "r.exr");
    near.testsMeans = true;
    CHECK(compareFiles(near).code == ExitCode::success);
    near.asJson = false;
    CHECK(contains(compareFiles(near).text, "9 tests: p = "));
    CHECK(contains(compareFiles(near).text, "not told apart"));

    CompareCommand told = pictures.command("a.exr", "r.exr");
    CHECK(compareFiles(told).code == ExitCode::success);
    told.testsMeans = true;
    told.asJson = false;
    CHECK(compareFiles(told).code == ExitCode::failure);
    const std::string where = "blue of the 16 x 16 pixels at 16, 0: +0.1 ± ";
    CHECK(contains(compareFiles(told).text, where + "0.0088"));  // √(2 · 0.01 / 256)
    // A picture without noise halves the variance.
    for (const ExactPicture which : {ExactPicture::picture, ExactPicture::reference}) {
        told.exact = which;
        CHECK(contains(compareFiles(told).text, where + "0.0062"));
    }
    told.asJson = true;
    told.tileSize = 8;
    const std::string json = compareFiles(told).text;
    CHECK(contains(json, "\"agree\": false"));
    CHECK(numberOf(json, "tests") == 3 * (8 + 1));
}

TEST_CASE("Compare --z: pictures that do not know their noise are refused by name") {
    const Pictures pictures;
    pictures.writeWithVariance("noisy.exr", ramp(1.0F), 0.01F);
    pictures.write("plain.exr", ramp(1.0F));
    pictures.writeWithVariance("single.exr", ramp(1.0F), 0.0F);
    pictures.writeWithVariance("black.exr", std::vector<float>(values, 0.0F), 0.0F);
    pictures.writeWithVariance("negative.exr", ramp(1.0F), -0.01F);
    pictures.write("spectral.exr", ramp(1.0F),
                   {{{"variance.X", "variance.Y", "variance.Z"}, ramp(0.1F)}});
    const auto fault = [&](const char* picture, const char* reference,
                           ExactPicture exact = ExactPicture::none) {
        CompareCommand command = pictures.command(picture, reference);
        command.testsMeans = true;
        command.exact = exact;
        return faultOf(command);
    };
    const std::string missing =
        "plain.exr: has no layer variance.R, variance.G, variance.B (etendue render --layers "
        "variance writes it)";
    CHECK(fault("noisy.exr", "plain.exr") == missing);
    CHECK(fault("plain.exr", "noisy.exr") == missing);
    CHECK(fault("plain.exr", "plain.exr", ExactPicture::reference) == missing);
    CHECK(fault("noisy.exr", "single.exr") ==
          "single.exr: has variance 0 everywhere, as one of a single sample a pixel has, and says "
          "nothing of its noise");
    CHECK(fault("noisy.exr", "black.exr") ==
          "black.exr: has variance 0 everywhere, since it is black, and says nothing of its noise");
    CHECK(fault("noisy.exr", "spectral.exr").starts_with("spectral.exr: has variance.X"));
    CHECK(fault("noisy.exr", "negative.exr") == "negative.exr: a variance is negative");
    CHECK(fault("noisy.exr", "plain.exr", ExactPicture::reference) == "");
    CHECK(fault("plain.exr", "noisy.exr", ExactPicture::picture) == "");
}

TEST_CASE("Compare, as a user meets it: two renders with other seeds differ by their noise") {
    const Pictures pictures;
    const std::filesystem::path scene = pictures.folder.write("scene.toml", everyMaterialScene);
    std::string files;
    for (const char* seed : {"1", "2"}) {
        const std::string file = (pictures.folder / (std::string(seed) + ".exr")).string();
        REQUIRE(run("render " + scene.string() + " -o " + file +
                    " --size 16,12 --samples 16 --layers variance --quiet --seed " + seed)
                    .code == 0);
        files += " " + file;
    }
    const Outcome outcome = run(
        "compare" + files + " --z --tile 4 --max-relmse 1e-9 --max-mean-error 100 --max-flip 1");
    CHECK(outcome.code == 1);
    CHECK(contains(outcome.output, "by the variance layers"));
    CHECK(contains(outcome.output, "39 tests: p = "));
    CHECK(contains(outcome.output, ": not told apart\n"));
    CHECK(contains(outcome.output, "etendue: relMSE "));
    CHECK(contains(outcome.output, " exceeds --max-relmse 1e-09\n"));
    const Outcome wrong = run("compare a.exr b.exr --max-flip nan");
    CHECK(wrong.code == 64);
    CHECK(contains(wrong.output, "a number, 0 or more"));
}
