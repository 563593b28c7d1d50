// Fills the tables of docs/speed-accuracy.md from the results of three suites;
// tools/speed_accuracy.sh runs them and this.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "renderer/text_lines.h"
#include "tools/bench_records.h"
#include "tools/bench_summary.h"
#include "tools/write_file.h"

namespace etendue {
namespace {

constexpr std::array<double, 3> sampleCounts{16.0, 256.0, 4096.0};
/// Of the noise, that a fit may be off by.
constexpr double worthShare = 0.1;

struct Results {
    explicit Results(const std::filesystem::path& folder)
        : records(readBenchRecords(folder / "results.jsonl")),
          results(summarizeBench(records, 0.01)) {
        if (!records.header) throw InputError(folder.string() + ": no results of a benchmark");
    }
    BenchRecords records;
    std::vector<BenchResult> results;

    const BenchLens* lens(const std::string& camera, const std::string& variant) const {
        for (const BenchLens& l : records.lenses)
            if (l.camera == camera && l.variant == variant) return &l;
        return nullptr;
    }
    const BenchResult* find(const BenchConfiguration& wanted) const {
        for (const BenchResult& r : results)
            if (r.configuration == wanted) return &r;
        return nullptr;
    }
};

std::string rangeText(double low, double high) { return fmt::format("{:.2g} – {:.2g}", low, high); }

std::string figureText(const BenchFigure& f) {
    return fmt::format("{:.2f} ({:.2f} – {:.2f})", f.value, f.interval.low, f.interval.high);
}

/// An error that is not told from zero is told by what it is below.
std::string errorText(const BenchFitError& e) {
    return e.low > 0.0 ? fmt::format("{:.1e} ({:.1e} – {:.1e})", e.relMse, e.low, e.high)
                       : fmt::format("< {:.1e}", std::max(e.high, 0.0));
}
double mostOf(const BenchFitError& e) { return e.low > 0.0 ? e.relMse : std::max(e.high, 0.0); }

std::string fitTable(const Results& terms) {
    std::string text =
        "| scene | camera | terms | µm | ns a ray | ns a connection | relMSE of the picture | "
        "is the noise of … samples |\n|---|---|---:|---:|---:|---:|---|---:|\n";
    for (const BenchFitError& e : terms.records.fitErrors) {
        const BenchLens* lens = terms.lens(e.camera, e.variant);
        if (!lens || !lens->terms) continue;
        text += fmt::format("| {} | {} | {:.0f} | {:.2g} | {:.0f} | {:.0f} | {} | {}{:.1g} |\n",
                            e.scene, e.camera, *lens->terms, *lens->fitErrorMicrometres,
                            lens->rayNs, lens->connectNs, errorText(e), e.low > 0.0 ? "" : "> ",
                            e.noiseOfOneSample / mostOf(e));
    }
    return text;
}

/// The fewest terms whose error is below a tenth of the noise.
std::string worthTable(const Results& terms) {
    std::string text =
        "| scene | camera | noise of one sample | 16 samples | 256 samples | 4096 samples |\n"
        "|---|---|---:|---:|---:|---:|\n";
    std::vector<std::pair<std::string, std::string>> views;
    for (const BenchFitError& e : terms.records.fitErrors)
        if (views.empty() || views.back() != std::pair(e.scene, e.camera))
            views.emplace_back(e.scene, e.camera);
    for (const auto& [scene, camera] : views) {
        double noise = 0.0;
        std::map<double, double> errors;  // by terms
        for (const BenchFitError& e : terms.records.fitErrors)
            if (e.scene == scene && e.camera == camera) {
                noise = e.noiseOfOneSample;
                const BenchLens* lens = terms.lens(camera, e.variant);
                if (lens && lens->terms) errors[*lens->terms] = mostOf(e);
            }
        text += fmt::format("| {} | {} | {:.2g} |", scene, camera, noise);
        for (const double samples : sampleCounts) {
            std::string fewest = "traced";
            for (const auto& [count, error] : errors)
                if (error < worthShare * noise / samples) {
                    fewest = fmt::format("{:.0f}", count);
                    break;
                }
            text += fmt::format(" {} |", fewest);
        }
        text += "\n";
    }
    return text;
}

/// What representation = "auto" rests on: relMSE over the square of the shift, of 8 terms, whose
/// shift dominates.
std::string gradientTable(const Results& terms) {
    static const std::map<std::string, double> sensorMm{
        {"double-gauss", 36.0}, {"fisheye", 23.5}, {"fisheye-181", 23.5}, {"anamorphic", 22.0}};
    std::string text =
        "| scene | camera | shift / width of the picture, rms | relMSE / (shift / width)² |\n"
        "|---|---|---:|---:|\n";
    for (const BenchFitError& e : terms.records.fitErrors) {
        const BenchLens* lens = terms.lens(e.camera, e.variant);
        if (!lens || !lens->terms || *lens->terms != 8.0 || !sensorMm.contains(e.camera)) continue;
        const double shift = 1e-3 * *lens->fitErrorMicrometres / sensorMm.at(e.camera);
        const double square = shift * shift;
        text += fmt::format("| {} | {} | {:.1e} | {} |\n", e.scene, e.camera, shift,
                            e.low > 0.0 ? rangeText(e.low / square, e.high / square)
                                        : fmt::format("< {:.2g}", e.high / square));
    }
    return text;
}

std::string speedTable(const Results& lenses) {
    std::string text =
        "| camera | lens | ns a ray | ns a connection | pt | lt | bdpt |\n"
        "|---|---|---:|---:|---|---|---|\n";
    for (const BenchLens& lens : lenses.records.lenses) {
        if (lens.camera.ends_with("+dispersion")) continue;
        text += fmt::format("| {} | {} | {:.0f} | {:.0f} |", lens.camera,
                            lens.variant.empty() ? lens.description : lens.variant, lens.rayNs,
                            lens.connectNs);
        for (const char* estimator : {"pt", "lt", "bdpt"}) {
            const BenchResult* own =
                lenses.find({"fisheye-room", lens.camera, lens.variant, estimator});
            // The first of the view is pt with 40 terms; each estimator is to be held against
            // itself.
            const BenchResult* base = lenses.find(
                {"fisheye-room", lens.camera, lens.variant.empty() ? "" : "40 terms", estimator});
            text += own && base
                        ? fmt::format(" {:.2f} |", own->efficiency.value / base->efficiency.value)
                        : " – |";
        }
        text += "\n";
    }
    return text;
}

std::string estimatorTable(const Results& estimators) {
    std::string text =
        "| scene | pt: relMSE of one sample | lt / pt | bdpt / pt | best |\n"
        "|---|---:|---|---|---|\n";
    std::set<std::string> seen;
    for (const BenchResult& first : estimators.results) {
        const BenchConfiguration& c = first.configuration;
        if (!seen.insert(c.scene).second) continue;
        const BenchResult* best = &first;
        std::map<std::string, const BenchResult*> of;
        for (const BenchResult& r : estimators.results)
            if (r.configuration.scene == c.scene) {
                of[r.configuration.estimator] = &r;
                if (r.efficiency.value > best->efficiency.value) best = &r;
            }
        const auto ratio = [&](const char* name) {
            return of.contains(name) ? figureText(of[name]->ratio) : std::string("–");
        };
        text += fmt::format("| {} | {:.2g} | {} | {} | {} |\n", c.scene,
                            first.relMse.value * first.samples, ratio("lt"), ratio("bdpt"),
                            best->configuration.estimator);
    }
    return text;
}

/// Errors of both at equal time against the picture with dispersion.
std::string dispersionTable(const Results& lenses) {
    std::string text =
        "| camera | estimator | relMSE with dispersion | without |\n|---|---|---:|---:|\n";
    for (const BenchResult& with : lenses.results) {
        BenchConfiguration c = with.configuration;
        if (c.variant != "dispersion") continue;
        c.variant = "no dispersion";
        if (const BenchResult* without = lenses.find(c))
            text += fmt::format("| {} | {} | {:.2g} | {:.2g} |\n", c.camera, c.estimator,
                                with.relMse.value, without->relMse.value);
    }
    return text;
}

/// Replaces what stands between "<!-- NAME -->" and "<!-- /NAME -->".
void fill(std::string& document, const std::string& name, const std::string& table) {
    const std::string begin = fmt::format("<!-- {} -->\n", name),
                      end = fmt::format("<!-- /{} -->", name);
    const std::size_t from = document.find(begin), to = document.find(end);
    if (from == std::string::npos || to == std::string::npos)
        throw InputError(fmt::format("the document has no place for \"{}\"", name));
    document.replace(from + begin.size(), to - from - begin.size(), "\n" + table + "\n");
}

std::string machineText(const Results& r) {
    const BenchHeader& h = *r.records.header;
    return fmt::format("Measured on {} ({}), {} threads, {}, {} build, load {:.1f}.\n", h.processor,
                       h.started.substr(0, 10), h.threads, h.isa, h.build, h.load);
}

void run(const std::filesystem::path& file, const std::array<std::filesystem::path, 3>& folders) {
    const Results terms(folders[0]), lenses(folders[1]), estimators(folders[2]);
    std::string document = readText(file);
    fill(document, "machine", machineText(estimators));
    fill(document, "fits", fitTable(terms));
    fill(document, "worth", worthTable(terms));
    fill(document, "gradients", gradientTable(terms));
    fill(document, "speed", speedTable(lenses));
    fill(document, "estimators", estimatorTable(estimators));
    fill(document, "dispersion", dispersionTable(lenses));
    writeWholeFile(file, document);
}

}  // namespace
}  // namespace etendue

/// Arguments: the document, then the folders of the suites lens-terms, lenses and estimators.
int main(int argc, char** argv) {
    if (argc != 5) {
        fmt::print(stderr, "usage: speed_accuracy DOCUMENT LENS-TERMS LENSES ESTIMATORS\n");
        return 64;
    }
    try {
        etendue::run(argv[1], {argv[2], argv[3], argv[4]});
    } catch (const std::exception& error) {
        fmt::print(stderr, "speed_accuracy: {}\n", error.what());
        return 1;
    }
    return 0;
}
