#include "lens/fit_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <stdexcept>

#include "lens/fit_check.h"
#include "lens/hash.h"
#include "lens/polynomial.h"

namespace etendue {

namespace {

using Json = nlohmann::json;

constexpr std::string_view partSuffix = ".part";
constexpr const char* formatName = "etendue lens fit 6";
constexpr std::uintmax_t largestFileBytes = 64u << 20;

struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

std::string hex(std::uint64_t number) {
    std::ostringstream text;
    text << std::hex << number;
    return text.str();
}

/// JSON knows no infinity: null stands for it.
Json jsonOf(double number) { return std::isinf(number) ? Json() : Json(number); }
Json jsonOf(const Eigen::Vector2d& v) { return Json::array({v.x(), v.y()}); }

double numberFrom(const Json& json) {
    return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
}
double numberAt(const Json& json, std::size_t index) { return json.at(index).get<double>(); }
Eigen::Vector2d vectorFrom(const Json& json) { return {numberAt(json, 0), numberAt(json, 1)}; }

/// A whole number in [lowest, highest], which get<int>() would not ask for.
int wholeFrom(const Json& json, int lowest, int highest) {
    if (!json.is_number_integer()) throw Refusal("a number is not whole");
    const std::int64_t number = json.get<std::int64_t>();
    if (number < lowest || number > highest) throw Refusal("a number is out of range");
    return static_cast<int>(number);
}

std::int64_t countFrom(const Json& json) {
    if (!json.is_number_integer()) throw Refusal("a count is not whole");
    const std::int64_t count = json.get<std::int64_t>();
    if (count < 0) throw Refusal("a count is out of range");
    return count;
}

Json jsonOf(const FitDomain& d) {
    return {{"sensor_half_size_mm", jsonOf(d.sensorHalfSizeMm)},
            {"image_radius_mm", jsonOf(d.imageRadiusMm)},
            {"sensor_distance_mm", d.sensorDistanceMm},
            {"aperture_radius_mm", d.apertureRadiusMm},
            {"wavelengths_nm", Json::array({d.shortestWavelengthNm, d.longestWavelengthNm})},
            {"sensor_travel_mm", d.sensorTravelMm}};
}
FitDomain domainFrom(const Json& json) {
    const Eigen::Vector2d wavelengths = vectorFrom(json.at("wavelengths_nm"));
    return {vectorFrom(json.at("sensor_half_size_mm")),
            numberFrom(json.at("image_radius_mm")),
            json.at("sensor_distance_mm").get<double>(),
            json.at("aperture_radius_mm").get<double>(),
            wavelengths.x(),
            wavelengths.y(),
            json.at("sensor_travel_mm").get<double>()};
}

Json jsonOf(const FitSettings& s) {
    return {{"form", static_cast<int>(s.form)},
            {"basis", static_cast<int>(s.basis)},
            {"terms", s.terms},
            {"degree", s.degree},
            {"rays_per_candidate", s.raysPerCandidate},
            {"refinements", s.refinements},
            {"clip_terms", s.clip.terms},
            {"clip_degree", s.clip.degree},
            {"clip_rays", s.clip.rays}};
}
FitSettings settingsFrom(const Json& json) {
    FitSettings s;
    s.form = static_cast<FitForm>(wholeFrom(json.at("form"), 0, 1));
    s.basis = static_cast<PolynomialBasis>(wholeFrom(json.at("basis"), 0, 3));
    s.terms = wholeFrom(json.at("terms"), 1, allTerms);
    s.degree = wholeFrom(json.at("degree"), 1, mostPower);
    s.raysPerCandidate = wholeFrom(json.at("rays_per_candidate"), 1, 1'000'000);
    s.refinements = wholeFrom(json.at("refinements"), 0, 1'000'000);
    s.clip.terms = wholeFrom(json.at("clip_terms"), 1, allTerms);
    s.clip.degree = wholeFrom(json.at("clip_degree"), 1, mostPower);
    s.clip.rays = static_cast<std::size_t>(wholeFrom(json.at("clip_rays"), 1, 100'000'000));
    return s;
}

Json jsonOf(const TermGroup& group) {
    Json rows = Json::array();
    for (Eigen::Index i = 0; i < group.coefficients.rows(); ++i) {
        Json row = Json::array();
        for (Eigen::Index t = 0; t < group.coefficients.cols(); ++t)
            row.push_back(group.coefficients(i, t));
        rows.push_back(std::move(row));
    }
    return {{"outputs", group.outputs}, {"terms", group.terms}, {"coefficients", std::move(rows)}};
}
TermGroup groupFrom(const Json& json, int outputs) {
    TermGroup group;
    for (const Json& output : json.at("outputs"))
        group.outputs.push_back(wholeFrom(output, 0, outputs - 1));
    for (const Json& term : json.at("terms")) {
        Exponents exponents;
        if (term.size() != exponents.size()) throw Refusal("a term has not five exponents");
        for (std::size_t i = 0; i < exponents.size(); ++i)
            exponents[i] = static_cast<std::uint8_t>(wholeFrom(term[i], 0, mostPower));
        group.terms.push_back(exponents);
    }
    const Json& rows = json.at("coefficients");
    if (rows.size() != group.outputs.size()) throw Refusal("rows of coefficients are missing");
    group.coefficients.resize(static_cast<Eigen::Index>(rows.size()),
                              static_cast<Eigen::Index>(group.terms.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].size() != group.terms.size()) throw Refusal("coefficients are missing");
        for (std::size_t t = 0; t < group.terms.size(); ++t)
            group.coefficients(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(t)) =
                rows[i][t].get<double>();
    }
    return group;
}

Json jsonOf(const SparsePolynomial& p) {
    Json groups = Json::array();
    for (const TermGroup& group : p.groups) groups.push_back(jsonOf(group));
    return {{"basis", static_cast<int>(p.basis)},
            {"vectors", p.outputs.vectors},
            {"scalars", p.outputs.scalars},
            {"scaling",
             Json::array({p.scaling.sensorScale, p.scaling.secondScale, p.scaling.coupling.x(),
                          p.scaling.coupling.y(), p.scaling.waveScale, p.scaling.waveOffset})},
            {"groups", std::move(groups)}};
}
SparsePolynomial polynomialFrom(const Json& json) {
    SparsePolynomial p;
    p.basis = static_cast<PolynomialBasis>(wholeFrom(json.at("basis"), 0, 3));
    p.outputs = {wholeFrom(json.at("vectors"), 0, mostOutputs),
                 wholeFrom(json.at("scalars"), 0, mostOutputs)};
    const Json& scaling = json.at("scaling");
    p.scaling = {numberAt(scaling, 0),
                 numberAt(scaling, 1),
                 {numberAt(scaling, 2), numberAt(scaling, 3)},
                 numberAt(scaling, 4),
                 numberAt(scaling, 5)};
    for (const Json& group : json.at("groups"))
        p.groups.push_back(groupFrom(group, p.outputs.total()));
    return p;
}

Json jsonOf(const ErrorSummary& e) { return Json::array({e.rms, e.percentile999, e.most}); }
ErrorSummary summaryFrom(const Json& json) {
    return {numberAt(json, 0), numberAt(json, 1), numberAt(json, 2)};
}

Json jsonOf(const FitErrors& e) {
    return {{"pupil_mm", jsonOf(e.pupilMm)},
            {"direction_mrad", jsonOf(e.directionMrad)},
            {"sensor_um", jsonOf(e.sensorMicrometres)},
            {"throughput_relative", jsonOf(e.throughputRelative)},
            {"etendue", jsonOf(e.etendue)},
            {"rays", e.rays},
            {"unsolved", e.unsolved}};
}
FitErrors errorsFrom(const Json& json) {
    return {summaryFrom(json.at("pupil_mm")),  summaryFrom(json.at("direction_mrad")),
            summaryFrom(json.at("sensor_um")), summaryFrom(json.at("throughput_relative")),
            summaryFrom(json.at("etendue")),   countFrom(json.at("rays")),
            countFrom(json.at("unsolved"))};
}

Json jsonOf(const RayCounts& c) {
    return {{"drawn", c.drawn},
            {"passed", c.passed},
            {"blocked", c.blocked},
            {"folded", c.folded},
            {"unsolved", c.unsolved},
            {"beside_pupil", c.besidePupil},
            {"folded_light", c.foldedLight}};
}
RayCounts countsFrom(const Json& json) {
    const auto count = [&](const char* key) { return countFrom(json.at(key)); };
    return {count("drawn"),
            count("passed"),
            count("blocked"),
            count("folded"),
            count("unsolved"),
            count("beside_pupil"),
            json.at("folded_light").get<double>()};
}

std::vector<std::size_t> surfacesFrom(const Json& json) {
    std::vector<std::size_t> surfaces;
    for (const Json& surface : json)
        surfaces.push_back(static_cast<std::size_t>(wholeFrom(surface, 0, 1000)));
    return surfaces;
}

Json jsonOf(const LensFit& fit) {
    return {{"algorithm", fit.algorithm},
            {"prescription", hex(fit.prescriptionHash)},
            {"domain", jsonOf(fit.domain)},
            {"settings", jsonOf(fit.settings)},
            {"exit", jsonOf(fit.exit)},
            {"aperture", jsonOf(fit.aperture)},
            {"clip",
             {{"surfaces", fit.clip.surfaces},
              {"reflecting", fit.clip.reflecting},
              {"squares", jsonOf(fit.clip.squares)},
              {"wrongly_accepted", fit.clipErrors.wronglyAccepted},
              {"wrongly_blocked", fit.clipErrors.wronglyBlocked}}},
            {"start",
             {{"sensor", jsonOf(fit.start.sensor)},
              {"nearness_bend", fit.start.nearnessBend},
              {"trusted_nearness", fit.start.trustedNearness},
              {"widest_field", fit.start.widestField},
              {"error_mm", fit.start.errorMm}}},
            {"slope", jsonOf(fit.slope)},
            {"training", jsonOf(fit.training)},
            {"errors", jsonOf(fit.errors)}};
}
LensFit fitFrom(const Json& json) {
    LensFit fit;
    fit.algorithm = wholeFrom(json.at("algorithm"), 0, 1'000'000);
    fit.prescriptionHash = std::stoull(json.at("prescription").get<std::string>(), nullptr, 16);
    fit.domain = domainFrom(json.at("domain"));
    fit.settings = settingsFrom(json.at("settings"));
    fit.exit = polynomialFrom(json.at("exit"));
    fit.aperture = polynomialFrom(json.at("aperture"));
    const Json& clip = json.at("clip");
    fit.clip.surfaces = surfacesFrom(clip.at("surfaces"));
    fit.clip.reflecting = surfacesFrom(clip.at("reflecting"));
    fit.clip.squares = polynomialFrom(clip.at("squares"));
    fit.clipErrors = {clip.at("wrongly_accepted").get<double>(),
                      clip.at("wrongly_blocked").get<double>()};
    const Json& start = json.at("start");
    fit.start = {polynomialFrom(start.at("sensor")), start.at("nearness_bend").get<double>(),
                 start.at("trusted_nearness").get<double>(), start.at("widest_field").get<double>(),
                 start.at("error_mm").get<double>()};
    fit.slope = polynomialFrom(json.at("slope"));
    fit.training = countsFrom(json.at("training"));
    fit.errors = errorsFrom(json.at("errors"));
    if (const auto fault = findFault(fit)) throw Refusal(*fault);
    return fit;
}

std::string contentOf(const std::filesystem::path& file) {
    std::error_code failed;
    const std::uintmax_t bytes = std::filesystem::file_size(file, failed);
    if (failed) throw Refusal("no such file");
    if (bytes > largestFileBytes) throw Refusal("too large to be a fit");
    std::ifstream stream(file, std::ios::binary);
    std::string text(std::istreambuf_iterator<char>(stream), {});
    if (text.empty()) throw Refusal("empty");
    return text;
}

/// A fit nests seven levels deep; what nests deeper is none.
bool isShallow(int depth, Json::parse_event_t, Json&) {
    if (depth > 12) throw Refusal("nested too deeply");
    return true;
}

LensFit parsed(const std::string& text) {
    try {
        const Json json = Json::parse(text, isShallow);
        if (!json.is_object() || json.value("format", "") != formatName)
            throw Refusal("not a lens fit of this version");
        const Json& body = json.at("fit");
        if (json.at("checksum") != hex(fnv1a(body.dump()))) throw Refusal("changed since written");
        return fitFrom(body);
    } catch (const Json::parse_error&) {
        throw Refusal("truncated, or no JSON");
    } catch (const std::exception& error) {
        throw Refusal(error.what());
    }
}

/// The system call again for as long as signals interrupt it.
template <class Call>
auto uninterrupted(const Call& call) {
    auto result = call();
    while (result < 0 && errno == EINTR) result = call();
    return result;
}

/// A new file beside `file`, of a name that no other process, thread or container takes.
struct PartFile {
    std::filesystem::path path;
    int descriptor;
};
PartFile newPartFile(const std::filesystem::path& file) {
    std::random_device random;
    for (int attempt = 0; attempt < 100; ++attempt) {
        std::filesystem::path path = file;
        path += "." + hex((std::uint64_t{random()} << 32) | random()) + std::string(partSuffix);
        const int descriptor = uninterrupted(
            [&] { return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644); });
        if (descriptor >= 0) return {path, descriptor};
        if (errno != EEXIST) break;
    }
    throw std::runtime_error(file.string() + ": cannot be written");
}

