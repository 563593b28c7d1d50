#include "tools/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

constexpr double left = 62.0, right = 16.0, top = 34.0, bottom = 44.0;
constexpr double legendRow = 17.0;

}  // namespace

double niceBelow(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double factor : {5.0, 2.0})
        if (factor * power <= value * (1.0 + 1e-9)) return factor * power;
    return power;
}

PlotAxis axisFor(std::string label, std::span<const double> values, AxisScale scale,
                 bool withZero) {
    const bool isLogarithmic = scale == AxisScale::logarithmic;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    if (withZero && !isLogarithmic) low = high = 0.0;
    for (const double value : values)
        if (std::isfinite(value) && (value > 0.0 || !isLogarithmic)) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    if (!(low <= high)) low = high = 1.0;
    if (isLogarithmic) return {std::move(label), low / 1.25, high * 1.25, scale};
    if (low == 0.0 && high == 0.0) high = 1.0;
    const double span = high > low ? high - low : std::abs(high);
    const double step = niceBelow(span / 5.0);
    return {std::move(label), step * std::floor(low / step - 1e-9 + (low == 0.0 ? 1e-9 : 0.0)),
            step * std::ceil(high / step + (high == 0.0 ? 0.0 : 1e-9)), scale};
}

std::vector<double> tickValues(const PlotAxis& axis, int count) {
    std::vector<double> ticks;
    if (axis.scale == AxisScale::linear) {
        const double step = niceBelow((axis.high - axis.low) / (count - 1) * 1.01);
        const double rounding = 1e-9 * step;
        for (double n = std::ceil((axis.low - rounding) / step); n * step <= axis.high + rounding;
             n += 1.0)
            ticks.push_back(n * step);
        return ticks;
    }
    const double decades = std::log10(axis.high / axis.low);
    const double decadeStep = std::max(1.0, std::ceil(decades / count));
    for (double power = std::floor(std::log10(axis.low)); power <= std::log10(axis.high);
         power += decadeStep)
        for (const double factor : {1.0, 2.0, 5.0}) {
            if (factor != 1.0 && decades > 3.0) continue;
            const double tick = factor * std::pow(10.0, power);
            if (tick >= axis.low && tick <= axis.high) ticks.push_back(tick);
        }
    return ticks;
}

std::string tickText(double value) {
    std::string text = fmt::format("{:.4g}", std::abs(value));
    if (const std::size_t e = text.find("e-0"); e != std::string::npos) text.replace(e, 3, "e−");
    return value < 0.0 ? "−" + text : text;
}

Plot::Plot(std::string title, PlotAxis x, PlotAxis y, double width, double height)
    : title_(std::move(title)),
      x_(std::move(x)),
      y_(std::move(y)),
      width_(width),
      height_(height) {}

double Plot::share(const PlotAxis& axis, double value) const {
    if (axis.scale == AxisScale::linear) return (value - axis.low) / (axis.high - axis.low);
    return value > 0.0 ? std::log(value / axis.low) / std::log(axis.high / axis.low)
                       : std::numeric_limits<double>::quiet_NaN();
}

Eigen::Vector2d Plot::place(const Eigen::Vector2d& value) const {
    return {left + share(x_, value.x()) * (width_ - left - right),
            height_ - bottom - share(y_, value.y()) * (height_ - top - bottom)};
}

void Plot::drawAxes(Svg& svg) const {
    const double base = height_ - bottom;
    for (const double tick : tickValues(x_)) {
        const double x = place({tick, y_.low}).x();
        svg.line({x, top}, {x, base}, "grid");
        svg.text({x, base + 16.0}, tickText(tick), TextAnchor::middle, "muted");
    }
    for (const double tick : tickValues(y_)) {
        const double y = place({x_.low, tick}).y();
        const bool isZero = tick == 0.0 && y_.low < 0.0;
        svg.line({left, y}, {width_ - right, y}, isZero ? "faint" : "grid");
        svg.text({left - 7.0, y + 4.0}, tickText(tick), TextAnchor::end, "muted");
    }
    svg.line({left, base}, {width_ - right, base}, "rule");
    svg.line({left, top}, {left, base}, "rule");
    svg.text({0.5 * (left + width_ - right), height_ - 8.0}, x_.label, TextAnchor::middle);
    svg.text({14.0, 0.5 * (top + base)}, y_.label, TextAnchor::middle, "", -90.0);
    svg.text({left, 18.0}, title_, TextAnchor::start, "bold");
}

void Plot::drawLegend(Svg& svg) const {
    double y = height_ + 10.0;
    for (const PlotSeries& series : series_) {
        if (series.name.empty()) continue;
        const std::string colour = fmt::format("c{}", series.colour % svgSeriesColours);
        if (series.hasLine)
            svg.line({left, y}, {left + 24.0, y}, colour + (series.isDashed ? " dashed" : ""));
        if (series.hasMarks)
            svg.circle({left + 12.0, y}, 2.6, fmt::format("f{}", series.colour % svgSeriesColours));
        svg.text({left + 31.0, y + 4.0}, series.name);
        y += legendRow;
    }
}

Svg Plot::svg() const {
    const auto named = std::ranges::count_if(
        series_, [](const PlotSeries& series) { return !series.name.empty(); });
    Svg svg(width_, height_ + (named > 0 ? 6.0 : 0.0) + legendRow * static_cast<double>(named));
    drawAxes(svg);
    svg.beginClip({left, top - 3.0}, {width_ - left - right + 3.0, height_ - top - bottom + 6.0});
    for (const PlotSeries& series : series_) {
        std::vector<Eigen::Vector2d> places;
        for (const Eigen::Vector2d& point : series.points) places.push_back(place(point));
        const int colour = series.colour % svgSeriesColours;
        if (series.hasLine)
            svg.line(places, fmt::format("c{}{}", colour, series.isDashed ? " dashed" : ""));
        if (series.hasMarks)
            for (const Eigen::Vector2d& at : places)
                if (at.allFinite()) svg.circle(at, 2.6, fmt::format("f{}", colour));
    }
    svg.endClip();
    drawLegend(svg);
    return svg;
}

}  // namespace etendue
