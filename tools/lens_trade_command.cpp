#include "tools/lens_trade_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <exception>

#include "lens/fit_domain.h"
#include "tools/json.h"
#include "tools/lens_fit_command.h"
#include "tools/lens_slides_table.h"
#include "tools/progress.h"
#include "tools/svg_plot.h"
#include "tools/text_table.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

struct LensTrade {
    std::string lens;          // its file's name
    std::string zoomPosition;  // empty for a lens that does not zoom
    TradeRow row;
};

std::string labelOf(const std::string& lens, const std::string& zoomPosition) {
    return zoomPosition.empty() ? lens : fmt::format("{} at {}", lens, zoomPosition);
}

/// A cell of a CSV file (RFC 4180).
std::string csvCell(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

double perCent(int part, int whole) { return whole > 0 ? 100.0 * part / whole : 0.0; }

/// A quantity of a row: its name for machines, its heading, and itself. Text without a number.
struct Column {
    const char *key, *heading;
    double (*value)(const TradeRow&);
    const char* format;
};

const std::vector<Column>& columns() {
    using Row = const TradeRow&;
    static const std::vector<Column> all{
        {"terms", "terms", [](Row r) { return double(r.settings.terms); }, "{:.0f}"},
        {"degree", "degree", [](Row r) { return double(r.settings.degree); }, "{:.0f}"},
        {"multiply_adds", "mul-adds", [](Row r) { return double(r.multiplyAdds); }, "{:.0f}"},
        {"direction_mrad_rms", "mrad", [](Row r) { return r.errors.directionMrad.rms; }, "{:.3g}"},
        {"direction_mrad_99_9", "99.9 %",
         [](Row r) { return r.errors.directionMrad.percentile999; }, "{:.3g}"},
        {"direction_mrad_most", "most", [](Row r) { return r.errors.directionMrad.most; },
         "{:.3g}"},
        {"sensor_um_rms", "µm", [](Row r) { return r.errors.sensorMicrometres.rms; }, "{:.3g}"},
        {"throughput_percent_rms", "J τ %",
         [](Row r) { return 100.0 * r.errors.throughputRelative.rms; }, "{:.2g}"},
        {"etendue_percent_rms", "étendue %", [](Row r) { return 100.0 * r.errors.etendue.rms; },
         "{:.2g}"},
        {"wrongly_accepted_percent", "let by %",
         [](Row r) { return 100.0 * r.clipErrors.wronglyAccepted; }, "{:.2f}"},
        {"wrongly_blocked_percent", "refused %",
         [](Row r) { return 100.0 * r.clipErrors.wronglyBlocked; }, "{:.2f}"},
        {"evaluation_ns", "eval ns", [](Row r) { return r.evaluationNs; }, "{:.0f}"},
        {"trace_ns", "trace ns", [](Row r) { return r.traceNs; }, "{:.0f}"},
        {"connect_ns", "connect ns", [](Row r) { return r.connectNs; }, "{:.0f}"},
        {"connect_lost_percent", "lost %",
         [](Row r) { return perCent(r.connectFailures, r.connectRays); }, "{:.2f}"},
        {"two_step_lost_percent", "2-step lost %",
         [](Row r) { return perCent(r.twoStepFailures, r.connectRays); }, "{:.2f}"},
        {"fit_seconds", "fit s", [](Row r) { return r.fitSeconds; }, "{:.1f}"}};
    return all;
}

std::string tableText(const std::vector<LensTrade>& trades) {
    std::vector<std::vector<std::string>> rows{{"lens", "form", "basis"}};
    for (const Column& column : columns()) rows.front().push_back(column.heading);
    for (const LensTrade& trade : trades) {
        const FitSettings& settings = trade.row.settings;
        rows.push_back({labelOf(trade.lens, trade.zoomPosition), formName(settings.form),
                        std::string(basisName(settings.basis))});
        for (const Column& column : columns())
            rows.back().push_back(
                fmt::format(fmt::runtime(column.format), column.value(trade.row)));
    }
    return alignedTable(rows, "lll" + std::string(columns().size(), 'r'));
}

std::string csvText(const std::vector<LensTrade>& trades) {
    std::string text = "lens,zoom_position,form,basis";
    for (const Column& column : columns()) text += fmt::format(",{}", column.key);
    text += "\n";
    for (const LensTrade& trade : trades) {
        const FitSettings& settings = trade.row.settings;
        text += fmt::format("{},{},{},{}", csvCell(trade.lens), csvCell(trade.zoomPosition),
                            formName(settings.form), basisName(settings.basis));
        for (const Column& column : columns()) text += fmt::format(",{}", column.value(trade.row));
        text += "\n";
    }
    return text;
}

Json jsonOf(const std::vector<LensTrade>& trades) {
    Json rows = Json::array();
    for (const LensTrade& trade : trades) {
        const FitSettings& settings = trade.row.settings;
        Json row = Json::object({{"lens", trade.lens},
                                 {"zoom_position", trade.zoomPosition},
                                 {"form", formName(settings.form)},
                                 {"basis", std::string(basisName(settings.basis))}});
        for (const Column& column : columns()) row.add(column.key, column.value(trade.row));
        rows.add(std::move(row));
    }
    return rows;
}

/// Error against cost, a curve for each lens, form, basis and degree.
std::string plotText(const std::vector<LensTrade>& trades) {
    std::vector<double> costs, errors;
    std::vector<PlotSeries> curves;
    for (const LensTrade& trade : trades) {
        const FitSettings& settings = trade.row.settings;
        const double cost = trade.row.multiplyAdds, error = trade.row.errors.directionMrad.rms;
        costs.push_back(cost);
        errors.push_back(error);
        const std::string name =
            fmt::format("{}, {}, {}, degree {}", labelOf(trade.lens, trade.zoomPosition),
                        formName(settings.form), basisName(settings.basis), settings.degree);
        if (curves.empty() || curves.back().name != name) {
            const int colour = static_cast<int>(curves.size()) % svgSeriesColours;
            const bool isDashed = curves.size() >= static_cast<std::size_t>(svgSeriesColours);
            curves.push_back({name, {}, colour, true, true, isDashed});
        }
        curves.back().points.emplace_back(cost, error);
    }
    const double height = 380.0 + 17.0 * static_cast<double>(curves.size());
    Plot plot("Outgoing direction, held out, against the cost of a ray",
              axisFor("multiply-adds", costs, AxisScale::logarithmic),
              axisFor("error, mrad rms", errors, AxisScale::logarithmic), 760.0, height);
    for (PlotSeries& curve : curves) plot.add(std::move(curve));
    return plot.svg().document();
}

/// On one line of the terminal, or a line for every fit elsewhere.
class TradeProgress {
public:
    explicit TradeProgress(std::size_t fits) : fits_(fits) {}

    void begin(const std::string& what) {
        what_ = fmt::format("{}/{} {}", ++number_, fits_, what);
        if (!isTerminal_) say(fmt::format("{}\n", what_));
    }
    void update(double share, std::string_view stage) const {
        if (!isTerminal_) return;
        say(fmt::format("\r{}: {:.0f} %, {}\033[K", what_, 100.0 * share, stage));
        std::fflush(stderr);
    }
    ~TradeProgress() {
        if (isTerminal_) say("\r\033[K");
    }

private:
    std::size_t fits_, number_ = 0;
    std::string what_;
    bool isTerminal_ = isatty(STDERR_FILENO) == 1;
};

std::vector<PolynomialBasis> basesFor(const LensTradeCommand& command,
                                      const Prescription& prescription) {
    if (command.bases.empty()) return {basisFor(prescription, {}), PolynomialBasis::cartesian};
    for (const PolynomialBasis basis : command.bases) basisFor(prescription, basis);
    return command.bases;
}

std::vector<LensTrade> measureAll(const LensTradeCommand& command) {
    std::vector<Prescription> prescriptions;
    std::size_t fits = 0;
    for (const std::string& lens : command.lenses) {
        LensChoice choice = command.choice;
        choice.lens = lens;
        prescriptions.push_back(loadPrescription(choice));
        fits += basesFor(command, prescriptions.back()).size() * command.forms.size() *
                command.degrees.size() * command.terms.size();
    }
    TradeProgress progress(fits);
    std::vector<LensTrade> trades;
    for (std::size_t i = 0; i < prescriptions.size(); ++i) {
        const std::string name = findLensFile(command.lenses[i]).stem().string();
        const std::string& zoomPosition = prescriptions[i].zoomPosition;
        const FitDomain domain = fitDomain(prescriptions[i], requestOf(command.choice));
        for (const FitForm form : command.forms)
            for (const PolynomialBasis basis : basesFor(command, prescriptions[i]))
                for (const int degree : command.degrees)
                    for (const int terms : command.terms) {
                        FitSettings settings;
                        settings.form = form;
                        settings.basis = basis;
                        settings.degree = degree;
                        settings.terms = terms;
                        progress.begin(fmt::format("{}, {}, {}, degree {}, {} terms",
                                                   labelOf(name, zoomPosition), formName(form),
                                                   basisName(basis), degree, terms));
                        const auto update = [&](double share, std::string_view stage) {
                            progress.update(share, stage);
                        };
                        trades.push_back(
                            {name, zoomPosition,
                             measureTrade(prescriptions[i], domain, settings, update)});
                    }
    }
    return trades;
}

void checkFiles(const LensTradeCommand& command) {
    std::vector<GivenFile> lenses;
    for (const std::string& lens : command.lenses) lenses.push_back({"a lens", findLensFile(lens)});
    checkDistinct({{"--csv", command.csv}, {"--plot", command.plot}}, lenses);
    checkWritable(command.csv);
    checkWritable(command.plot);
}

void writeFiles(const LensTradeCommand& command, const std::vector<LensTrade>& trades) {
    if (!command.csv.empty()) writeWholeFile(command.csv, csvText(trades));
    if (!command.plot.empty()) writeWholeFile(command.plot, plotText(trades));
}

}  // namespace

ExitCode runLensTrade(const LensTradeCommand& command) {
    if (command.slides) return runSlidesTable(command.asJson);
    if (command.lenses.empty())
        throw InputError("lens trade: name a lens, or several, or --slides", ExitCode::usage);
    checkFiles(command);
    const std::vector<LensTrade> trades = measureAll(command);
    std::exception_ptr failure;  // no reason to lose the table, too
    try {
        writeFiles(command, trades);
    } catch (const std::exception&) {
        failure = std::current_exception();
    }
    fmt::print("{}", command.asJson ? jsonOf(trades).text() + "\n" : tableText(trades));
    if (failure) std::rethrow_exception(failure);
    return ExitCode::success;
}

}  // namespace etendue
