#include "tools/bench_report.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <map>

#include "renderer/image_io.h"
#include "renderer/mis.h"
#include "tools/bench_page.h"

namespace etendue {

namespace {

std::string base64(const std::vector<std::uint8_t>& bytes) {
    constexpr const char* digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto at = [&](std::size_t k) {
            return k < bytes.size() ? std::uint32_t{bytes[k]} : 0u;
        };
        const std::uint32_t group = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
        for (std::size_t d = 0; d < 4; ++d)
            text += d > bytes.size() - i ? '=' : digits[group >> (18 - 6 * d) & 63];
    }
    return text;
}

/// IEEE half floats, little-endian, of what is not above their range.
std::string halvesOf(const Picture& picture) {
    std::vector<std::uint8_t> bytes;
    for (const float value : picture) {
        const auto bits = Eigen::half(std::min(value, 65504.0f)).x;
        bytes.push_back(static_cast<std::uint8_t>(bits & 0xff));
        bytes.push_back(static_cast<std::uint8_t>(bits >> 8));
    }
    return base64(bytes);
}

/// The pictures of a report, each with its number.
class Pictures {
public:
    /// Null where the picture is not there.
    Json add(const std::optional<Image>& image) {
        if (!image) return nullptr;
        return add(image->width, image->height, std::get<std::vector<float>>(image->pixels));
    }
    Json add(int width, int height, const Picture& pixels) {
        pictures_.push_back(
            Json::object({{"width", width}, {"height", height}, {"half", halvesOf(pixels)}}));
        return static_cast<int>(pictures_.size()) - 1;
    }
    Json all() const { return Json::array(pictures_); }

private:
    std::vector<Json> pictures_;
};

bool isThere(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::is_regular_file(file, error);
}

std::optional<Image> imageAt(const std::filesystem::path& file) {
    return isThere(file) ? std::optional(readImage(file)) : std::nullopt;
}

/// The mean over the seeds.
std::optional<Image> meanPicture(const BenchFolder& folder, const BenchConfiguration& configuration,
                                 int seeds) {
    std::optional<Image> mean;
    int count = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const std::optional<Image> image = imageAt(folder.picture(configuration, seed));
        if (!image) continue;
        ++count;
        if (!mean) {
            mean = image;
            continue;
        }
        auto& sum = std::get<std::vector<float>>(mean->pixels);
        const auto& pixels = std::get<std::vector<float>>(image->pixels);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += pixels[i];
    }
    if (mean)
        for (float& value : std::get<std::vector<float>>(mean->pixels))
            value /= static_cast<float>(count);
    return mean;
}

Json techniquesOf(const BenchView& view, const BenchSuite& suite, const BenchFolder& folder,
                  Pictures& pictures) {
    Json images = Json::array();
    const std::filesystem::path file = folder.techniques(view.scene.name, view.camera.name);
    for (int length = 2; isThere(file) && length <= 8; ++length)
        for (int s = 0; s < length; ++s) {
            const std::string name = nameOf(Technique{s, length - s});
            const auto layer = [&](const std::string& prefix) {
                return readExrChannels(file, {prefix + ".R", prefix + ".G", prefix + ".B"});
            };
            const auto weighted = layer(name), unweighted = layer(name + ".unweighted");
            if (!weighted || !unweighted) continue;
            images.add(Json::object(
                {{"s", s},
                 {"t", length - s},
                 {"picture", pictures.add(suite.width, suite.height, weighted->pixels)},
                 {"unweighted", pictures.add(suite.width, suite.height, unweighted->pixels)}}));
        }
    return images;
}

Json jsonOf(const BenchPoint& p, Json flip) {
    return Json::object({{"samples", p.samples},
                         {"seconds", p.seconds},
                         {"relMse", p.relMse.value},
                         {"relMseLow", p.relMse.interval.low},
                         {"relMseHigh", p.relMse.interval.high},
                         {"relMseTrimmed", p.errors.relMseTrimmed},
                         {"mse", p.errors.mse},
                         {"mae", p.errors.mae},
                         {"meanError", p.errors.meanError},
                         {"meanErrorHalfWidth", p.meanErrorHalfWidth},
                         {"flip", std::move(flip)}});
}

void addFigure(Json& json, const std::string& name, const std::optional<BenchFigure>& figure) {
    json.add(name, figure ? Json(figure->value) : Json(nullptr));
    json.add(name + "Low", figure ? Json(figure->interval.low) : Json(nullptr));
    json.add(name + "High", figure ? Json(figure->interval.high) : Json(nullptr));
}

