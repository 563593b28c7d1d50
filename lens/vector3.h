// Vector3: points and directions of a ray trace, over double or Dual.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "lens/dual.h"

namespace etendue {

template <class T>
struct Vector3 {
    T x, y, z;

    friend Vector3 operator+(const Vector3& a, const Vector3& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend Vector3 operator-(const Vector3& a, const Vector3& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
};

/// `factor` is a T or a double.
template <class T, class Factor>
Vector3<T> operator*(const Vector3<T>& a, const Factor& factor) {
    return {a.x * factor, a.y * factor, a.z * factor};
}

template <class T>
T dot(const Vector3<T>& a, const Vector3<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
Vector3<T> normalized(const Vector3<T>& a) {
    using std::sqrt;
    return a * (1.0 / sqrt(dot(a, a)));
}

template <class T>
Vector3<double> valueOf(const Vector3<T>& a) {
    return {valueOf(a.x), valueOf(a.y), valueOf(a.z)};
}

/// By the variable with number `index`.
template <int N>
Vector3<double> partialsOf(const Vector3<Dual<N>>& a, std::size_t index) {
    return {a.x.partials[index], a.y.partials[index], a.z.partials[index]};
}
template <int N>
void setPartials(Vector3<Dual<N>>& a, std::size_t index, const Vector3<double>& partials) {
    a.x.partials[index] = partials.x;
    a.y.partials[index] = partials.y;
    a.z.partials[index] = partials.z;
}

/// Rows x, y, z.
inline Eigen::Matrix<double, 3, 2> partials(const Vector3<Dual<2>>& a) {
    Eigen::Matrix<double, 3, 2> result;
    result << a.x.partials[0], a.x.partials[1],  //
        a.y.partials[0], a.y.partials[1],        //
        a.z.partials[0], a.z.partials[1];
    return result;
}

inline Eigen::Vector3d toEigen(const Vector3<double>& a) { return {a.x, a.y, a.z}; }
inline Vector3<double> fromEigen(const Eigen::Vector3d& a) { return {a.x(), a.y(), a.z()}; }

/// A line with a direction; the direction is of unit length.
template <class T>
struct LensRay {
    Vector3<T> origin, direction;
};

}  // namespace etendue
