// LensChoice: which lens, and how it is set; what the commands about lenses have in common.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lens/fit_domain.h"

namespace etendue {

struct LensChoice {
    std::string lens;          // a file, or the bare name of one in scenes/lenses
    std::string zoomPosition;  // empty: the first
    std::vector<double> sensorMm = {36.0, 24.0};
    double focusMetres = std::numeric_limits<double>::infinity();  // from the sensor
    std::optional<double> fNumber = {};                            // empty: wide open
};

/// The file itself, or scenes/lenses/NAME.toml in the current folder, in a folder above it, or in
/// one above this program. Throws InputError, naming the nearest.
std::filesystem::path findLensFile(const std::string& lens);

Prescription loadPrescription(const LensChoice& choice);
LensSettings settingsOf(const LensChoice& choice);
DomainRequest requestOf(const LensChoice& choice);

/// "Zoom, 57 to 143 mm f/2.8, at 57 mm": the lens' name, and its zoom position if it has any.
std::string titleOf(const Prescription& prescription);

/// "f/4.00, focus at 1.5 m", "f/2.81 wide open, focus at infinity". `fNumber` is the lens' as it is
/// set.
std::string describe(const LensChoice& choice, double fNumber);

}  // namespace etendue
