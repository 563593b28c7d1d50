#include "tools/bench_records.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "config/config.h"
#include "tools/json.h"

namespace etendue {

namespace {

using Parsed = nlohmann::json;

// What is written.

Json jsonOf(const BenchHeader& h) {
    return Json::object({{"kind", "suite"},
                         {"title", h.title},
                         {"key", h.key},
                         {"command", h.command},
                         {"version", h.version},
                         {"started", h.started},
                         {"processor", h.processor},
                         {"cores", h.cores},
                         {"isa", h.isa},
                         {"compiler", h.compiler},
                         {"build", h.build},
                         {"system", h.system},
                         {"threads", h.threads},
                         {"load", h.load}});
}

Json jsonOf(const BenchReference& r) {
    return Json::object({{"kind", "reference"},
                         {"scene", r.scene},
                         {"camera", r.camera},
                         {"estimator", r.estimator},
                         {"key", r.key},
                         {"samples", r.samples},
                         {"seconds", r.seconds},
                         {"relMse", r.relMse}});
}

Json jsonOf(const BenchLens& l) {
    return Json::object({{"kind", "lens"},
                         {"camera", l.camera},
                         {"variant", l.variant},
                         {"description", l.description},
                         {"terms", l.terms},
                         {"fitErrorMrad", l.fitErrorMrad},
                         {"fitErrorMicrometres", l.fitErrorMicrometres},
                         {"rayNs", l.rayNs},
                         {"connectNs", l.connectNs}});
}

Json jsonOf(const BenchFitError& e) {
    return Json::object({{"kind", "fitError"},
                         {"scene", e.scene},
                         {"camera", e.camera},
                         {"variant", e.variant},
                         {"relMse", e.relMse},
                         {"low", e.low},
                         {"high", e.high},
                         {"noiseOfOneSample", e.noiseOfOneSample}});
}

Json jsonOf(const BenchCheckpoint& c) {
    return Json::object({{"samples", c.samples},
                         {"seconds", c.seconds},
                         {"mse", c.errors.mse},
                         {"relMse", c.errors.relMse},
                         {"relMseTrimmed", c.errors.relMseTrimmed},
                         {"mae", c.errors.mae},
                         {"meanError", c.errors.meanError}});
}

Json jsonOf(const BenchRun& r) {
    Json checkpoints = Json::array();
    for (const BenchCheckpoint& c : r.checkpoints) checkpoints.add(jsonOf(c));
    return Json::object({{"kind", "run"},
                         {"scene", r.configuration.scene},
                         {"camera", r.configuration.camera},
                         {"variant", r.configuration.variant},
                         {"estimator", r.configuration.estimator},
                         {"seed", r.seed},
                         {"sceneHash", r.sceneHash},
                         {"load", r.load},
                         {"badSamples", r.badSamples},
                         {"flip", r.flip},
                         {"checkpoints", checkpoints}});
}

void append(const std::filesystem::path& file, const Json& json) {
    const std::string line = json.line() + "\n";
    const auto fail = [&] {
        throw std::system_error(errno, std::generic_category(), file.string() + ": cannot write");
    };
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
    if (descriptor < 0) fail();
    std::size_t written = 0;
    while (written < line.size()) {
        const ssize_t n = write(descriptor, line.data() + written, line.size() - written);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            const int reason = errno;
            close(descriptor);
            errno = reason;
            fail();
        }
        written += static_cast<std::size_t>(n);
    }
    if (fsync(descriptor) != 0 || close(descriptor) != 0) fail();
}

// What is read. Everything here throws nlohmann's errors, which name the key.

std::string text(const Parsed& json, const char* key) { return json.at(key).get<std::string>(); }

std::optional<double> optionalNumber(const Parsed& json, const char* key) {
    const Parsed& value = json.at(key);
    return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

/// Null stands for what JSON cannot say.
double number(const Parsed& json, const char* key) {
    return optionalNumber(json, key).value_or(std::numeric_limits<double>::quiet_NaN());
}

BenchHeader headerFrom(const Parsed& j) {
    BenchHeader h{text(j, "title"),   text(j, "key"),       text(j, "command"), text(j, "version"),
                  text(j, "started"), text(j, "processor"), text(j, "isa"),     text(j, "compiler"),
                  text(j, "build"),   text(j, "system")};
    h.cores = j.at("cores").get<int>();
    h.threads = j.at("threads").get<int>();
    h.load = number(j, "load");
    return h;
}

BenchReference referenceFrom(const Parsed& j) {
    return {text(j, "scene"),
            text(j, "camera"),
            text(j, "estimator"),
            text(j, "key"),
            j.at("samples").get<std::uint64_t>(),
            number(j, "seconds"),
            number(j, "relMse")};
}

BenchLens lensFrom(const Parsed& j) {
    return {text(j, "camera"),
            text(j, "variant"),
            text(j, "description"),
            optionalNumber(j, "terms"),
            optionalNumber(j, "fitErrorMrad"),
            optionalNumber(j, "fitErrorMicrometres"),
            number(j, "rayNs"),
            number(j, "connectNs")};
}

BenchFitError fitErrorFrom(const Parsed& j) {
    return {text(j, "scene"), text(j, "camera"), text(j, "variant"),           number(j, "relMse"),
            number(j, "low"), number(j, "high"), number(j, "noiseOfOneSample")};
}

BenchRun runFrom(const Parsed& j) {
    BenchRun run{{text(j, "scene"), text(j, "camera"), text(j, "variant"), text(j, "estimator")},
                 j.at("seed").get<int>(),
                 text(j, "sceneHash"),
                 number(j, "load"),
                 j.at("badSamples").get<std::uint64_t>(),
                 number(j, "flip"),
                 {}};
    for (const Parsed& c : j.at("checkpoints"))
        run.checkpoints.push_back(
            {c.at("samples").get<std::uint32_t>(), number(c, "seconds"),
             ImageErrors{number(c, "mse"), number(c, "relMse"), number(c, "relMseTrimmed"),
                         number(c, "mae"), number(c, "meanError")}});
    return run;
}

void take(const Parsed& json, BenchRecords& records) {
    const std::string kind = text(json, "kind");
    if (kind == "suite")
        records.header = headerFrom(json);
    else if (kind == "reference")
        records.references.push_back(referenceFrom(json));
    else if (kind == "lens")
        records.lenses.push_back(lensFrom(json));
    else if (kind == "fitError")
        records.fitErrors.push_back(fitErrorFrom(json));
    else if (kind == "run")
        records.runs.push_back(runFrom(json));
    else
        throw std::invalid_argument(fmt::format("no record is of the kind \"{}\"", kind));
}

bool isLastRunThereTwice(const BenchRecords& records) {
    if (records.runs.empty()) return false;
    const BenchRun& last = records.runs.back();
    return records.find(last.configuration, last.seed) != &last;
}

}  // namespace

std::string titleOf(const BenchConfiguration& c) {
    return fmt::format("{}, {}, {}{}{}", c.scene, c.camera, c.variant,
                       c.variant.empty() ? "" : ", ", c.estimator);
}

const BenchRun* BenchRecords::find(const BenchConfiguration& configuration, int seed) const {
    for (const BenchRun& run : runs)
        if (run.seed == seed && run.configuration == configuration) return &run;
    return nullptr;
}

BenchRecords readBenchRecords(const std::filesystem::path& file) {
    BenchRecords records;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return records;
    std::ostringstream all;
    all << stream.rdbuf();
    const std::string bytes = all.str();
    std::size_t begin = 0, line = 1;
    for (std::size_t end; (end = bytes.find('\n', begin)) != std::string::npos; begin = end + 1) {
        try {
            take(Parsed::parse(bytes.substr(begin, end - begin)), records);
        } catch (const std::exception& error) {
            throw InputError(fmt::format("{}:{}: not a record of a benchmark: {}", file.string(),
                                         line, error.what()));
        }
        if (isLastRunThereTwice(records))
            throw InputError(
                fmt::format("{}:{}: {}, seed {} is there twice; take another folder or remove this "
                            "one",
                            file.string(), line, titleOf(records.runs.back().configuration),
                            records.runs.back().seed));
        ++line;
    }
    if (begin != bytes.size()) std::filesystem::resize_file(file, begin);
    return records;
}

void appendRecord(const std::filesystem::path& file, const BenchHeader& header) {
    append(file, jsonOf(header));
}
void appendRecord(const std::filesystem::path& file, const BenchReference& reference) {
    append(file, jsonOf(reference));
}
void appendRecord(const std::filesystem::path& file, const BenchLens& lens) {
    append(file, jsonOf(lens));
}
void appendRecord(const std::filesystem::path& file, const BenchFitError& error) {
    append(file, jsonOf(error));
}
void appendRecord(const std::filesystem::path& file, const BenchRun& run) {
    append(file, jsonOf(run));
}

namespace {

/// As RFC 4180 quotes.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + '"';
}

}  // namespace

std::string csvOf(const std::vector<BenchRun>& runs) {
    std::string csv =
        "scene,camera,variant,estimator,seed,samples,seconds,mse,relMse,relMseTrimmed,mae,"
        "meanError\n";
    for (const BenchRun& run : runs)
        for (const BenchCheckpoint& c : run.checkpoints)
            csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n",
                               quoted(run.configuration.scene), quoted(run.configuration.camera),
                               quoted(run.configuration.variant), run.configuration.estimator,
                               run.seed, c.samples, c.seconds, c.errors.mse, c.errors.relMse,
                               c.errors.relMseTrimmed, c.errors.mae, c.errors.meanError);
    return csv;
}

}  // namespace etendue
