// SurfaceShape: the geometry of one lens surface about its vertex, and its equation.
#pragma once

#include <array>
#include <cmath>

#include "lens/vector3.h"

namespace etendue {

/// The surface z = sag(x, y), mm, vertex at the origin, +z toward the scene:
///     sag = c h² / (1 + √(1 − (1+k) c² h²)) + a₄ h⁴ + a₆ h⁶ + … + a₁₆ h¹⁶,   h² = x² + y²,
/// where a cylinder's h² leaves out the axis along which it is flat.
struct SurfaceShape {
    double curvature = 0.0;           // c, 1/mm: positive if the centre lies toward the scene
    double conic = 0.0;               // k
    std::array<double, 7> asphere{};  // a₄ … a₁₆, mm⁻³ … mm⁻¹⁵
    bool curvedInX = true, curvedInY = true;
    bool isAsphere = false;  // whether any aᵢ differs from 0

    bool isSphereOrPlane() const { return curvedInX && curvedInY && !isAsphere && conic == 0.0; }
};

/// h² of the sag.
template <class T>
T heightSquared(const SurfaceShape& shape, const T& x, const T& y) {
    T sum(0.0);
    if (shape.curvedInX) sum = sum + x * x;
    if (shape.curvedInY) sum = sum + y * y;
    return sum;
}

/// 1 − (1+k) c² h², what the sag's root is taken of; the conic ends where it is zero.
template <class T>
T conicRadicand(const SurfaceShape& shape, const T& squared) {
    return 1.0 - (1.0 + shape.conic) * shape.curvature * shape.curvature * squared;
}

/// Against h²; not a number beyond the conic's end.
template <class T>
T sag(const SurfaceShape& shape, const T& squared) {
    using std::sqrt;
    T polynomial(0.0);
    if (shape.isAsphere) {
        for (std::size_t i = shape.asphere.size(); i-- > 0;)
            polynomial = polynomial * squared + shape.asphere[i];
        polynomial = polynomial * squared * squared;
    }
    return shape.curvature * squared / (1.0 + sqrt(conicRadicand(shape, squared))) + polynomial;
}

/// d sag / d(h²).
template <class T>
T sagDerivative(const SurfaceShape& shape, const T& squared) {
    using std::sqrt;
    T polynomial(0.0);
    if (shape.isAsphere) {
        for (std::size_t i = shape.asphere.size(); i-- > 0;)
            polynomial = polynomial * squared + (static_cast<double>(i) + 2.0) * shape.asphere[i];
        polynomial = polynomial * squared;
    }
    return 0.5 * shape.curvature / sqrt(conicRadicand(shape, squared)) + polynomial;
}

/// Zero on the surface, negative on the sensor's side. An asphere's is z − sag; any other's is
/// z − ½ c (h² + (1+k) z²), which has no root.
template <class T>
T levelSet(const SurfaceShape& shape, const Vector3<T>& p) {
    const T squared = heightSquared(shape, p.x, p.y);
    if (shape.isAsphere) return p.z - sag(shape, squared);
    return p.z - 0.5 * shape.curvature * (squared + (1.0 + shape.conic) * p.z * p.z);
}

/// Of the level set: normal to the surface, toward the scene, of unit length on spheres and planes.
template <class T>
Vector3<T> gradient(const SurfaceShape& shape, const Vector3<T>& p) {
    const T zero(0.0);
    if (shape.isAsphere) {
        const T slope = -2.0 * sagDerivative(shape, heightSquared(shape, p.x, p.y));
        return {slope * p.x, slope * p.y, T(1.0)};
    }
    return {shape.curvedInX ? p.x * -shape.curvature : zero,
            shape.curvedInY ? p.y * -shape.curvature : zero,
            1.0 - p.z * (shape.curvature * (1.0 + shape.conic))};
}

}  // namespace etendue
