// Small vectors: points, directions and normals of the scene, in metres unless a name says
// otherwise.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {

template <class T>
struct Vec2T {
    T x{}, y{};

    friend constexpr bool operator==(const Vec2T&, const Vec2T&) = default;
    friend constexpr Vec2T operator+(Vec2T a, Vec2T b) { return {a.x + b.x, a.y + b.y}; }
    friend constexpr Vec2T operator-(Vec2T a, Vec2T b) { return {a.x - b.x, a.y - b.y}; }
    friend constexpr Vec2T operator*(Vec2T a, T k) { return {a.x * k, a.y * k}; }
    friend constexpr Vec2T operator*(T k, Vec2T a) { return a * k; }
};

template <class T>
struct Vec3T {
    T x{}, y{}, z{};

    constexpr T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }

    friend constexpr bool operator==(const Vec3T&, const Vec3T&) = default;
    friend constexpr Vec3T operator+(Vec3T a, Vec3T b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec3T operator-(Vec3T a, Vec3T b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vec3T operator-(Vec3T a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vec3T operator*(Vec3T a, T k) { return {a.x * k, a.y * k, a.z * k}; }
    friend constexpr Vec3T operator*(T k, Vec3T a) { return a * k; }
    friend constexpr Vec3T operator/(Vec3T a, T k) { return {a.x / k, a.y / k, a.z / k}; }
    constexpr Vec3T& operator+=(Vec3T b) { return *this = *this + b; }
    constexpr Vec3T& operator-=(Vec3T b) { return *this = *this - b; }
    constexpr Vec3T& operator*=(T k) { return *this = *this * k; }
};

using Vec2 = Vec2T<float>;
using Vec3 = Vec3T<float>;
using Vec3d = Vec3T<double>;

template <class T>
constexpr T dot(Vec3T<T> a, Vec3T<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
constexpr T absDot(Vec3T<T> a, Vec3T<T> b) {
    const T d = dot(a, b);
    return d < 0 ? -d : d;
}

template <class T>
constexpr Vec3T<T> cross(Vec3T<T> a, Vec3T<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
constexpr T lengthSquared(Vec3T<T> a) {
    return dot(a, a);
}

template <class T>
T length(Vec3T<T> a) {
    return std::sqrt(lengthSquared(a));
}

/// The caller knows that `a` is not zero.
template <class T>
Vec3T<T> normalize(Vec3T<T> a) {
    return a * (T{1} / length(a));
}

/// Of a vector that is unit but for rounding ε: unit to ε², without root and division.
template <class T>
constexpr Vec3T<T> renormalize(Vec3T<T> a) {
    return a * (T(1.5) - T(0.5) * lengthSquared(a));
}

template <class T>
Vec3T<T> abs(Vec3T<T> a) {
    return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}

template <class T>
constexpr Vec3T<T> min(Vec3T<T> a, Vec3T<T> b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

template <class T>
constexpr Vec3T<T> max(Vec3T<T> a, Vec3T<T> b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

template <class T>
constexpr T maxComponent(Vec3T<T> a) {
    return std::max({a.x, a.y, a.z});
}

template <class T>
bool isFinite(Vec3T<T> a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

constexpr Vec3d toDouble(Vec3 a) { return {a.x, a.y, a.z}; }
constexpr Vec3 toFloat(Vec3d a) {
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float inversePi = std::numbers::inv_pi_v<float>;

constexpr float square(float x) { return x * x; }

}  // namespace etendue
