#include "tools/lens_report.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "lens/polynomial_lens.h"
#include "lens/ray_path.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

ReportAxis makeAxis(const TracedLens& lens, const FitDomain& domain, std::string name,
                    const Eigen::Vector2d& along) {
    // Where the line leaves the rectangle of the sensor, or the picture.
    double edge = domain.imageRadiusMm;
    for (int i = 0; i < 2; ++i)
        if (along[i] > 0.0) edge = std::min(edge, domain.sensorHalfSizeMm[i] / along[i]);
    const double bright = std::min(edge, imageHeightMm(lens, along));
    constexpr int steps = 200;
    const MonochromaticLens atLine(lens, dLineNm);
    int reached = 0;
    while (reached < steps && atLine.trace({bright * (reached + 1) / steps * along}, {{0.0, 0.0}}))
        ++reached;
    return {std::move(name), along, bright, edge, bright * reached / steps};
}

std::vector<ReportAxis> axesOf(const TracedLens& lens, const FitDomain& domain,
                               bool isAnamorphicLens) {
    if (!isAnamorphicLens)
        return {makeAxis(lens, domain, "", domain.sensorHalfSizeMm.normalized())};
    return {makeAxis(lens, domain, "x", Eigen::Vector2d::UnitX()),
            makeAxis(lens, domain, "y", Eigen::Vector2d::UnitY())};
}

double fieldDegreesAt(const TracedLens& lens, const ReportAxis& axis, double heightMm) {
    const auto ray = middleRay(lens, MonochromaticLens(lens, dLineNm), {heightMm * axis.along});
    if (!ray) return std::numeric_limits<double>::quiet_NaN();
    return std::atan2(std::hypot(ray->direction.x(), ray->direction.y()), ray->direction.z()) /
           degree;
}

std::optional<ReportSpot> makeSpot(const TracedLens& exact, const PolynomialLens& fitted,
                                   const ReportAxis& axis, double heightMm,
                                   double focusDistanceMm) {
    constexpr int rays = 160;
    const auto target = objectPoint(exact, {heightMm * axis.along}, focusDistanceMm);
    if (!target) return {};
    const auto apertures = sunflower(exact.system().aperture.radiusMm(), rays);
    ReportSpot spot{axis, heightMm, fieldDegreesAt(exact, axis, heightMm), {}, {}, 0.0, 0.0, 0.0};
    std::vector<Eigen::Vector2d> allExact, allFitted;
    for (std::size_t line = 0; line < reportLinesNm.size(); ++line) {
        spot.exact[line] = spotDiagram(exact, *target, reportLinesNm[line], apertures);
        spot.fitted[line] = spotDiagram(fitted, *target, reportLinesNm[line], apertures);
        allExact.insert(allExact.end(), spot.exact[line].begin(), spot.exact[line].end());
        allFitted.insert(allFitted.end(), spot.fitted[line].begin(), spot.fitted[line].end());
    }
    for (std::size_t i = 0; i < allExact.size(); ++i) {
        const double shift = (allExact[i] - allFitted[i]).norm();
        if (std::isfinite(shift)) spot.largestShiftMm = std::max(spot.largestShiftMm, shift);
    }
    const SpotSize size = spotSize(allExact);
    if (size.points == 0) return {};
    spot.exactRmsMm = size.rmsRadiusMm;
    const SpotSize fittedSize = spotSize(allFitted);
    spot.fittedRmsMm =
        fittedSize.points > 0 ? fittedSize.rmsRadiusMm : std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector2d across(-axis.along.y(), axis.along.x());
    for (auto* lines : {&spot.exact, &spot.fitted})
        for (std::vector<Eigen::Vector2d>& points : *lines)
            for (Eigen::Vector2d& point : points) {
                const Eigen::Vector2d off = point - size.centroidMm;
                point = {off.dot(axis.along), off.dot(across)};
            }
    return spot;
}

std::vector<ReportSpot> makeSpots(const TracedLens& exact, const PolynomialLens& fitted,
                                  std::span<const ReportAxis> axes, double focusDistanceMm) {
    std::vector<ReportSpot> spots;
    for (const ReportAxis& axis : axes)
        // Not quite to the edge, where a spot would be cut in half, nor beyond the chief rays,
        // where the few rays that pass would speak for a spot that lies elsewhere.
        for (const double share : {0.0, 0.35, 0.6, 0.78, 0.9, 0.97}) {
            if (share == 0.0 && !spots.empty()) continue;
            auto spot = makeSpot(exact, fitted, axis, share * axis.chiefMm, focusDistanceMm);
            if (spot) spots.push_back(*std::move(spot));
        }
    return spots;
}

ReportCurves makeCurves(const TracedLens& exact, const PolynomialLens& fitted,
                        const ReportAxis& axis, double focusDistanceMm) {
    constexpr int steps = 24, mapFields = 36, mapApertures = 36, apertures = 3000;
    ReportCurves curves{axis,
                        distortionCurve(exact, axis.along, axis.brightMm, 2 * steps),
                        illuminationCurve(exact, axis.along, axis.brightMm, steps + 1, apertures),
                        {},
                        {},
                        {},
                        {},
                        {},
                        {}};
    for (int i = 0; i <= steps; ++i) {
        const double share = static_cast<double>(i) / steps;
        curves.heightsMm.push_back(share * axis.brightMm);
        curves.fieldCurvature.push_back(
            pencilFocus(exact, axis.along, curves.heightsMm.back(), focusDistanceMm));
        curves.apertureShares.push_back(std::max(share, 1e-2));  // close to the paraxial ray
        for (std::size_t line = 0; line < reportLinesNm.size(); ++line) {
            const double wavelengthNm = reportLinesNm[line];
            curves.lateralMm[line].push_back(lateralColourMm(
                exact, axis.along, curves.heightsMm.back(), wavelengthNm, focusDistanceMm));
            curves.focusShiftMm[line].push_back(focusShiftMm(
                exact, axis.along, curves.apertureShares.back(), wavelengthNm, focusDistanceMm));
        }
    }
    curves.map = fitMap(exact, fitted, axis.along, axis.edgeMm, exact.system().aperture.radiusMm(),
                        dLineNm, mapFields, mapApertures);
    return curves;
}

