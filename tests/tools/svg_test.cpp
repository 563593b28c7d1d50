#include "tools/svg.h"

#include <doctest/doctest.h>

#include <limits>

#include "tests/tools/command_outcome.h"
#include "tools/svg_plot.h"

using namespace etendue;

TEST_CASE("Svg: texts are escaped, and gaps interrupt lines") {
    Svg svg(100.0, 50.0);
    svg.text({1.0, 2.0}, "a < \"b\" & c");
    const double gap = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Eigen::Vector2d> points{{0.0, 0.0}, {1.0, 1.5}, {gap, 0.0}, {3.0, 3.333}};
    svg.line(points, "ink");
    const std::string text = svg.document();
    CHECK(contains(text, "a &lt; &quot;b&quot; &amp; c"));
    CHECK(contains(text, "d=\"M0 0L1 1.5M3 3.33\""));
    CHECK(contains(text, "viewBox=\"0 0 100 50\""));
    CHECK(contains(svg.inlined("Title <1>"), "<title>Title &lt;1&gt;</title>"));
}

TEST_CASE("tickValues: ticks are round, inside and few") {
    CHECK(tickValues({"", 0.0, 1.0}) ==
          std::vector<double>{0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0});
    CHECK(tickValues({"", 0.0012, 3.0, AxisScale::logarithmic}) ==
          std::vector<double>{0.01, 0.1, 1.0});
    CHECK(tickValues({"", 3.0, 40.0, AxisScale::logarithmic}) ==
          std::vector<double>{5.0, 10.0, 20.0});
    for (const double high : {1e-6, 0.37, 9.9, 1234.0})
        for (const double low : {0.0, -0.3 * high}) {
            const std::vector<double> ticks = tickValues({"", low, high});
            CHECK(ticks.size() >= 3);
            CHECK(ticks.size() <= 13);
            CHECK(ticks.front() >= low - 1e-9 * high);
            CHECK(ticks.back() <= high * (1.0 + 1e-9));
        }
}

TEST_CASE("niceBelow: a length is 1, 2 or 5 of its decade, and not above what there is room for") {
    for (const double decade : {1e-6, 1.0, 1e4}) {
        CHECK(niceBelow(1.99 * decade) == doctest::Approx(decade));
        CHECK(niceBelow(2.0 * decade) == doctest::Approx(2.0 * decade));
        CHECK(niceBelow(4.99 * decade) == doctest::Approx(2.0 * decade));
        CHECK(niceBelow(5.0 * decade) == doctest::Approx(5.0 * decade));
        CHECK(niceBelow(9.99 * decade) == doctest::Approx(5.0 * decade));
    }
}

TEST_CASE("axisFor: it shows every value that can be shown") {
    const std::vector<double> values{0.003, std::numeric_limits<double>::infinity(), -0.2, 4.7};
    const PlotAxis linear = axisFor("x", values);
    CHECK(linear.low <= -0.2);
    CHECK(linear.high >= 4.7);
    const PlotAxis logarithmic = axisFor("x", values, AxisScale::logarithmic);
    CHECK(logarithmic.low > 0.0);
    CHECK(logarithmic.low <= 0.003);
    CHECK(logarithmic.high >= 4.7);
    const PlotAxis constant = axisFor("x", std::vector{2.0}, AxisScale::linear, false);
    CHECK(constant.low < constant.high);
}

TEST_CASE("Plot: a decade is as wide as the next one, and a tenth as wide as the next tenth") {
    const Plot plot("t", {"x", 0.0, 10.0}, {"y", 0.01, 100.0, AxisScale::logarithmic});
    const double bottom = plot.place({0.0, 0.01}).y(), top = plot.place({0.0, 100.0}).y();
    CHECK(plot.place({5.0, 1.0}).y() == doctest::Approx(0.5 * (bottom + top)));
    CHECK(plot.place({5.0, 1.0}).x() ==
          doctest::Approx(0.5 * (plot.place({0.0, 1.0}).x() + plot.place({10.0, 1.0}).x())));
    CHECK(bottom > top);  // y runs down in SVG
    CHECK_FALSE(plot.place({5.0, -1.0}).allFinite());
}

TEST_CASE("Plot: named series are in the legend") {
    Plot plot("Error & terms", {"terms", 1.0, 64.0, AxisScale::logarithmic}, {"mrad", 0.0, 1.0});
    plot.add({"axial", {{4.0, 0.5}, {16.0, 0.1}}, 1, true, true});
    plot.add({"", {{4.0, 0.5}, {16.0, 0.1}}});
    const std::string text = plot.svg().inlined("p");
    CHECK(contains(text, ">axial</text>"));
    CHECK(contains(text, "Error &amp; terms"));
}

TEST_CASE("tickText: numbers are short and minus is a minus") {
    CHECK(tickText(0.0) == "0");
    CHECK(tickText(-0.25) == "−0.25");
    CHECK(tickText(1e-5) == "1e−5");
    CHECK(tickText(-0.0) == "0");
}

TEST_CASE("axisFor: nothing but zeros still has an axis") {
    const PlotAxis axis = axisFor("y", std::vector{0.0, 0.0});
    CHECK(axis.low == 0.0);
    CHECK(axis.high >= 1.0);
}
