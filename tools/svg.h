// Svg: a vector picture being written. Lengths are its own units, x to the right and y down.
//
// Colours are names of classes (svgStyle below), so that a page can show the same picture on light
// and on dark; "" is the default of the element, and several names are separated by spaces.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Classes: ink, faint, rule, grid (lines); muted, bold (texts); glass, paper (areas); frame;
/// c0 … c5 (lines of a series), f0 … f5 (the same colours to fill); dashed, thin, heavy (lines).
std::string_view svgStyle();
constexpr int svgSeriesColours = 6;

/// Text made harmless between tags and in attributes.
std::string escapedXml(std::string_view text);

enum class TextAnchor { start, middle, end };

class Svg {
public:
    Svg(double width, double height) : width_(width), height_(height) {}

    double width() const { return width_; }
    double height() const { return height_; }

    /// Points that are not finite interrupt the line.
    void line(std::span<const Eigen::Vector2d> points, std::string_view classes);
    void line(Eigen::Vector2d from, Eigen::Vector2d to, std::string_view classes);
    void area(std::span<const Eigen::Vector2d> points, std::string_view classes,
              double opacity = 1.0);
    void rectangle(Eigen::Vector2d corner, Eigen::Vector2d size, std::string_view classes);
    /// `colour` as in CSS: for maps, whose colours mean numbers.
    void cell(Eigen::Vector2d corner, Eigen::Vector2d size, std::string_view colour);
    /// Small dots in the colour of a line's class; those that are not finite are left out.
    void dots(std::span<const Eigen::Vector2d> centres, std::string_view classes);
    void circle(Eigen::Vector2d centre, double radius, std::string_view classes);
    void text(Eigen::Vector2d at, std::string_view text, TextAnchor anchor = TextAnchor::start,
              std::string_view classes = "", double turnedByDegrees = 0.0);
    /// Everything between is cut to a rectangle.
    void beginClip(Eigen::Vector2d corner, Eigen::Vector2d size);
    void endClip();
    /// Another picture with its upper left corner there.
    void place(const Svg& other, Eigen::Vector2d corner);

    /// A file of its own, on white.
    std::string document() const;
    /// For a page that has svgStyle() already; `title` is read to those who do not see it.
    std::string inlined(std::string_view title) const;

private:
    std::string opening(std::string_view attributes) const;

    double width_, height_;
    std::string body_;
};

}  // namespace etendue
