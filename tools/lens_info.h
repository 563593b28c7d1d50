// etendue lens info: what first-order optics and a few exact rays say about a lens.
#pragma once

#include "config/config.h"
#include "lens/axial_beam.h"
#include "lens/field.h"
#include "tools/json.h"
#include "tools/lens_choice.h"

namespace etendue {

struct LensInfoCommand {
    LensChoice choice;
    bool asJson = false;
};

struct LensInfo {
    Prescription prescription;
    ParaxialData paraxial;  // at the d line
    double stopRadiusMm;
    AxialBeam beam;           // through the stop as it is set
    double fNumber;           // of that beam
    double sensorDistanceMm;  // behind the last vertex
    Eigen::Vector2d sensorSizeMm;
    FieldOfView field;
    double imageCircleRadiusMm;  // where the illumination falls to 5 % of that on the axis
};
/// Of the beam; the geometric mean of x and y.
double fNumberOf(const ParaxialData& paraxial, const AxialBeam& beam);

LensInfo lensInfo(const LensChoice& choice);

struct InfoRow {
    std::string label, value;
};
std::vector<InfoRow> infoRows(const LensInfo& info);

/// A heading and one row a surface, from the scene to the sensor; indices of what is behind it.
std::vector<std::vector<std::string>> surfaceTable(const Prescription& prescription);

Json jsonOf(const LensInfo& info);

ExitCode runLensInfo(const LensInfoCommand& command);

}  // namespace etendue
