// Code generation: a fitted lens as source text that stands on its own, for renderers that know
// nothing of this library. The numbers of the fit become constants, its terms straight-line code.
//
//     C++    a header with one struct template over float or double; needs the standard library
//     GLSL   functions and structs for any shader stage; GLSL ES 3.00 and GLSL 4.50, in float
//
// Both hold the same functions, written once in a language between the two (code_text.h).
#pragma once

#include <string>

#include "lens/lens_fit.h"

namespace etendue {

enum class CodeLanguage { cPlusPlus, glsl };

/// What the code answers is what LensModel::trace() does: from a sensor point, an aperture point
/// and a wavelength, the ray that leaves the lens and its derivatives by the sensor point, or that
/// there is none: outside the fit's domain, at a rim, where the lens' map has turned over. `name`
/// becomes the struct's name in C++ and begins every name in GLSL: "double-gauss" makes
/// DoubleGauss<Real>::trace() of the one, and doubleGaussTrace() and DoubleGaussRay of the other.
std::string generateCode(const LensFit& fit, const Prescription& prescription,
                         CodeLanguage language, const std::string& name);

}  // namespace etendue
