// A benchmark's results as a table for the terminal.
#include <fmt/format.h>

#include <cmath>

#include "tools/bench_summary.h"
#include "tools/text_table.h"

namespace etendue {

namespace {

/// A dash for what is no number, such as the ratio of two efficiencies without an error.
std::string figureText(const BenchFigure& figure) {
    if (std::isnan(figure.value)) return "–";
    return fmt::format("{:.3g} ({:.3g} – {:.3g})", figure.value, figure.interval.low,
                       figure.interval.high);
}

}  // namespace

std::string benchText(const std::vector<BenchResult>& results, const BenchRecords& records,
                      double targetRelMse) {
    std::vector<std::vector<std::string>> rows{{"scene", "camera", "variant", "estimator", "spp",
                                                "relMSE", "efficiency, to the first",
                                                fmt::format("s to {:g}", targetRelMse), "slope"}};
    bool isAnyBelow = false;
    for (const BenchResult& r : results) {
        isAnyBelow = isAnyBelow || r.isBelowReference;
        const BenchConfiguration& c = r.configuration;
        rows.push_back({c.scene, c.camera, c.variant, c.estimator, fmt::format("{:.0f}", r.samples),
                        figureText(r.relMse) + (r.isBelowReference ? " *" : ""),
                        figureText(r.ratio),
                        r.secondsToTarget ? fmt::format("{:.3g}{}", r.secondsToTarget->value,
                                                        r.isExtrapolated ? " (extrapolated)" : "")
                                          : "–",
                        r.slope ? fmt::format("{:.2f}", r.slope->value) : "–"});
    }
    std::string text = alignedTable(rows, "llllrrrrr");
    text +=
        "\nrelMSE after equal time; efficiency 1 / (relMSE · time); in brackets 95 %, by a "
        "bootstrap over the seeds\n";
    if (isAnyBelow)
        text += "* the reference's own error is above a tenth of this: too noisy to judge it by\n";
    for (const BenchResult& r : results)
        if (r.badSamples > 0)
            text += fmt::format("{} samples of {}, {}, {} were not finite or negative\n",
                                r.badSamples, r.configuration.scene, r.configuration.camera,
                                r.configuration.estimator);
    for (const BenchFitError& e : records.fitErrors)
        text += fmt::format("fit of {}, {}{}{}: relMSE of the picture {:.2g} ({:.2g} – {:.2g})\n",
                            e.scene, e.camera, e.variant.empty() ? "" : ", ", e.variant, e.relMse,
                            e.low, e.high);
    for (const BenchReference& r : records.references)
        text += fmt::format("reference {}, {}: {} {} samples in {:.0f} s, relMSE {:.2g}\n", r.scene,
                            r.camera, r.estimator, r.samples, r.seconds, r.relMse);
    return text;
}

}  // namespace etendue
