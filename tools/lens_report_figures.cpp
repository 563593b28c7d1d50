#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/lens_report.h"
#include "tools/svg_plot.h"

namespace etendue {

namespace {

constexpr double micrometres = 1e3;
/// F blue, d amber, C red.
constexpr std::array<const char*, 3> lineNames{"F, 486 nm", "d, 588 nm", "C, 656 nm"};

int lineColour(std::size_t line) { return colourOfWavelength(reportLinesNm[line]); }

std::string ofAxis(const std::string& title, const ReportAxis& axis) {
    return axis.name.empty() ? title : fmt::format("{}, along {}", title, axis.name);
}

PlotAxis heightAxis(const ReportAxis& axis) {
    return {"distance from the axis on the sensor, mm", 0.0, axis.brightMm};
}

std::vector<double> secondsOf(std::span<const PlotSeries> series) {
    std::vector<double> values;
    for (const PlotSeries& one : series)
        for (const Eigen::Vector2d& point : one.points) values.push_back(point.y());
    return values;
}

Svg plotOf(std::string title, PlotAxis x, std::string yLabel, std::vector<PlotSeries> series) {
    const std::vector<double> values = secondsOf(series);
    Plot plot(std::move(title), std::move(x), axisFor(std::move(yLabel), values));
    for (PlotSeries& one : series) plot.add(std::move(one));
    return plot.svg();
}

/// Violet to yellow through green, legible on white and on black; `share` in [0, 1].
std::string heatColour(double share) {
    constexpr std::array<std::array<double, 3>, 5> stops{
        {{59, 28, 140}, {33, 110, 160}, {36, 158, 122}, {150, 205, 70}, {253, 231, 60}}};
    const double at = std::clamp(share, 0.0, 1.0) * (stops.size() - 1.0);
    const std::size_t low = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    std::array<int, 3> mixed{};
    for (std::size_t i = 0; i < 3; ++i)
        mixed[i] = static_cast<int>(std::lround(
            std::lerp(stops[low][i], stops[low + 1][i], at - static_cast<double>(low))));
    return fmt::format("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2]);
}

/// The decades that hold nearly all of the map's errors.
PlotAxis errorScale(const FitMap& map) {
    std::vector<double> errors;
    for (const double error : map.directionMrad)
        if (error > 0.0) errors.push_back(error);
    if (errors.empty()) return {"", 1e-3, 1.0, AxisScale::logarithmic};
    std::ranges::sort(errors);
    const double low = errors[errors.size() / 20], high = errors.back();
    return {"", std::pow(10.0, std::floor(std::log10(low))),
            std::pow(10.0, std::ceil(std::log10(high))), AxisScale::logarithmic};
}

constexpr int heatSteps = 20;

void drawColourBar(Svg& svg, Eigen::Vector2d corner, double width, const PlotAxis& scale) {
    const double step = width / heatSteps;
    for (int i = 0; i < heatSteps; ++i)
        svg.cell(corner + Eigen::Vector2d(i * step, 0.0), {step + 0.3, 10.0},
                 heatColour((i + 0.5) / heatSteps));
    const double decades = std::log10(scale.high / scale.low);
    for (double decade = 0.0; decade <= decades + 1e-9; decade += 1.0)
        svg.text(corner + Eigen::Vector2d(width * decade / decades, 24.0),
                 tickText(scale.low * std::pow(10.0, decade)), TextAnchor::middle, "muted");
    svg.text(corner + Eigen::Vector2d(width + 14.0, 10.0), "mrad");
}

/// Neighbours of one colour in a row become one cell.
void drawCells(Svg& svg, const Plot& plot, const ReportCurves& curves, const PlotAxis& scale) {
    const FitMap& map = curves.map;
    const auto colourAt = [&](int row, int column) -> std::string {
        const std::size_t cell = map.index(row, column);
        if (map.isWronglyAccepted[cell]) return "#e0488b";
        if (map.isWronglyBlocked[cell]) return "#8a8f98";
        const double error = map.directionMrad[cell];
        if (!std::isfinite(error)) return "";
        const double share =
            std::log(std::max(error, scale.low) / scale.low) / std::log(scale.high / scale.low);
        return heatColour((std::min(std::floor(share * heatSteps), heatSteps - 1.0) + 0.5) /
                          heatSteps);
    };
    const double width = curves.axis.edgeMm / map.fields, height = 2.0 / map.apertures;
    for (int row = 0; row < map.apertures; ++row)
        for (int column = 0; column < map.fields;) {
            const std::string colour = colourAt(row, column);
            int end = column + 1;
            while (end < map.fields && colourAt(row, end) == colour) ++end;
            if (!colour.empty()) {
                const Eigen::Vector2d corner =
                    plot.place({column * width, -1.0 + (row + 1) * height});
                const Eigen::Vector2d opposite = plot.place({end * width, -1.0 + row * height});
                svg.cell(corner, opposite - corner + Eigen::Vector2d(0.3, 0.3), colour);
            }
            column = end;
        }
}

}  // namespace

Svg spotFigure(const ReportSpot& spot) {
    constexpr double box = 190.0, gap = 16.0, top = 58.0;
    double reach = 1e-6;
    for (const auto* lines : {&spot.exact, &spot.fitted})
        for (const auto& points : *lines)
            for (const Eigen::Vector2d& point : points)
                if (point.allFinite()) reach = std::max(reach, point.cwiseAbs().maxCoeff());
    const double scale = 0.46 * box / reach;
    Svg svg(2.0 * box + gap, top + box + 26.0);
    svg.text(
        {0.0, 18.0},
        fmt::format("{}{:.1f}°, {:.2f} mm", spot.axis.name.empty() ? "" : spot.axis.name + ": ",
                    spot.fieldDegrees, spot.heightMm),
        TextAnchor::start, "bold");
    const std::array<std::pair<const char*, double>, 2> panels{
        {{"exact", spot.exactRmsMm}, {"polynomial", spot.fittedRmsMm}}};
    for (std::size_t panel = 0; panel < panels.size(); ++panel) {
        const Eigen::Vector2d corner(static_cast<double>(panel) * (box + gap), top);
        const Eigen::Vector2d centre = corner + Eigen::Vector2d(0.5 * box, 0.5 * box);
        svg.text(corner - Eigen::Vector2d(0.0, 10.0),
                 std::isfinite(panels[panel].second)
                     ? fmt::format("{}, rms {:.4g} µm", panels[panel].first,
                                   micrometres * panels[panel].second)
                     : fmt::format("{}: no ray", panels[panel].first),
                 TextAnchor::start, "muted");
        svg.rectangle(corner, {box, box}, "frame");
        svg.line(centre - Eigen::Vector2d(0.5 * box, 0.0), centre + Eigen::Vector2d(0.5 * box, 0.0),
                 "grid");
        svg.line(centre - Eigen::Vector2d(0.0, 0.5 * box), centre + Eigen::Vector2d(0.0, 0.5 * box),
                 "grid");
        const auto& lines = panel == 0 ? spot.exact : spot.fitted;
        for (std::size_t line = 0; line < lines.size(); ++line) {
            std::vector<Eigen::Vector2d> places;
            for (const Eigen::Vector2d& point : lines[line])  // outward is up
                places.push_back(centre + scale * Eigen::Vector2d(point.y(), -point.x()));
            svg.dots(places, fmt::format("c{}", lineColour(line)));
        }
    }
    const double bar = niceBelow(micrometres * 0.8 * reach) / micrometres;
    const Eigen::Vector2d foot(0.0, top + box + 12.0);
    svg.line(foot, foot + Eigen::Vector2d(bar * scale, 0.0), "ink");
    svg.text(foot + Eigen::Vector2d(bar * scale + 8.0, 4.0),
             fmt::format("{:g} µm", micrometres * bar));
    svg.text({2.0 * box + gap, top + box + 16.0},
             fmt::format("rays moved by {:.3g} µm at most", micrometres * spot.largestShiftMm),
             TextAnchor::end, "muted");
    return svg;
}

Svg distortionFigure(const LensReport& report) {
    double widest = 0.0;
    for (const ReportCurves& curves : report.curves)
        for (const DistortionPoint& point : curves.distortion)
            widest = std::max(widest, point.fieldDegrees);
    const bool isWide = widest > 60.0;  // beyond, tangents grow out of all proportion
    std::vector<PlotSeries> series;
    for (const ReportCurves& curves : report.curves) {
        PlotSeries one{curves.axis.name.empty() ? "" : "along " + curves.axis.name,
                       {},
                       static_cast<int>(series.size())};
        for (const DistortionPoint& point : curves.distortion)
            one.points.emplace_back(point.fieldDegrees,
                                    isWide ? point.equidistantPercent : point.rectilinearPercent);
        series.push_back(std::move(one));
    }
    return plotOf(isWide ? "Distortion from f θ" : "Distortion from f tan θ",
                  {"field angle, degrees", 0.0, widest}, "%", std::move(series));
}

Svg illuminationFigure(const ReportCurves& curves) {
    std::vector<PlotSeries> series{{"total", {}, 0},
                                   {"cos⁴ at the sensor", {}, 1, true, false, true},
                                   {"vignetting", {}, 2, true, false, true},
                                   {"exit pupil and glass", {}, 3, true, false, true}};
    for (const Illumination& at : curves.illumination) {
        series[0].points.emplace_back(at.heightMm, at.total);
        series[1].points.emplace_back(at.heightMm, at.cosFourth);
        series[2].points.emplace_back(at.heightMm, at.vignetting);
        series[3].points.emplace_back(at.heightMm, at.rest);
    }
    return plotOf(ofAxis("Relative illumination", curves.axis), heightAxis(curves.axis),
                  "relative to the axis", std::move(series));
}

Svg lateralColourFigure(const ReportCurves& curves) {
    std::vector<PlotSeries> series;
    for (std::size_t line = 0; line < reportLinesNm.size(); ++line) {
        PlotSeries one{lineNames[line], {}, lineColour(line)};
        for (std::size_t i = 0; i < curves.heightsMm.size(); ++i)
            one.points.emplace_back(curves.heightsMm[i], micrometres * curves.lateralMm[line][i]);
        series.push_back(std::move(one));
    }
    return plotOf(ofAxis("Lateral colour", curves.axis), heightAxis(curves.axis),
                  "outward from the d line, µm", std::move(series));
}

Svg focusShiftFigure(const ReportCurves& curves) {
    std::vector<PlotSeries> series;
    for (std::size_t line = 0; line < reportLinesNm.size(); ++line) {
        PlotSeries one{lineNames[line], {}, lineColour(line)};
        for (std::size_t i = 0; i < curves.apertureShares.size(); ++i)
            one.points.emplace_back(curves.apertureShares[i], curves.focusShiftMm[line][i]);
        series.push_back(std::move(one));
    }
    return plotOf(ofAxis("Longitudinal aberration", curves.axis),
                  {"height in the stop, of its radius", 0.0, 1.0},
                  "focus in front of the sensor, mm", std::move(series));
}

Svg fieldCurvatureFigure(const ReportCurves& curves) {
    std::vector<PlotSeries> series{{"tangential", {}, 0}, {"sagittal", {}, 1}};
    for (std::size_t i = 0; i < curves.heightsMm.size(); ++i) {
        series[0].points.emplace_back(curves.heightsMm[i], curves.fieldCurvature[i].tangentialMm);
        series[1].points.emplace_back(curves.heightsMm[i], curves.fieldCurvature[i].sagittalMm);
    }
    return plotOf(ofAxis("Field curvature", curves.axis), heightAxis(curves.axis),
                  "focus in front of the sensor, mm", std::move(series));
}

Svg paraxialFocusFigure(const LensReport& report) {
    const auto& points = report.paraxialFocusMm;
    return plotOf("Axial colour", {"wavelength, nm", points.front().x(), points.back().x()},
                  "paraxial focus in front of the sensor, mm", {{"", points, 0}});
}

Svg fitMapFigure(const ReportCurves& curves, double apertureRadiusMm) {
    const PlotAxis scale = errorScale(curves.map);
    const Plot plot(ofAxis("Error of the direction", curves.axis),
                    {"distance from the axis on the sensor, mm", 0.0, curves.axis.edgeMm},
                    {fmt::format("in the stop, of {:.4g} mm", apertureRadiusMm), -1.0, 1.0}, 440.0,
                    360.0);
    Svg svg(440.0, 404.0);
    svg.place(plot.svg(), {0.0, 0.0});
    drawCells(svg, plot, curves, scale);
    drawColourBar(svg, {62.0, 372.0}, 320.0, scale);
    return svg;
}

namespace {

std::vector<PlotSeries> surveySeries(const LensReport& report,
                                     double (*valueOf)(const ConnectRing&)) {
    std::vector<PlotSeries> series{{"from the fitted first guess, damped", {}, 0, true, true},
                                   {"two-step, as published", {}, 1, true, true, true}};
    for (std::size_t method = 0; method < 2; ++method)
        for (const ConnectRing& ring : method == 0 ? report.newton : report.twoStep)
            if (ring.rays > 0)
                series[method].points.emplace_back(0.5 * (ring.lowMm + ring.highMm), valueOf(ring));
    return series;
}

PlotAxis surveyAxis(const LensReport& report) {
    return {"distance from the axis on the sensor, mm", 0.0, report.newton.back().highMm};
}

}  // namespace

Svg iterationsFigure(const LensReport& report) {
    return plotOf(
        "Iterations of connect", surveyAxis(report), "mean of all rays",
        surveySeries(report, [](const ConnectRing& ring) { return ring.meanIterations; }));
}

Svg failuresFigure(const LensReport& report) {
    return plotOf("Rays that connect does not find", surveyAxis(report), "%",
                  surveySeries(report, [](const ConnectRing& ring) {
                      return 100.0 * ring.failures / ring.rays;
                  }));
}

}  // namespace etendue
