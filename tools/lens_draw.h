// etendue lens draw: a cross-section with exactly traced rays.
#pragma once

#include "config/config.h"
#include "lens/traced_lens.h"
#include "tools/json.h"
#include "tools/lens_choice.h"
#include "tools/svg.h"

namespace etendue {

struct LensDrawCommand {
    LensChoice choice;
    std::filesystem::path output;
    int fields = 3;        // from the axis to the edge of the picture
    int raysPerField = 7;  // at each wavelength
    std::vector<double> wavelengthsNm = {dLineNm};
    bool colourByWavelength = false;
    bool hasTitle = true;
    bool asJson = false;
};

/// One beam of the drawing.
struct DrawnField {
    Eigen::Vector2d sensorMm;  // where its middle ray meets the sensor
    double angleDegrees;       // of that in the scene, from the axis
    int rays;                  // that passed and are drawn
};

struct LensDrawing {
    Svg svg;
    std::vector<DrawnField> fields;
};
LensDrawing drawLens(const Prescription& prescription, const LensDrawCommand& command);

/// How far from the axis along x (0) or y (1) a sensor of that size sees anything: its half
/// diagonal, cut to where the illumination falls below 5 % of that on the axis.
double fieldHeightMm(const TracedLens& lens, const LensChoice& choice, int axis);

/// The class of svgStyle that looks like light of that wavelength: 0 … 5.
int colourOfWavelength(double wavelengthNm);

ExitCode runLensDraw(const LensDrawCommand& command);

}  // namespace etendue
