#include "tools/regress_baseline.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/config.h"
#include "renderer/estimator.h"

namespace etendue {

namespace {

constexpr double perCent = 100.0;
constexpr const char* head =
    "# What `etendue bench regress` compares with; docs/regression.md. Written by\n"
    "# etendue bench regress --rebaseline, which keeps samples, bias_bound and rate.\n"
    "#\n"
    "# samples: per pixel of each picture. bias_bound, %: the bias must be known to be below it;\n"
    "# without one noise hides too much. rate = false: these samples cannot tell the slope.\n"
    "# noise: relMSE × samples, and its interval of 99 %.\n";

BaselineRow rowIn(const ConfigTable& table) {
    BaselineRow row;
    row.cell = {table.text("scene"), table.text("camera"),
                table.choice("estimator", estimatorKinds())};
    row.samples = static_cast<std::uint32_t>(table.integer("samples", {16, 1 << 20}));
    if (row.samples % 16 != 0) table.fail("samples", "expected a multiple of 16");
    if (table.has("bias_bound"))
        row.biasBound = table.number("bias_bound", {1e-6, 1000.0}) / perCent;
    row.judgesRate = table.boolean("rate", true);
    row.noise = table.number("noise", Range::positive());
    const std::vector<double> interval = table.numbers("interval", 2, Range::positive());
    row.interval = {interval[0], interval[1]};
    if (!(row.interval.low <= row.noise && row.noise <= row.interval.high))
        table.fail("interval", "expected low and high, and the noise between them");
    table.finish();
    return row;
}

auto positionOf(auto& rows, const RegressCell& cell) {
    return std::ranges::lower_bound(rows, cell, {}, &BaselineRow::cell);
}

}  // namespace

std::string titleOf(const RegressCell& cell) {
    return fmt::format("{}, {}, {}", cell.scene, cell.camera, cell.estimator);
}

const BaselineRow* Baseline::of(const RegressCell& cell) const {
    const auto found = positionOf(rows, cell);
    return found != rows.end() && found->cell == cell ? &*found : nullptr;
}

void Baseline::put(const BaselineRow& row) {
    const auto place = positionOf(rows, row.cell);
    if (place != rows.end() && place->cell == row.cell)
        *place = row;
    else
        rows.insert(place, row);
}

Baseline readBaseline(const std::filesystem::path& file) {
    const Config config = Config::load(file);
    const ConfigTable root = config.root();
    Baseline baseline;
    for (const ConfigTable& table : root.tables("cell")) {
        const BaselineRow row = rowIn(table);
        if (baseline.of(row.cell)) table.fail("scene", titleOf(row.cell) + " is there twice");
        baseline.put(row);
    }
    root.finish();
    return baseline;
}

std::string baselineText(const Baseline& baseline) {
    std::string text = std::string(head) + "\ncell = [\n";
    for (const BaselineRow& row : baseline.rows) {
        text +=
            fmt::format("    {{scene = \"{}\", camera = \"{}\", estimator = \"{}\", samples = {}, ",
                        row.cell.scene, row.cell.camera, row.cell.estimator, row.samples);
        if (row.biasBound) text += fmt::format("bias_bound = {:g}, ", perCent * *row.biasBound);
        if (!row.judgesRate) text += "rate = false, ";
        text += fmt::format("noise = {}, interval = [{}, {}]}},\n", row.noise, row.interval.low,
                            row.interval.high);
    }
    return text + "]\n";
}

}  // namespace etendue
