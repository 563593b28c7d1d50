// etendue lens report: all that is known about a lens and its fit, on one page.
#pragma once

#include <array>

#include "lens/chromatic.h"
#include "lens/connect_survey.h"
#include "lens/distortion.h"
#include "lens/field_curvature.h"
#include "lens/fit_map.h"
#include "lens/illumination.h"
#include "lens/spot_diagram.h"
#include "tools/lens_draw.h"
#include "tools/lens_fit_command.h"
#include "tools/lens_info.h"

namespace etendue {

struct LensReportCommand {
    LensChoice choice;
    FitOptions options;
    std::filesystem::path folder;
    bool asJson = false;
};

/// What to type to have the report made again: of the options those that are not the default.
std::string commandLine(const LensReportCommand& command);

/// The lines F, d and C.
constexpr std::array<double, 3> reportLinesNm{fLineNm, dLineNm, cLineNm};

/// A line from the axis outward on the sensor: the diagonal of a lens of revolution, x and y of an
/// anamorphic one.
struct ReportAxis {
    std::string name;       // "x", "y"; empty for the only one
    Eigen::Vector2d along;  // unit
    double brightMm;        // where the illumination falls to 5 % of that on the axis, or the edge
    double edgeMm;          // of the fit's domain
    double chiefMm;         // as far as that, if chief rays pass
};

struct ReportSpot {
    ReportAxis axis;
    double heightMm, fieldDegrees;
    // For each of reportLinesNm, one for each aperture point: in the axis' frame, mm (outward,
    // across), from the centroid of the exact spot of all lines.
    std::array<std::vector<Eigen::Vector2d>, 3> exact, fitted;
    double exactRmsMm, fittedRmsMm;  // not a number where nothing was found
    double largestShiftMm;           // between an exact ray and its fitted twin
};

/// Curves along one axis.
struct ReportCurves {
    ReportAxis axis;
    std::vector<DistortionPoint> distortion;
    std::vector<Illumination> illumination;
    std::vector<double> heightsMm;                    // of lateral colour and field curvature
    std::array<std::vector<double>, 3> lateralMm;     // for each of reportLinesNm
    std::vector<PencilFocus> fieldCurvature;          // at the d line
    std::vector<double> apertureShares;               // of the focus shift
    std::array<std::vector<double>, 3> focusShiftMm;  // likewise
    FitMap map;                                       // at the d line
};

struct LensReport {
    LensInfo info;
    LensDrawing drawing;
    std::vector<ReportSpot> spots;
    std::vector<ReportCurves> curves;
    std::vector<Eigen::Vector2d> paraxialFocusMm;  // wavelength in nm; in front of the sensor, mm
    std::optional<PinholeDistortion> pinhole;
    std::optional<FisheyeDistortion> fisheye;
    ObtainedFit fit;
    std::vector<ConnectRing> newton, twoStep;
};
LensReport makeReport(const LensReportCommand& command);

/// The page, which needs no other file and no network.
std::string reportPage(const LensReport& report, const std::string& madeBy);
Json jsonOf(const LensReport& report);

/// Figures of the page.
Svg spotFigure(const ReportSpot& spot);
Svg distortionFigure(const LensReport& report);
Svg illuminationFigure(const ReportCurves& curves);
Svg lateralColourFigure(const ReportCurves& curves);
Svg focusShiftFigure(const ReportCurves& curves);
Svg fieldCurvatureFigure(const ReportCurves& curves);
Svg paraxialFocusFigure(const LensReport& report);
Svg fitMapFigure(const ReportCurves& curves, double apertureRadiusMm);
Svg iterationsFigure(const LensReport& report);
Svg failuresFigure(const LensReport& report);

/// Writes index.html and report.json into the folder, which is made if need be.
ExitCode runLensReport(const LensReportCommand& command);

}  // namespace etendue
