// Plot: curves and marks over two axes, linear or logarithmic.
#pragma once

#include "tools/svg.h"

namespace etendue {

/// The largest of 1, 2, 5 times a power of ten that is not above `value`, which is positive; for
/// ticks and scale bars.
double niceBelow(double value);

enum class AxisScale { linear, logarithmic };

struct PlotAxis {
    std::string label;  // with its unit
    double low, high;
    AxisScale scale = AxisScale::linear;
};

/// The axis that shows all of `values`, and zero if it is linear and `withZero`. Values that are
/// not finite, or not positive on a logarithmic axis, do not count.
PlotAxis axisFor(std::string label, std::span<const double> values,
                 AxisScale scale = AxisScale::linear, bool withZero = true);

/// Places for ticks, at 1, 2 or 5 times a power of ten, about `count`; on a logarithmic axis the
/// powers of ten, with 2 and 5 between where there are few.
std::vector<double> tickValues(const PlotAxis& axis, int count = 6);
std::string tickText(double value);

struct PlotSeries {
    std::string name;  // in the legend; empty: not there
    std::vector<Eigen::Vector2d> points;
    int colour = 0;  // of svgSeriesColours
    bool hasLine = true, hasMarks = false, isDashed = false;
};

class Plot {
public:
    Plot(std::string title, PlotAxis x, PlotAxis y, double width = 440.0, double height = 320.0);
    void add(PlotSeries series) { series_.push_back(std::move(series)); }
    Svg svg() const;

    /// Of a value pair in the picture.
    Eigen::Vector2d place(const Eigen::Vector2d& value) const;

private:
    double share(const PlotAxis& axis, double value) const;
    void drawAxes(Svg& svg) const;
    void drawLegend(Svg& svg) const;

    std::string title_;
    PlotAxis x_, y_;
    double width_, height_;
    std::vector<PlotSeries> series_;
};

}  // namespace etendue
