#include "tools/regress_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/text_table.h"

namespace etendue {

namespace {

constexpr double perCent = 100.0;

const char* wordFor(BiasVerdict verdict) {
    switch (verdict) {
        case BiasVerdict::unbiased:
            return "ok";
        case BiasVerdict::unbounded:
            return "no bound";
        case BiasVerdict::tooNoisy:
            return "TOO NOISY";
        case BiasVerdict::biased:
            break;
    }
    return "BIASED";
}

std::string wordForRate(const CellResult& cell) {
    if (!cell.judgesRate) return "not judged";
    return cell.rate == SlopeVerdict::pass           ? "ok"
           : cell.rate == SlopeVerdict::inconclusive ? "INCONCLUSIVE"
                                                     : "WRONG";
}

const char* wordForNoise(const CellResult& cell) {
    if (!cell.noiseBefore) return "NO BASELINE";
    return cell.noiseVerdict == NoiseVerdict::same    ? "ok"
           : cell.noiseVerdict == NoiseVerdict::worse ? "WORSE"
                                                      : "BETTER";
}

std::string boundText(const std::optional<double>& bound) {
    return bound ? fmt::format("{:g}", perCent * *bound) : "-";
}

std::vector<std::string> tableRow(const CellResult& c) {
    return {
        c.cell.scene,
        c.cell.camera,
        c.cell.estimator,
        fmt::format("{:+.2f} ± {:.2f}", perCent * c.bias.relativeBias, perCent * c.bias.halfWidth),
        boundText(c.biasBound),
        fmt::format("{:.2g}", c.bias.smallestP),
        wordFor(c.bias.verdict),
        fmt::format("{:.3f}", c.slope.slope),
        fmt::format("{:.3f}–{:.3f}", c.slope.interval.low, c.slope.interval.high),
        wordForRate(c),
        fmt::format("{:.4g}", c.noise.value),
        fmt::format("{:.4g}–{:.4g}", c.noise.interval.low, c.noise.interval.high),
        c.noiseBefore ? fmt::format("{:.4g}", c.noiseBefore->value) : "-",
        wordForNoise(c),
        fmt::format("{}", c.samples),
        fmt::format("{:.1f}", c.seconds)};
}

std::string titleOf(const PairResult& pair) {
    return fmt::format("{} against {}", titleOf(pair.cell), pair.other);
}

std::string biasText(const BiasJudgement& bias) {
    return fmt::format("bias {:+.3f} ± {:.3f} %, smallest p {:.2g}, level {:.2g}",
                       perCent * bias.relativeBias, perCent * bias.halfWidth, bias.smallestP,
                       bias.level);
}

void appendSection(std::string& text, const std::string& headline, const std::string& lines) {
    if (!lines.empty()) text += "\n" + headline + "\n" + lines;
}

Json jsonOf(const BiasJudgement& bias) {
    return Json::object({{"percent", perCent * bias.relativeBias},
                         {"half_width_percent", perCent * bias.halfWidth},
                         {"smallest_p", bias.smallestP},
                         {"level", bias.level},
                         {"tests_in_doubt", bias.testsInDoubt},
                         {"verdict", wordFor(bias.verdict)}});
}

Json jsonOf(const Interval& interval) { return Json::numbers({interval.low, interval.high}); }

Json jsonOf(const CellResult& c) {
    Json noise = Json::object({{"relmse_times_samples", c.noise.value},
                               {"interval", jsonOf(c.noise.interval)},
                               {"verdict", wordForNoise(c)}});
    if (c.noiseBefore) {
        noise.add("before", c.noiseBefore->value);
        noise.add("before_interval", jsonOf(c.noiseBefore->interval));
    }
    Json bias = jsonOf(c.bias);
    bias.add("bound_percent",
             c.biasBound ? std::optional<double>(perCent * *c.biasBound) : std::nullopt);
    return Json::object({{"scene", c.cell.scene},
                         {"camera", c.cell.camera},
                         {"estimator", c.cell.estimator},
                         {"samples", c.samples},
                         {"seconds", c.seconds},
                         {"bad_samples", c.badSamples},
                         {"is_reference_stale", c.isReferenceStale},
                         {"bias", bias},
                         {"rate", Json::object({{"slope", c.slope.slope},
                                                {"interval", jsonOf(c.slope.interval)},
                                                {"verdict", wordForRate(c)}})},
                         {"noise", noise},
                         {"outcome", outcomeOf(c)}});
}

}  // namespace

std::string outcomeOf(const CellResult& c) {
    std::string text;
    const auto append = [&](bool isBad, const std::string& word) {
        if (isBad) text += (text.empty() ? "" : ", ") + word;
    };
    append(c.isBiasBad(), fmt::format("bias {}", wordFor(c.bias.verdict)));
    append(c.isRateBad(), fmt::format("rate {}", wordForRate(c)));
    append(!c.noiseBefore || c.noiseVerdict != NoiseVerdict::same,
           fmt::format("noise {}", wordForNoise(c)));
    return text.empty() ? "pass" : text;
}

std::string regressText(const RegressResults& results) {
    std::vector<std::vector<std::string>> table{
        {"scene", "camera", "estimator", "bias %", "bound", "smallest p", "bias", "slope", "99 %",
         "rate", "noise", "99 %", "before", "noise", "samples", "seconds"}};
    std::string failed, between, stale, unjudgedRates, unbounded, bad;
    std::size_t failures = 0;
    for (const CellResult& c : results.cells) {
        table.push_back(tableRow(c));
        const std::string title = "  " + titleOf(c.cell);
        if (!c.passes()) ++failures;
        if (!c.passes()) failed += fmt::format("{}: {}\n", title, outcomeOf(c));
        if (c.isReferenceStale) stale += title + "\n";
        if (!c.judgesRate) unjudgedRates += title + "\n";
        if (!c.biasBound) unbounded += title + "\n";
        if (c.badSamples > 0) bad += fmt::format("{}: {}\n", title, c.badSamples);
    }
    for (const PairResult& pair : results.pairs)
        if (pair.bias.verdict == BiasVerdict::biased)
            between += fmt::format("  {}: {}\n", titleOf(pair), biasText(pair.bias));
    std::string text = alignedTable(table, "lllrrrlrrlrrrlrr");
    appendSection(text, "Failed:", failed);
    appendSection(text, "Estimators that differ:", between);
    appendSection(text, "Samples that were not finite or negative:", bad);
    appendSection(text, "Scenes that have changed since their reference was made:", stale);
    appendSection(text, "Rate not judged, by the baseline:", unjudgedRates);
    appendSection(text, "Bias without a bound, by the baseline:", unbounded);
    text += fmt::format(
        "\n{} of {} cells fail, {} of {} pairs of estimators differ{}. noise: relMSE × samples. "
        "Intervals of 99 %;\na bias' test rejects where p is below its level, which chance brings "
        "about in 1 % of all runs.\n",
        failures, results.cells.size(), std::ranges::count(between, '\n'), results.pairs.size(),
        results.isComplete ? "" : "; interrupted");
    return text;
}

Json regressJson(const RegressResults& results) {
    Json cells = Json::array(), pairs = Json::array(), failures = Json::array();
    for (const CellResult& cell : results.cells) cells.add(jsonOf(cell));
    for (const PairResult& pair : results.pairs) {
        Json object = Json::object({{"scene", pair.cell.scene},
                                    {"camera", pair.cell.camera},
                                    {"estimator", pair.cell.estimator},
                                    {"against", pair.other}});
        object.add("bias", jsonOf(pair.bias));
        pairs.add(object);
    }
    for (const RegressFailure& failure : results.failures)
        failures.add(Json::object({{"what", failure.what}, {"why", failure.why}}));
    return Json::object({{"is_complete", results.isComplete},
                         {"cells", cells},
                         {"pairs", pairs},
                         {"failures", failures}});
}

std::string rebaselineText(const std::vector<CellResult>& cells, const Baseline& after) {
    std::vector<std::vector<std::string>> table{{"scene", "camera", "estimator", "old", "99 %", "",
                                                 "new", "99 %", "change %", "bias bound %", "rate",
                                                 ""}};
    const auto interval = [](const Noise& noise) {
        return fmt::format("{:.4g}–{:.4g}", noise.interval.low, noise.interval.high);
    };
    for (const CellResult& c : cells) {
        std::vector<std::string> row{c.cell.scene, c.cell.camera, c.cell.estimator, "-", "", "→"};
        if (c.noiseBefore) {
            row[3] = fmt::format("{:.4g}", c.noiseBefore->value);
            row[4] = interval(*c.noiseBefore);
        }
        row.push_back(fmt::format("{:.4g}", c.noise.value));
        row.push_back(interval(c.noise));
        row.push_back(
            c.noiseBefore
                ? fmt::format("{:+.2f}", perCent * (c.noise.value / c.noiseBefore->value - 1.0))
                : "");
        const BaselineRow* kept = after.of(c.cell);
        row.push_back(kept ? boundText(kept->biasBound) : "");
        row.push_back(!kept ? "" : kept->judgesRate ? "judged" : "not judged");
        row.push_back(c.isSound() ? "" : "NOT TAKEN: " + outcomeOf(c));
        table.push_back(row);
    }
    return alignedTable(table, "lllrrlrrrrll");
}

}  // namespace etendue