/// Closes the descriptor; false when not all is on the disk.
bool writeSynced(int descriptor, const std::string& text) {
    bool good = true;
    for (std::size_t done = 0; good && done < text.size();) {
        const ssize_t count = uninterrupted(
            [&] { return ::write(descriptor, text.data() + done, text.size() - done); });
        good = count > 0;
        if (good) done += static_cast<std::size_t>(count);
    }
    good = uninterrupted([&] { return ::fsync(descriptor); }) == 0 && good;
    return ::close(descriptor) == 0 && good;
}

}  // namespace

std::string fitFileText(const LensFit& fit) {
    Json body = jsonOf(fit);
    const std::string checksum = hex(fnv1a(body.dump()));
    const Json json = {{"format", formatName}, {"checksum", checksum}, {"fit", std::move(body)}};
    return json.dump() + "\n";
}

void writeFitFile(const std::filesystem::path& file, const LensFit& fit) {
    const PartFile part = newPartFile(file);
    std::error_code failed;
    const bool written = writeSynced(part.descriptor, fitFileText(fit));
    if (written) std::filesystem::rename(part.path, file, failed);
    if (written && !failed) return;
    std::filesystem::remove(part.path, failed);
    throw std::runtime_error(file.string() + ": cannot be written" +
                             (written ? "" : "; is the disk full?"));
}

