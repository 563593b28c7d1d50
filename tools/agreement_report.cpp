#include "tools/agreement_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "statistics/statistics.h"
#include "tools/progress.h"
#include "tools/text_table.h"

namespace etendue {

namespace {

constexpr double perCent = 100.0;

/// Of a row without a result.
std::string wordFor(const AgreementRow& row) {
    if (row.isIncomplete) return "not complete";
    return row.failure.empty() ? "not reached" : "not done";
}

/// Empty where it is known, or no time would tell.
std::string timeToTell(const Agreement& agreement, double bound) {
    const double seconds = secondsToTell(agreement, bound);
    if (agreement.verdict != Verdict::tooNoisy || !std::isfinite(seconds)) return "";
    return formatDuration(seconds);
}

std::vector<std::string> tableRow(const AgreementRow& row, double bound) {
    std::vector<std::string> cells{row.scene, row.camera, row.estimator, row.reference};
    if (!row.result) {
        const std::string word = wordFor(row);
        cells.insert(cells.end(), {"", "", "", word, "", "", "", ""});
        return cells;
    }
    const Agreement& r = *row.result;
    const PictureComparison& c = r.comparison;
    if (r.verdict == Verdict::nothingCommon)
        cells.insert(cells.end(), {"", "", ""});
    else
        cells.insert(cells.end(), {fmt::format("{:+.3f}", perCent * c.relativeBias),
                                   fmt::format("{:.3f}", perCent * c.relativeBiasHalfWidth),
                                   fmt::format("{:.2g}", c.smallestP)});
    cells.insert(cells.end(), {nameOf(r.verdict), fmt::format("{}", r.tested.samples),
                               fmt::format("{}", r.reference.samples),
                               fmt::format("{:.1f}", r.seconds), timeToTell(r, bound)});
    return cells;
}

/// Every share is of the light that this side sees.
void appendLeftOut(const AgreementRow& row, const AgreementSide& side, std::string& text) {
    for (std::size_t i = 0; i < pathClassCount; ++i)
        if (side.leftOut[i] > 0.0)
            text += fmt::format("  {}: {:.3g} % of {}'s light: {}\n", titleOf(row),
                                perCent * side.leftOut[i], side.estimator,
                                describe(static_cast<PathClass>(i)));
}

void appendDefects(const AgreementRow& row, const AgreementSide& side, std::string& text) {
    const BadSamples& bad = side.bad;
    if (bad.count > 0)
        text += fmt::format(
            "  {}: {} samples of {} were not finite or negative; the first: --pixel {},{} --sample "
            "{} --seed {} --estimator {} of etendue replay\n",
            titleOf(row), bad.count, side.estimator, bad.first.x, bad.first.y, bad.first.sample,
            bad.seed, side.estimator);
    if (bad.refusedRays > 0)
        text += fmt::format("  {}: {} rays of {} had no finite place and met nothing\n",
                            titleOf(row), bad.refusedRays, side.estimator);
}

/// Under a headline, if there is anything.
void appendSection(std::string& text, const std::string& headline, const std::string& lines) {
    if (!lines.empty()) text += "\n" + headline + "\n" + lines;
}

Json jsonOf(const AgreementSide& side) {
    Json leftOut = Json::array();
    for (std::size_t i = 0; i < pathClassCount; ++i)
        if (side.leftOut[i] > 0.0)
            leftOut.add(Json::object({{"paths", describe(static_cast<PathClass>(i))},
                                      {"percent", perCent * side.leftOut[i]}}));
    return Json::object({{"estimator", side.estimator},
                         {"samples", side.samples},
                         {"left_out", leftOut},
                         {"bad_samples", side.bad.count},
                         {"refused_rays", side.bad.refusedRays}});
}

Json jsonOf(const AgreementRow& row, double bound) {
    Json object = Json::object({{"scene", row.scene}, {"camera", row.camera}});
    if (!row.result) {
        object.add("estimator", row.estimator);
        object.add("reference", row.reference);
        object.add("verdict", wordFor(row));
        if (!row.failure.empty()) object.add("failure", row.failure);
        return object;
    }
    const Agreement& r = *row.result;
    object.add("tested", jsonOf(r.tested));
    object.add("reference", jsonOf(r.reference));
    object.add("verdict", nameOf(r.verdict));
    object.add("bias_percent", perCent * r.comparison.relativeBias);
    object.add("half_width_percent", perCent * r.comparison.relativeBiasHalfWidth);
    object.add("tests_in_doubt", r.testsInDoubt);
    object.add("smallest_p", r.comparison.smallestP);
    object.add("level", r.comparison.level);
    object.add("seconds", r.seconds);
    if (r.verdict == Verdict::tooNoisy) object.add("seconds_to_tell", secondsToTell(r, bound));
    return object;
}

}  // namespace

std::string titleOf(const AgreementRow& row) {
    return fmt::format("{}, {}, {} against {}", row.scene, row.camera, row.estimator,
                       row.reference);
}

std::string outcomeOf(const AgreementRow& row) {
    if (!row.result) return row.failure;
    const Agreement& r = *row.result;
    if (r.verdict == Verdict::nothingCommon) return nameOf(r.verdict);
    return fmt::format("{}, {:+.3f} ± {:.3f} %", nameOf(r.verdict),
                       perCent * r.comparison.relativeBias,
                       perCent * r.comparison.relativeBiasHalfWidth);
}

std::string agreementText(const std::vector<AgreementRow>& rows,
                          const AgreementSettings& settings) {
    std::vector<std::vector<std::string>> table{{"scene", "camera", "tested", "against", "bias %",
                                                 "± %", "smallest p", "verdict", "samples",
                                                 "against", "seconds", "would tell in"}};
    std::string leftOut, inDoubt, defects, failures;
    double level = 0.0;
    for (const AgreementRow& row : rows) {
        table.push_back(tableRow(row, settings.bound));
        if (!row.failure.empty()) failures += fmt::format("  {}: {}\n", titleOf(row), row.failure);
        if (!row.result) continue;
        level = row.result->comparison.level;
        if (row.result->testsInDoubt > 0)
            inDoubt += fmt::format("  {}: {}\n", titleOf(row), row.result->testsInDoubt);
        for (const AgreementSide* side : {&row.result->tested, &row.result->reference}) {
            appendLeftOut(row, *side, leftOut);
            appendDefects(row, *side, defects);
        }
    }
    std::string text = alignedTable(table, "llllrrrlrrrr");
    appendSection(
        text,
        "Left out of a comparison, since one of the two cannot make it or meets it only by chance:",
        leftOut);
    appendSection(text,
                  "Tests that reject, unless the darker side has just missed its brightest "
                  "samples, which are too bright to tell:",
                  inDoubt);
    appendSection(text, "Defects:", defects);
    appendSection(text, "Not done:", failures);
    text += fmt::format(
        "\n{} pictures a side; ± is the interval of 99 %. DIFFER: a test of a tile or of the whole "
        "has p ≤ {:.2g},\nwhich chance brings about in 1 % of all runs of {} comparisons. agree: "
        "none has, and |bias| is below {:g} %\nwith 99 % confidence. too noisy to tell: none has, "
        "but the interval reaches beyond that.\n",
        settings.seeds, level, settings.comparisons, perCent * settings.bound);
    return text;
}

Json agreementJson(const std::vector<AgreementRow>& rows, const AgreementSettings& settings) {
    Json comparisons = Json::array();
    for (const AgreementRow& row : rows) comparisons.add(jsonOf(row, settings.bound));
    return Json::object({{"seeds", settings.seeds},
                         {"bound_percent", perCent * settings.bound},
                         {"comparisons", comparisons}});
}

ExitCode exitCodeOf(const std::vector<AgreementRow>& rows, int mustAgree) {
    const auto count = [&](const auto& predicate) {
        return std::ranges::count_if(rows, predicate);
    };
    const auto countOf = [&](Verdict verdict) {
        return count(
            [=](const AgreementRow& r) { return r.result && r.result->verdict == verdict; });
    };
    if (countOf(Verdict::differ) > 0) return ExitCode::failure;
    if (count([](const AgreementRow& r) { return !r.failure.empty(); }) > 0)
        return ExitCode::badInput;
    if (count([](const AgreementRow& r) { return !r.result && !r.isIncomplete; }) > 0)
        return ExitCode::stoppedEarly;
    return countOf(Verdict::agree) < mustAgree ? ExitCode::failure : ExitCode::success;
}

}  // namespace etendue
