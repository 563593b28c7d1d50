// The report as HTML: one file, no scripts, light and dark, from phone to desk.
#include <fmt/format.h>

#include <cmath>

#include "tools/lens_report.h"
#include "tools/version.h"

namespace etendue {

namespace {

constexpr const char* pageStyle =
    R"(:root{color-scheme:light dark;--paper:#fff;--ink:#1f2933;--muted:#616e7c;--rule:#dde2e7;--card:#f7f9fa}
@media(prefers-color-scheme:dark){:root{--paper:#14181d;--ink:#e4e9ee;--muted:#98a4b0;--rule:#2e3741;--card:#1b2127}
svg text{fill:#e4e9ee}svg .muted{fill:#98a4b0}svg .ink{stroke:#dbe2e9}svg .faint{stroke:#66717c}svg .rule{stroke:#8793a0}
svg .grid{stroke:#2b333c}svg .frame{stroke:#3d4853}svg .glass{fill:#5fa5e6}
svg .c0{stroke:#5aaef5}svg .f0{fill:#5aaef5}svg .c1{stroke:#f0914c}svg .f1{fill:#f0914c}svg .c2{stroke:#45c99b}svg .f2{fill:#45c99b}
svg .c3{stroke:#dc84cb}svg .f3{fill:#dc84cb}svg .c4{stroke:#e0b63c}svg .f4{fill:#e0b63c}svg .c5{stroke:#f27280}svg .f5{fill:#f27280}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,-apple-system,"Segoe UI","DejaVu Sans",sans-serif}
main{max-width:1080px;margin:0 auto;padding:28px 20px 60px}
h1{font-size:1.7rem;line-height:1.2;margin:0 0 4px}
h2{font-size:1.2rem;margin:44px 0 6px;padding-top:16px;border-top:1px solid var(--rule)}
p{max-width:72ch;margin:6px 0 12px}
.muted,figcaption,caption{color:var(--muted)}
.facts{display:grid;grid-template-columns:repeat(auto-fit,minmax(150px,1fr));gap:10px;margin:18px 0 24px}
.facts div{background:var(--card);border-radius:8px;padding:10px 14px}
.facts b{display:block;font-size:1.05rem;font-variant-numeric:tabular-nums}
.facts span{color:var(--muted);font-size:.85rem}
.grid{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,400px),1fr));gap:26px 30px;align-items:start}
figure{margin:0}
svg{display:block;width:100%;height:auto}
.wide{overflow-x:auto}
.wide svg{min-width:620px}
table{border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums}
th,td{text-align:right;padding:4px 12px;border-bottom:1px solid var(--rule);white-space:nowrap}
th{font-weight:600}
th:first-child,td:first-child,.words td,.words th{text-align:left}
th:first-child,td:first-child{padding-left:0}
.words td{white-space:normal}
caption{text-align:left;padding:0 0 6px;caption-side:top}
pre{background:var(--card);border-radius:8px;padding:12px 14px;overflow-x:auto;font-size:.85rem}
.key{display:inline-block;width:.8em;height:.8em;border-radius:2px;margin-right:.35em;vertical-align:-.05em}
)";

using Row = std::vector<std::string>;

std::string tableOf(const std::vector<Row>& rows, const std::string& caption = "",
                    const char* classes = "") {
    std::string html = fmt::format("<div class=\"wide\"><table class=\"{}\">", classes);
    if (!caption.empty()) html += fmt::format("<caption>{}</caption>", escapedXml(caption));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const char* cell = i == 0 ? "th" : "td";
        html += "<tr>";
        for (const std::string& text : rows[i])
            html += fmt::format("<{0}>{1}</{0}>", cell, escapedXml(text));
        html += "</tr>\n";
    }
    return html + "</table></div>\n";
}

std::string figure(const Svg& svg, const std::string& title) {
    return "<figure>" + svg.inlined(title) + "</figure>\n";
}

std::string heading(const std::string& text) { return "<h2>" + escapedXml(text) + "</h2>\n"; }
std::string paragraph(const std::string& text) { return "<p>" + escapedXml(text) + "</p>\n"; }
std::string grid(const std::string& content) {
    return "<div class=\"grid\">\n" + content + "</div>\n";
}

/// Words in the cell next to a figure.
std::string beside(const std::string& content) { return "<div>" + content + "</div>\n"; }

std::string fact(const std::string& value, const std::string& label) {
    return fmt::format("<div><b>{}</b><span>{}</span></div>\n", escapedXml(value),
                       escapedXml(label));
}

std::string facts(const LensReport& report) {
    const LensInfo& info = report.info;
    const ParaxialAxis &x = info.paraxial.x, &y = info.paraxial.y;
    const std::string focal =
        isAnamorphic(info.prescription)
            ? fmt::format("{:.1f} × {:.1f} mm", x.focalLengthMm, y.focalLengthMm)
            : fmt::format("{:.2f} mm", y.focalLengthMm);
    double widest = 0.0;
    for (const ReportSpot& spot : report.spots) widest = std::max(widest, spot.fieldDegrees);
    const FitErrors& errors = report.fit.fit.errors;
    return "<div class=\"facts\">\n" + fact(focal, "focal length") +
           fact(fmt::format("f/{:.2f}", info.fNumber), "by its axial beam") +
           fact(fmt::format("{:.2f} mm", 2.0 * info.imageCircleRadiusMm),
                "image circle, diameter") +
           fact(fmt::format("{:.1f}°", widest), "from the axis, the farthest spot below") +
           fact(fmt::format("{:.3g} µrad", 1e3 * errors.directionMrad.rms), "fit error, rms") +
           fact(fmt::format("{:.2g} µm", errors.sensorMicrometres.rms), "the same on the sensor") +
           "</div>\n";
}

std::string numbers(const LensReport& report) {
    std::vector<Row> rows{{"", ""}};
    for (const auto& [label, value] : infoRows(report.info)) rows.push_back({label, value});
    std::string html =
        heading("Numbers") + tableOf(rows, "Paraxial at the d line", "words") +
        heading("Surfaces") +
        tableOf(surfaceTable(report.info.prescription),
                "Millimetres, from the scene to the sensor; indices of what follows");
    if (!report.info.prescription.notes.empty()) html += paragraph(report.info.prescription.notes);
    return html;
}

std::string spots(const LensReport& report) {
    std::string figures;
    for (const ReportSpot& spot : report.spots)
        figures +=
            figure(spotFigure(spot), fmt::format("Spot at {:.1f} degrees", spot.fieldDegrees));
    return heading("Spot diagrams") +
           paragraph(
               "Where light from one point of the scene meets the sensor: traced exactly, and "
               "by the fitted polynomials, the same rays. Lines F (blue), d (amber) and C (red); "
               "outward is up; each pair has its own scale.") +
           grid(figures);
}

Row coefficientRow(const char* name, const Eigen::Vector2d& focal, const std::string& coefficients,
                   const DistortionResidual& residual) {
    return {name,
            fmt::format("{:.4f}", focal.x()),
            fmt::format("{:.4f}", focal.y()),
            coefficients,
            fmt::format("{:.3g}", 1e3 * residual.rmsMm),
            fmt::format("{:.3g}", 1e3 * residual.mostMm)};
}

std::string distortion(const LensReport& report) {
    std::vector<Row> rows{{"model", "fx, mm", "fy, mm", "coefficients", "rms, µm", "most, µm"}};
    const auto& pinhole = report.pinhole;
    const auto& fisheye = report.fisheye;
    if (pinhole)
        rows.push_back(coefficientRow(
            "pinhole", pinhole->focalLengthMm,
            fmt::format("k1 {:.6g}  k2 {:.6g}  p1 {:.2g}  p2 {:.2g}  k3 {:.6g}", pinhole->k1,
                        pinhole->k2, pinhole->p1, pinhole->p2, pinhole->k3),
            pinhole->residual));
    if (fisheye)
        rows.push_back(
            coefficientRow("fisheye", fisheye->focalLengthMm,
                           fmt::format("k1 {:.6g}  k2 {:.6g}  k3 {:.6g}  k4 {:.6g}", fisheye->k[0],
                                       fisheye->k[1], fisheye->k[2], fisheye->k[3]),
                           fisheye->residual));
    std::string verdict = "No model could be fitted: too few chief rays reach the sensor.";
    constexpr double fineMm = 1e-3;  // a fraction of any pixel
    if (fisheye && !pinhole)
        verdict = "The pinhole model ends below 90° and does not apply; use the fisheye model.";
    else if (pinhole && fisheye && pinhole->residual.rmsMm < fineMm)
        verdict = "The pinhole model suits this lens: it is off by less than a micrometre.";
    else if (pinhole && fisheye)
        verdict = pinhole->residual.rmsMm <= fisheye->residual.rmsMm
                      ? "The pinhole model suits this lens better."
                      : "The fisheye model suits this lens better.";
    return heading("Distortion") +
           grid(figure(distortionFigure(report), "Distortion over the field") +
                beside(paragraph(
                    verdict +
                    " Divide the focal lengths by the pixel pitch for OpenCV's camera matrix; the "
                    "principal point is the middle of the sensor."))) +
           tableOf(rows,
                   "OpenCV's models, fitted to exact chief rays over the sensor at the d line");
}

std::string light(const LensReport& report) {
    std::string figures;
    for (const ReportCurves& curves : report.curves)
        figures += figure(illuminationFigure(curves), "Relative illumination");
    return heading("Illumination") +
           grid(figures +
                beside(paragraph(
                    "The fall of light toward the edge under a uniform sky, and what it is the "
                    "product of: cos⁴ of the chief ray's angle at the sensor, the share of the "
                    "stop that no rim hides, and the rest, which is the exit pupil's apparent "
                    "size and the glass.")));
}

std::string colour(const LensReport& report) {
    std::string figures;
    for (const ReportCurves& curves : report.curves)
        figures += figure(lateralColourFigure(curves), "Lateral colour") +
                   figure(focusShiftFigure(curves), "Longitudinal aberration") +
                   figure(fieldCurvatureFigure(curves), "Field curvature");
    return heading("Colour and focus") +
           paragraph(
               "Field curvature is where thin pencils about the chief ray are sharp at the d line: "
               "tangential, of rays that differ along the field; sagittal, across it. What is "
               "between them is astigmatism.") +
           grid(figures + figure(paraxialFocusFigure(report), "Axial colour"));
}

std::string fit(const LensReport& report) {
    const LensFit& fit = report.fit.fit;
    std::vector<Row> rows{{"error", "unit", "rms", "99.9 %", "most"}};
    for (const FitErrorRow& row : errorRows(fit.errors))
        rows.push_back({row.label, row.unit, fmt::format("{:.3g}", row.summary.rms),
                        fmt::format("{:.3g}", row.summary.percentile999),
                        fmt::format("{:.3g}", row.summary.most)});
    std::string figures;
    for (const ReportCurves& curves : report.curves)
        figures += figure(fitMapFigure(curves, fit.domain.apertureRadiusMm),
                          "Error of the fit over field and aperture");
    const std::string words =
        tableOf(rows, fmt::format("On {} rays drawn anew, {} of them unsolved", fit.errors.rays,
                                  fit.errors.unsolved)) +
        paragraph(fmt::format(
            "Rims: {:.3f} % of the rays that the fit accepts the lens would block, {:.3f} % of "
            "those that it lets through the fit refuses. {:.2f} % of the light is in folded "
            "rays, which no fit has.",
            100.0 * fit.clipErrors.wronglyAccepted, 100.0 * fit.clipErrors.wronglyBlocked,
            100.0 * fit.training.foldedLight)) +
        "<p>In the map: <span class=\"key\" style=\"background:#e0488b\"></span>accepted though a "
        "rim blocks it, <span class=\"key\" style=\"background:#8a8f98\"></span>refused though it "
        "passes; empty where there is no light.</p>\n";
    return heading("Polynomial fit") +
           paragraph(fmt::format("{}; {}. Domain: {}.", describe(fit.settings), describeCost(fit),
                                 describe(fit.domain))) +
           grid(figures + beside(words));
}

int sumOf(std::span<const ConnectRing> rings, int ConnectRing::*part) {
    int sum = 0;
    for (const ConnectRing& ring : rings) sum += ring.*part;
    return sum;
}

std::string connect(const LensReport& report) {
    std::vector<Row> rows{{"on the sensor, mm", "field", "rays", "not found", "other root",
                           "iterations", "most", "two-step: not found", "iterations"}};
    for (std::size_t i = 0; i < report.newton.size(); ++i) {
        const ConnectRing &ours = report.newton[i], &published = report.twoStep[i];
        rows.push_back({fmt::format("{:.2f} – {:.2f}", ours.lowMm, ours.highMm),
                        fmt::format("{:.1f}°", ours.fieldDegrees), std::to_string(ours.rays),
                        std::to_string(ours.failures), std::to_string(ours.otherPoints),
                        fmt::format("{:.2f}", ours.meanIterations),
                        std::to_string(ours.mostIterations), std::to_string(published.failures),
                        fmt::format("{:.2f}", published.meanIterations)});
    }
    return heading("Connecting scene points to the sensor") +
           paragraph(fmt::format(
               "From each of {} rays of the fitted lens a scene point 10 cm, 1 m, 10 m or 1000 km "
               "away is taken, and the sensor point that sees it through the same aperture point "
               "is sought. Not found: {}; by the published two-step search on the same "
               "polynomials: {}.",
               sumOf(report.newton, &ConnectRing::rays),
               sumOf(report.newton, &ConnectRing::failures),
               sumOf(report.twoStep, &ConnectRing::failures))) +
           grid(figure(iterationsFigure(report), "Iterations over the field") +
                figure(failuresFigure(report), "Failures over the field")) +
           tableOf(rows);
}

}  // namespace

std::string reportPage(const LensReport& report, const std::string& madeBy) {
    const Prescription& p = report.info.prescription;
    const std::string name = titleOf(p);
    std::string html = fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
        "<title>{}</title>\n<style>\n{}{}</style>\n</head>\n<body>\n<main>\n",
        escapedXml(name), svgStyle(), pageStyle);
    html += fmt::format("<h1>{}</h1>\n<p class=\"muted\">{}</p>\n", escapedXml(name),
                        escapedXml(p.source));
    html += facts(report);
    html += "<div class=\"wide\">" + figure(report.drawing.svg, "Cross-section of " + name) +
            "</div>\n";
    html += spots(report) + distortion(report) + light(report) + colour(report) + fit(report) +
            connect(report) + numbers(report);
    html += heading("Made by") + "<pre>" + escapedXml(madeBy) + "</pre>\n" +
            paragraph(fmt::format("etendue {}; prescription {:016x}. The same data: report.json.",
                                  version, contentHash(p)));
    return html + "</main>\n</body>\n</html>\n";
}

}  // namespace etendue
