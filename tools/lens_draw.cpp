#include "tools/lens_draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lens/field.h"
#include "lens/ray_path.h"
#include "tools/lens_info.h"
#include "tools/lens_outline.h"
#include "tools/svg_plot.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

constexpr double pictureWidth = 1000.0, tallestPanel = 620.0, margin = 28.0;
constexpr double titleHeight = 38.0, headerHeight = 46.0, panelGap = 30.0, legendHeight = 34.0;

struct DrawnRay {
    std::vector<SectionPoint> points;
    int colour;
};

struct Bounds {
    SectionPoint low = SectionPoint::Constant(std::numeric_limits<double>::infinity());
    SectionPoint high = -low;
    void add(const SectionPoint& point) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    void add(std::span<const SectionPoint> points) {
        for (const SectionPoint& point : points) add(point);
    }
};

/// One plane of symmetry: all that is drawn in it, in mm.
struct Panel {
    SectionPlane plane;
    double sensorHalfMm;
    std::vector<GlassElement> elements;
    std::vector<DrawnRay> rays;
    Bounds bounds;
};

/// Light from one point of the scene, from a wavefront in front of the lens to the sensor.
void addBeam(Panel& panel, const TracedLens& lens, const LensDrawCommand& command,
             const Eigen::Vector3d& targetMm, DrawnField& field, int fieldNumber) {
    const Eigen::Vector2d along =
        panel.plane == SectionPlane::xz ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
    const double reach = -0.3 * lens.sensorZMm();
    for (const double wavelengthNm : command.wavelengthsNm) {
        const MonochromaticLens atLine(lens, wavelengthNm);
        const std::vector<AperturePoint> fan =
            clearFan(lens, atLine, targetMm, along, command.raysPerField);
        const int colour = command.colourByWavelength ? colourOfWavelength(wavelengthNm)
                                                      : fieldNumber % svgSeriesColours;
        std::optional<Eigen::Vector3d> front;  // of the beam's first ray
        for (const AperturePoint& aperture : fan) {
            const std::optional<RayPath> path = rayPath(lens, atLine, targetMm, aperture);
            if (!path) continue;
            const Eigen::Vector3d& exit = path->pointsMm.back();
            if (!front) front = exit;
            DrawnRay ray{{}, colour};
            for (const Eigen::Vector3d& point : path->pointsMm)
                ray.points.push_back(inSection(point, panel.plane));
            const double distance = reach + (*front - exit).dot(path->direction);
            ray.points.push_back(inSection(exit + distance * path->direction, panel.plane));
            panel.bounds.add(ray.points);
            panel.rays.push_back(std::move(ray));
            ++field.rays;
        }
    }
}

Panel makePanel(SectionPlane plane, const TracedLens& lens, const LensDrawCommand& command,
                std::vector<DrawnField>& fields) {
    const int axis = plane == SectionPlane::xz ? 0 : 1;
    const double height = fieldHeightMm(lens, command.choice, axis);
    Panel panel{plane, height, glassElements(lens.system(), plane), {}, {}};
    for (const GlassElement& element : panel.elements) panel.bounds.add(element.outline);
    const double stopRim = lens.system().surfaces[lens.system().stop].semiApertureMm * 1.25;
    const double stopX = -lens.system().surfaces[lens.system().stop].vertexZMm;
    panel.bounds.add({stopX, stopRim});
    panel.bounds.add({stopX, -stopRim});
    panel.bounds.add({-lens.sensorZMm(), height});
    panel.bounds.add({-lens.sensorZMm(), -height});
    for (int i = 0; i < command.fields; ++i) {
        const double share = command.fields == 1 ? 0.0 : i / (command.fields - 1.0);
        DrawnField field{{0.0, 0.0}, std::numeric_limits<double>::quiet_NaN(), 0};
        field.sensorMm[axis] = -share * height * 0.999;  // lest the last be just beyond the edge
        const auto middle = middleRay(lens, MonochromaticLens(lens, dLineNm), {field.sensorMm});
        const auto target = objectPoint(lens, {field.sensorMm}, 1e3 * command.choice.focusMetres);
        if (middle && target) {
            const Eigen::Vector3d& d = middle->direction;
            field.angleDegrees =
                std::atan2(std::hypot(d.x(), d.y()), d.z()) * 180.0 / std::numbers::pi;
            addBeam(panel, lens, command, *target, field, i);
        }
        fields.push_back(field);
    }
    return panel;
}

