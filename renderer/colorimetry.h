// Colorimetry: from spectra to what the eye calls their colour.
#pragma once

#include "renderer/vec.h"

namespace etendue {

/// CIE 1931 colour matching functions (Wyman, Sloan and Shirley 2013, "Simple Analytic
/// Approximations to the CIE XYZ Color Matching Functions").
Vec3d xyzMatching(double wavelengthNm);

/// CIE standard illuminant D65 (ISO 11664-2), 380 … 780 nm, 100 at 560 nm.
double d65(double wavelengthNm);

/// Linear Rec. 709, and back. White, (1, 1, 1), is D65.
Vec3d rec709FromXyz(Vec3d xyz);
Vec3d xyzFromRec709(Vec3d rgb);

}  // namespace etendue
