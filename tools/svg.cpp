#include "tools/svg.h"

#include <fmt/format.h>

#include <array>

namespace etendue {

namespace {

/// To a hundredth of a unit, without trailing zeros.
std::string number(double value) {
    std::string text = fmt::format("{:.2f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

std::string pair(const Eigen::Vector2d& point) {
    return number(point.x()) + " " + number(point.y());
}

std::string classAttribute(std::string_view classes) {
    return classes.empty() ? "" : fmt::format(" class=\"{}\"", classes);
}

std::string rectangleOf(const Eigen::Vector2d& corner, const Eigen::Vector2d& size) {
    return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"", number(corner.x()),
                       number(corner.y()), number(size.x()), number(size.y()));
}

std::string pathData(std::span<const Eigen::Vector2d> points) {
    std::string data;
    bool isPenDown = false;
    for (const Eigen::Vector2d& point : points) {
        if (point.allFinite()) data += (isPenDown ? "L" : "M") + pair(point);
        isPenDown = point.allFinite();
    }
    return data;
}

}  // namespace

std::string_view svgStyle() {
    return R"(svg{font:12px system-ui,-apple-system,"Segoe UI","DejaVu Sans",sans-serif}
svg path,svg circle{fill:none;stroke-width:1.2;stroke-linejoin:round;stroke-linecap:round}
svg text{fill:#1f2933}
svg .muted{fill:#616e7c}
svg .bold{font-weight:600;font-size:15px}
svg .ink{stroke:#1f2933}
svg .faint{stroke:#9aa5b1}
svg .rule{stroke:#7b8794;stroke-width:1}
svg .grid{stroke:#e4e7eb;stroke-width:1}
svg .thin{stroke-width:.8}
svg .heavy{stroke-width:2.4}
svg .frame{fill:none;stroke:#cbd2d9}
svg .dots{stroke-width:2}
svg .dashed{stroke-dasharray:5 4}
svg .glass{fill:#3f86c7;stroke:none}
svg .paper{fill:#fff;stroke:none}
svg .c0{stroke:#0b69b7}svg .f0{fill:#0b69b7;stroke:none}
svg .c1{stroke:#c2540a}svg .f1{fill:#c2540a;stroke:none}
svg .c2{stroke:#0a7d57}svg .f2{fill:#0a7d57;stroke:none}
svg .c3{stroke:#a1378b}svg .f3{fill:#a1378b;stroke:none}
svg .c4{stroke:#8a6a00}svg .f4{fill:#8a6a00;stroke:none}
svg .c5{stroke:#c22f3d}svg .f5{fill:#c22f3d;stroke:none}
)";
}

std::string escapedXml(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    }
    return result;
}

void Svg::line(std::span<const Eigen::Vector2d> points, std::string_view classes) {
    body_ += fmt::format("<path{} d=\"{}\"/>\n", classAttribute(classes), pathData(points));
}

void Svg::line(Eigen::Vector2d from, Eigen::Vector2d to, std::string_view classes) {
    const std::array points{from, to};
    line(points, classes);
}

void Svg::area(std::span<const Eigen::Vector2d> points, std::string_view classes, double opacity) {
    body_ += fmt::format("<path{} fill-opacity=\"{}\" d=\"{}Z\"/>\n", classAttribute(classes),
                         number(opacity), pathData(points));
}

void Svg::rectangle(Eigen::Vector2d corner, Eigen::Vector2d size, std::string_view classes) {
    body_ += rectangleOf(corner, size) + classAttribute(classes) + "/>\n";
}

void Svg::cell(Eigen::Vector2d corner, Eigen::Vector2d size, std::string_view colour) {
    body_ += rectangleOf(corner, size) +
             fmt::format(" fill=\"{}\" shape-rendering=\"crispEdges\"/>\n", colour);
}

void Svg::dots(std::span<const Eigen::Vector2d> centres, std::string_view classes) {
    std::string data;
    for (const Eigen::Vector2d& centre : centres)
        if (centre.allFinite()) data += "M" + pair(centre) + "h0";  // a line's round ends
    body_ += fmt::format("<path class=\"dots {}\" d=\"{}\"/>\n", classes, data);
}

void Svg::circle(Eigen::Vector2d centre, double radius, std::string_view classes) {
    body_ += fmt::format("<circle{} cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", classAttribute(classes),
                         number(centre.x()), number(centre.y()), number(radius));
}

void Svg::text(Eigen::Vector2d at, std::string_view text, TextAnchor anchor,
               std::string_view classes, double turnedByDegrees) {
    constexpr std::array<const char*, 3> anchors{"start", "middle", "end"};
    const std::string turn =
        turnedByDegrees == 0.0
            ? ""
            : fmt::format(" transform=\"rotate({} {})\"", number(turnedByDegrees), pair(at));
    body_ += fmt::format("<text{} x=\"{}\" y=\"{}\" text-anchor=\"{}\"{}>{}</text>\n",
                         classAttribute(classes), number(at.x()), number(at.y()),
                         anchors[static_cast<std::size_t>(anchor)], turn, escapedXml(text));
}

void Svg::beginClip(Eigen::Vector2d corner, Eigen::Vector2d size) {
    // A nested picture clips to its own window, and needs no name that must be unique on a page.
    body_ += fmt::format(
        "<svg x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" viewBox=\"{0} {1} {2} {3}\">\n",
        number(corner.x()), number(corner.y()), number(size.x()), number(size.y()));
}

void Svg::endClip() { body_ += "</svg>\n"; }

void Svg::place(const Svg& other, Eigen::Vector2d corner) {
    body_ += fmt::format("<g transform=\"translate({})\">\n{}</g>\n", pair(corner), other.body_);
}

std::string Svg::opening(std::string_view attributes) const {
    return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\"{}>\n",
                       number(width_), number(height_), attributes);
}

std::string Svg::document() const {
    const std::string size =
        fmt::format(" width=\"{}\" height=\"{}\"", number(width_), number(height_));
    return opening(size) + fmt::format("<style>\n{}</style>\n", svgStyle()) +
           rectangleOf({0.0, 0.0}, {width_, height_}) + " class=\"paper\"/>\n" + body_ + "</svg>\n";
}

std::string Svg::inlined(std::string_view title) const {
    // Never magnified: a small plot would shout on a wide page.
    const std::string attributes =
        fmt::format(" role=\"img\" style=\"max-width:{}px\"", number(width_));
    return opening(attributes) + fmt::format("<title>{}</title>\n", escapedXml(title)) + body_ +
           "</svg>\n";
}

}  // namespace etendue