/// Millimetres to the picture's units.
struct PanelMap {
    double scale;
    Eigen::Vector2d offset;
    Eigen::Vector2d operator()(const SectionPoint& point) const {
        return offset + scale * Eigen::Vector2d(point.x(), -point.y());
    }
    std::vector<Eigen::Vector2d> operator()(std::span<const SectionPoint> points) const {
        std::vector<Eigen::Vector2d> result;
        for (const SectionPoint& point : points) result.push_back((*this)(point));
        return result;
    }
};

/// Denser glass is darker: n = 1.4 to 2.1 as 0.14 to 0.7.
double shade(double index) { return std::clamp(0.14 + 0.8 * (index - 1.4), 0.1, 0.7); }

void drawPanel(Svg& svg, const Panel& panel, const TracedLens& lens, const PanelMap& map) {
    svg.line(map({panel.bounds.low.x(), 0.0}), map({panel.bounds.high.x(), 0.0}),
             "faint dashed thin");
    for (const GlassElement& element : panel.elements) {
        const std::vector<Eigen::Vector2d> outline = map(element.outline);
        svg.area(outline, "glass", shade(element.index));
    }
    for (const DrawnRay& ray : panel.rays)
        svg.line(map(ray.points), fmt::format("c{} thin", ray.colour));
    for (const GlassElement& element : panel.elements) {
        std::vector<Eigen::Vector2d> outline = map(element.outline);
        outline.push_back(outline.front());
        svg.line(outline, "ink");
    }
    const OpticalSystem& system = lens.system();
    const TracedSurface& stop = system.surfaces[system.stop];
    const double open = system.aperture.radiusMm(), rim = stop.semiApertureMm * 1.25;
    for (const double side : {1.0, -1.0}) {
        svg.line(map({-stop.vertexZMm, side * open}), map({-stop.vertexZMm, side * rim}),
                 "ink heavy");
        const Eigen::Vector2d foot = map({-stop.vertexZMm, side * open});
        svg.line(foot - Eigen::Vector2d(5.0, 0.0), foot + Eigen::Vector2d(5.0, 0.0), "ink heavy");
    }
    svg.line(map({-lens.sensorZMm(), panel.sensorHalfMm}),
             map({-lens.sensorZMm(), -panel.sensorHalfMm}), "ink heavy");
}

void drawScaleBar(Svg& svg, Eigen::Vector2d rightEnd, double scale) {
    const double length = niceBelow(160.0 / scale);
    const Eigen::Vector2d leftEnd = rightEnd - Eigen::Vector2d(length * scale, 0.0);
    svg.line(leftEnd, rightEnd, "ink");
    for (const Eigen::Vector2d& end : {leftEnd, rightEnd})
        svg.line(end - Eigen::Vector2d(0.0, 4.0), end + Eigen::Vector2d(0.0, 4.0), "ink");
    svg.text(leftEnd - Eigen::Vector2d(8.0, -4.0), fmt::format("{:g} mm", length), TextAnchor::end);
}

void drawLegend(Svg& svg, Eigen::Vector2d at, const LensDrawCommand& command,
                std::span<const DrawnField> fields) {
    const auto entry = [&](int colour, const std::string& text) {
        svg.line(at, at + Eigen::Vector2d(22.0, 0.0), fmt::format("c{} heavy", colour));
        svg.text(at + Eigen::Vector2d(28.0, 4.0), text);
        at.x() += 44.0 + 7.0 * static_cast<double>(text.size());
    };
    if (!command.colourByWavelength) {
        svg.text(at + Eigen::Vector2d(0.0, 4.0),
                 "from the axis in the scene, on the sensor:", TextAnchor::start, "muted");
        at.x() += 262.0;
    }
    if (command.colourByWavelength)
        for (const double wavelengthNm : command.wavelengthsNm)
            entry(colourOfWavelength(wavelengthNm), fmt::format("{:.0f} nm", wavelengthNm));
    else
        for (std::size_t i = 0; i < fields.size(); ++i)
            entry(static_cast<int>(i) % svgSeriesColours,
                  fmt::format("{:.1f}°, {:.1f} mm", fields[i].angleDegrees,
                              fields[i].sensorMm.norm()));
}

