// What a refracting surface lets through: Fresnel's equations, bare or under one thin film.
#pragma once

namespace etendue {

/// A single homogeneous layer on a surface, without dispersion.
struct Coating {
    double index = 1.38;  // magnesium fluoride
    double designWavelengthNm = 550.0;
    double thicknessWaves = 0.25;  // optical thickness, in design wavelengths
};

/// A ray that crosses from one index to another; cosines of the angles to the normal, both
/// positive.
struct Refraction {
    double indexFrom, indexTo;
    double cosFrom, cosTo;
};

/// Fraction of unpolarised light reflected at a bare surface, in [0, 1]. Born and Wolf,
/// "Principles of Optics", §1.5.2.
double reflectance(const Refraction& refraction);

/// The same under a coating (§1.6.4), whose index must be at least the smaller of the two.
double reflectance(const Refraction& refraction, const Coating& coating, double wavelengthNm);

}  // namespace etendue
