// Metals whose optical constants have been measured.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "renderer/fresnel.h"

namespace etendue {

/// "gold", "silver", "copper", "aluminium".
std::vector<std::string> metalNames();

/// Complex refractive index η + i k at one wavelength.
struct OpticalConstants {
    double eta, k;
};

/// Interpolated from the measured table; constant beyond its ends (about 370 and 830 nm). `name` is
/// one of metalNames().
OpticalConstants opticalConstants(std::string_view name, double wavelengthNm);

/// For RGB scenes: lanes whose reflectance at normal incidence is the colour, in linear Rec. 709,
/// of the measured reflectance under D65. A lane that would reflect more than the metal does at any
/// visible wavelength is lowered to that: gold's red lies outside of what Rec. 709 can show.
ConductorOptics metalOptics(std::string_view name);

}  // namespace etendue