void drawTitle(Svg& svg, const Prescription& prescription) {
    svg.text({margin, 26.0}, titleOf(prescription), TextAnchor::start, "bold");
    svg.text({margin, 44.0}, prescription.source, TextAnchor::start, "muted");
}

void drawSetting(Svg& svg, double y, const LensDrawCommand& command, const TracedLens& lens) {
    const double fNumber = fNumberOf(paraxialData(lens.system()), widestAxialBeam(lens.system()));
    svg.text(
        {margin, y},
        fmt::format("f = {:.2f} mm, {}, sensor {:g} × {:g} mm; rays traced exactly at {:.0f} nm",
                    lens.focalLengthMm(), describe(command.choice, fNumber),
                    command.choice.sensorMm[0], command.choice.sensorMm[1],
                    fmt::join(command.wavelengthsNm, ", ")),
        TextAnchor::start, "muted");
}

}  // namespace

double fieldHeightMm(const TracedLens& lens, const LensChoice& choice, int axis) {
    const double half = 0.5 * std::hypot(choice.sensorMm[0], choice.sensorMm[1]);
    return std::min(half, imageHeightMm(lens, Eigen::Vector2d::Unit(axis)));
}

int colourOfWavelength(double wavelengthNm) {
    if (wavelengthNm < 450.0) return 3;
    if (wavelengthNm < 500.0) return 0;
    if (wavelengthNm < 575.0) return 2;
    return wavelengthNm < 600.0 ? 4 : 5;
}

LensDrawing drawLens(const Prescription& prescription, const LensDrawCommand& command) {
    const auto lens = makeTracedLens(prescription, settingsOf(command.choice));
    std::vector<DrawnField> fields;
    std::vector<Panel> panels{makePanel(SectionPlane::yz, *lens, command, fields)};
    const std::vector<DrawnField> fieldsInY = fields;
    if (isAnamorphic(prescription))
        panels.push_back(makePanel(SectionPlane::xz, *lens, command, fields));
    double scale = std::numeric_limits<double>::infinity();
    for (const Panel& panel : panels) {
        const SectionPoint size = panel.bounds.high - panel.bounds.low;
        scale =
            std::min({scale, (pictureWidth - 2.0 * margin) / size.x(), tallestPanel / size.y()});
    }
    const double header = headerHeight + (command.hasTitle ? titleHeight : 0.0);
    double height = header + legendHeight;
    for (const Panel& panel : panels)
        height += scale * (panel.bounds.high.y() - panel.bounds.low.y()) + panelGap;
    Svg svg(pictureWidth, height);
    if (command.hasTitle) drawTitle(svg, prescription);
    drawSetting(svg, header - 22.0, command, *lens);
    double top = header;
    for (const Panel& panel : panels) {
        const SectionPoint size = panel.bounds.high - panel.bounds.low;
        const double left = 0.5 * (pictureWidth - scale * size.x());
        const PanelMap map{
            scale, {left - scale * panel.bounds.low.x(), top + scale * panel.bounds.high.y()}};
        if (panels.size() > 1)
            svg.text({margin, top + 12.0},
                     panel.plane == SectionPlane::xz ? "xz plane" : "yz plane", TextAnchor::start,
                     "muted");
        drawPanel(svg, panel, *lens, map);
        top += scale * size.y() + panelGap;
    }
    drawLegend(svg, {margin, height - 22.0}, command, fieldsInY);
    drawScaleBar(svg, {pictureWidth - margin, height - 22.0}, scale);
    return {std::move(svg), std::move(fields)};
}

ExitCode runLensDraw(const LensDrawCommand& command) {
    checkDistinct({{"-o", command.output}}, {{"the lens", findLensFile(command.choice.lens)}});
    checkWritable(command.output);
    const LensDrawing drawing = drawLens(loadPrescription(command.choice), command);
    writeWholeFile(command.output, drawing.svg.document());
    if (command.asJson) {
        Json fields = Json::array();
        for (const DrawnField& field : drawing.fields)
            fields.add(Json::object(
                {{"sensor_mm", Json::numbers({field.sensorMm.x(), field.sensorMm.y()})},
                 {"angle_degrees", field.angleDegrees},
                 {"rays", field.rays}}));
        fmt::print("{}\n",
                   Json::object({{"file", command.output.string()}, {"fields", fields}}).text());
    }
    return ExitCode::success;
}

}  // namespace etendue
