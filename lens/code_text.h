// Neutral text: expressions and functions in what C++ and GLSL have in common. What they do not is
// written as a word that each language has its own text for:
//
//     @name       a function or struct of the generated lens
//     FUNCTION    in front of a function
//     MAYBE_UNUSED   in front of a variable or parameter
//     REAL        the type of a number
//     JET         the type of a number with its derivatives by two variables; jets add up and take
//                 a REAL as factor by operators, all else by functions: @product, @inverse, @root,
//                 and @still, which makes one without derivatives
//     .VALUE .BYX .BYY   of a jet
//     1.0         a REAL: any literal with a point
#pragma once

#include <string>

#include "lens/polynomial_basis.h"

namespace etendue {

/// Shortest decimal that reads back as `number`, with a point.
std::string literal(double number);

enum class CodeLanguage;

/// Neutral text as one of the languages. `name`: that of the lens, in GLSL.
std::string translate(const std::string& neutral, CodeLanguage language, const std::string& name);

/// Which inputs of a polynomial are jets.
struct Moving {
    bool s, p;
};

/// An output that the code computes, and its name.
struct CodeOutput {
    int index;
    std::string name;
};

/// Statements of neutral text that define one variable for each of `wanted`, from variables sx, sy,
/// px, py (PolynomialInput) and nm. Vectors come out as jets, if any input is one; scalars as REAL.
std::string polynomialCode(const SparsePolynomial& polynomial, Moving moving,
                           const std::vector<CodeOutput>& wanted);

}  // namespace etendue
