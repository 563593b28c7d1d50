// Transform: an affine map, kept in double so that composed transforms lose nothing the eye could
// see.
#pragma once

#include "renderer/vec.h"

namespace etendue {

struct Transform {
    // Columns of the linear part, then the translation.
    Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, translation{};

    friend bool operator==(const Transform&, const Transform&) = default;

    Vec3d vector(Vec3d v) const { return x * v.x + y * v.y + z * v.z; }
    Vec3d point(Vec3d p) const { return vector(p) + translation; }
    /// Negative when the map mirrors; zero when it cannot be inverted.
    double determinant() const { return dot(x, cross(y, z)); }

    /// The inverse transpose of the linear part times the determinant: maps normals, up to length
    /// and, for a mirroring map, up to sign.
    Vec3d normal(Vec3d n) const {
        return cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z;
    }

    /// `determinant()` must not be zero.
    Transform inverse() const {
        const double k = 1.0 / determinant();
        const Vec3d rowX = cross(y, z) * k, rowY = cross(z, x) * k, rowZ = cross(x, y) * k;
        Transform result{
            {rowX.x, rowY.x, rowZ.x}, {rowX.y, rowY.y, rowZ.y}, {rowX.z, rowY.z, rowZ.z}, {}};
        result.translation = -result.vector(translation);
        return result;
    }

    friend Transform operator*(const Transform& a, const Transform& b) {
        return {a.vector(b.x), a.vector(b.y), a.vector(b.z), a.point(b.translation)};
    }

    static Transform translate(Vec3d t) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, t}; }
    static Transform scale(Vec3d s) { return {{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}, {}}; }
    /// Counter-clockwise about the unit `axis` as seen against it (Rodrigues).
    static Transform rotate(Vec3d axis, double degrees) {
        const double angle = degrees * std::numbers::pi / 180.0;
        const double c = std::cos(angle), s = std::sin(angle);
        const auto column = [&](Vec3d e) {
            return e * c + cross(axis, e) * s + axis * (dot(axis, e) * (1 - c));
        };
        return {column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1}), {}};
    }
};

}  // namespace etendue