std::vector<Eigen::Vector2d> paraxialFocus(const TracedLens& lens, const FitDomain& domain,
                                           double focusDistanceMm) {
    constexpr int steps = 30;
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i <= steps; ++i) {
        const double wavelengthNm =
            std::lerp(domain.shortestWavelengthNm, domain.longestWavelengthNm, i / double(steps));
        const ParaxialData data = paraxialData(lens.system(), wavelengthNm);
        points.emplace_back(wavelengthNm,
                            domain.sensorDistanceMm - sensorDistanceMm(data, focusDistanceMm));
    }
    return points;
}

LensDrawing drawingFor(const Prescription& prescription, const LensReportCommand& command) {
    LensDrawCommand draw;
    draw.choice = command.choice;
    draw.hasTitle = false;
    return drawLens(prescription, draw);
}

}  // namespace

std::string commandLine(const LensReportCommand& command) {
    const LensReportCommand standard;
    std::string line = "etendue lens report " + command.choice.lens;
    const auto add = [&](const char* flag, const std::string& value) {
        line += fmt::format(" {} {}", flag, value);
    };
    const auto list = [](const std::vector<double>& numbers) {
        return fmt::format("{:g}", fmt::join(numbers, ","));
    };
    const LensChoice& choice = command.choice;
    const FitOptions& options = command.options;
    if (!choice.zoomPosition.empty()) add("--zoom", "\"" + choice.zoomPosition + "\"");
    if (choice.sensorMm != standard.choice.sensorMm) add("--sensor", list(choice.sensorMm));
    if (!std::isinf(choice.focusMetres)) add("--focus", fmt::format("{:g}", choice.focusMetres));
    if (choice.fNumber) add("--f-number", fmt::format("{:g}", *choice.fNumber));
    if (options.terms != standard.options.terms) add("--terms", std::to_string(options.terms));
    if (options.degree != standard.options.degree) add("--degree", std::to_string(options.degree));
    if (options.basis) add("--basis", std::string(basisName(*options.basis)));
    if (options.form == FitForm::sensorState) add("--form", "sensor-state");
    if (options.wavelengthsNm != standard.options.wavelengthsNm)
        add("--wavelengths", list(options.wavelengthsNm));
    add("-o", command.folder.string());
    return line;
}

LensReport makeReport(const LensReportCommand& command) {
    LensInfo info = lensInfo(command.choice);
    const Prescription& prescription = info.prescription;
    const double focusDistanceMm = 1e3 * command.choice.focusMetres;
    ObtainedFit obtained = obtainFit(prescription, command.choice, command.options);
    const FitDomain& domain = obtained.fit.domain;
    const TracedLens exact = lensOf(prescription, domain);
    const PolynomialLens fitted(prescription, obtained.fit, Aperture(domain.apertureRadiusMm));
    const std::vector<ReportAxis> axes = axesOf(exact, domain, isAnamorphic(prescription));
    std::vector<ReportCurves> curves;
    for (const ReportAxis& axis : axes)
        curves.push_back(makeCurves(exact, fitted, axis, focusDistanceMm));
    double brightMm = 0.0;
    for (const ReportAxis& axis : axes) brightMm = std::max(brightMm, axis.brightMm);
    const std::vector<FieldRay> rays = chiefRays(exact, domain.sensorHalfSizeMm, brightMm);
    constexpr int rings = 10, raysPerRing = 500;
    constexpr std::array distancesMm{100.0, 1e3, 1e4, 1e9};
    const auto survey = [&](ConnectMethod method) {
        return connectSurvey(fitted, method, distancesMm, rings, raysPerRing);
    };
    LensDrawing drawing = drawingFor(prescription, command);
    return {std::move(info),
            std::move(drawing),
            makeSpots(exact, fitted, axes, focusDistanceMm),
            std::move(curves),
            paraxialFocus(exact, domain, focusDistanceMm),
            fitPinhole(rays),
            fitFisheye(rays),
            obtained,
            survey(ConnectMethod::newton),
            survey(ConnectMethod::twoStep)};
}

ExitCode runLensReport(const LensReportCommand& command) {
    makeFolder(command.folder);
    for (const char* name : {"index.html", "report.json"}) checkWritable(command.folder / name);
    const LensReport report = makeReport(command);
    const std::string json = jsonOf(report).text();
    writeWholeFile(command.folder / "index.html", reportPage(report, commandLine(command)));
    writeWholeFile(command.folder / "report.json", json + "\n");
    if (command.asJson)
        fmt::print("{}\n", json);
    else
        fmt::print("{}\n", (command.folder / "index.html").string());
    return ExitCode::success;
}

}  // namespace etendue