Json jsonOf(const BenchResult& r) {
    Json curve = Json::array();
    for (const BenchPoint& point : r.curve)
        curve.add(jsonOf(point, &point == &r.curve.back() ? Json(r.flip) : Json(nullptr)));
    Json json = Json::object({{"scene", r.configuration.scene},
                              {"camera", r.configuration.camera},
                              {"variant", r.configuration.variant},
                              {"estimator", r.configuration.estimator},
                              {"curve", curve}});
    addFigure(json, "slope", r.slope);
    addFigure(json, "efficiency", r.efficiency);
    addFigure(json, "secondsToTarget", r.secondsToTarget);
    json.add("isExtrapolated", r.isExtrapolated);
    addFigure(json, "efficiencyRatio", r.ratio);
    if (r.equalSamples)
        json.add("equalSamples", Json::object({{"samples", r.equalSamples->samples},
                                               {"relMse", r.equalSamples->relMse.value}}));
    json.add("equalTime", Json::object({{"seconds", r.seconds},
                                        {"samples", r.samples},
                                        {"relMse", r.relMse.value},
                                        {"relMseLow", r.relMse.interval.low},
                                        {"relMseHigh", r.relMse.interval.high}}));
    json.add("flip", r.flip);
    json.add("isBelowReference", r.isBelowReference);
    json.add("badSamples", r.badSamples);
    return json;
}

Json jsonOf(const BenchReference& reference, const std::vector<BenchResult>& results,
            Json picture) {
    double smallest = std::numeric_limits<double>::infinity();
    bool isTooNoisy = false;
    for (const BenchResult& r : results)
        if (r.configuration.scene == reference.scene &&
            r.configuration.camera == reference.camera) {
            smallest = std::min(smallest, r.relMse.value);
            isTooNoisy = isTooNoisy || r.isBelowReference;
        }
    return Json::object(
        {{"scene", reference.scene},
         {"camera", reference.camera},
         {"estimator", reference.estimator},
         {"samples", reference.samples},
         {"seconds", reference.seconds},
         {"relMse", reference.relMse},
         {"isTooNoisy", isTooNoisy},
         {"verdict", fmt::format("its own error is {:.2g} % of the smallest measured with it",
                                 100.0 * reference.relMse / smallest)},
         {"picture", std::move(picture)}});
}

Json jsonOf(const BenchLens& l) {
    return Json::object({{"camera", l.camera},
                         {"variant", l.variant},
                         {"description", l.description},
                         {"terms", l.terms},
                         {"fitErrorMrad", l.fitErrorMrad},
                         {"fitErrorMicrons", l.fitErrorMicrometres},
                         {"rayNs", l.rayNs},
                         {"connectNs", l.connectNs}});
}

Json jsonOf(const BenchFitError& e) {
    return Json::object({{"scene", e.scene},
                         {"camera", e.camera},
                         {"variant", e.variant},
                         {"relMse", e.relMse},
                         {"relMseLow", e.low},
                         {"relMseHigh", e.high}});
}

}  // namespace

Json benchReportData(const BenchSuite& suite, const BenchRecords& records,
                     const std::vector<BenchResult>& results, const BenchFolder& folder,
                     bool isComplete) {
    Pictures pictures;
    const BenchHeader header = records.header.value_or(BenchHeader{});
    Json references = Json::array(), lenses = Json::array(), measured = Json::array(),
         techniques = Json::array(), fitErrors = Json::array();
    for (const BenchReference& r : records.references)
        references.add(
            jsonOf(r, results, pictures.add(imageAt(folder.referencePicture(r.scene, r.camera)))));
    for (const BenchLens& lens : records.lenses) lenses.add(jsonOf(lens));
    for (const BenchFitError& error : records.fitErrors) fitErrors.add(jsonOf(error));
    for (const BenchResult& result : results) {
        Json json = jsonOf(result);
        json.add("picture", pictures.add(meanPicture(folder, result.configuration, suite.seeds)));
        measured.add(std::move(json));
    }
    for (const BenchView& view : suite.views)
        if (isThere(folder.techniques(view.scene.name, view.camera.name)))
            techniques.add(Json::object({{"scene", view.scene.name},
                                         {"camera", view.camera.name},
                                         {"images", techniquesOf(view, suite, folder, pictures)}}));
    return Json::object({{"title", suite.title},
                         {"command", header.command},
                         {"version", header.version},
                         {"started", header.started},
                         {"settings", Json::object({{"width", suite.width},
                                                    {"height", suite.height},
                                                    {"seeds", suite.seeds},
                                                    {"seconds", suite.seconds},
                                                    {"samples", suite.mostSamples},
                                                    {"targetRelMse", suite.targetRelMse},
                                                    {"threads", header.threads}})},
                         {"machine", Json::object({{"processor", header.processor},
                                                   {"cores", header.cores},
                                                   {"isa", header.isa},
                                                   {"compiler", header.compiler},
                                                   {"build", header.build},
                                                   {"system", header.system},
                                                   {"load", header.load}})},
                         {"isComplete", isComplete},
                         {"references", references},
                         {"lenses", lenses},
                         {"fitErrors", fitErrors},
                         {"results", measured},
                         {"techniques", techniques},
                         {"pictures", pictures.all()}});
}

std::string benchReport(const BenchSuite& suite, const BenchRecords& records,
                        const std::vector<BenchResult>& results, const BenchFolder& folder,
                        bool isComplete) {
    return benchPage(benchReportData(suite, records, results, folder, isComplete).line());
}

}  // namespace etendue