void removeStaleParts(const std::filesystem::path& directory) {
    const auto dayAgo = std::filesystem::file_time_type::clock::now() - std::chrono::hours(24);
    std::error_code failed;
    std::filesystem::directory_iterator entry(directory, failed), end;
    for (; !failed && entry != end; entry.increment(failed)) {
        std::error_code ignored;
        if (entry->path().extension() != partSuffix) continue;
        const auto written = std::filesystem::last_write_time(entry->path(), ignored);
        if (!ignored && written < dayAgo) std::filesystem::remove(entry->path(), ignored);
    }
}

FitKey fitKey(const Prescription& prescription, const FitDomain& domain,
              const FitSettings& settings) {
    return {contentHash(prescription), domain, settings, fitAlgorithmVersion};
}

FitFileContent readFitFile(const std::filesystem::path& file) {
    try {
        return {parsed(contentOf(file)), {}};
    } catch (const Refusal& refusal) {
        return {{}, file.string() + ": " + refusal.what()};
    }
}

FitFileContent readFitFile(const std::filesystem::path& file, const FitKey& key) {
    FitFileContent content = readFitFile(file);
    if (!content.fit) return content;
    const LensFit& fit = *content.fit;
    const auto refuse = [&](const char* what) {
        return FitFileContent{{}, file.string() + ": stale: fitted " + what};
    };
    if (fit.algorithm != key.algorithm) return refuse("by another version of the method");
    if (fit.prescriptionHash != key.prescriptionHash) return refuse("to another prescription");
    if (fit.domain != key.domain) return refuse("in another domain");
    if (fit.settings != key.settings) return refuse("with other settings");
    return content;
}

}  // namespace etendue
