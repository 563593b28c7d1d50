// Frame: an orthonormal basis whose z axis is a normal; "local" is the space of the BSDFs.
#pragma once

#include "renderer/vec.h"

namespace etendue {

struct Frame {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    /// The basis around unit vector `n`, continuous but for a sign change at n.z = 0
    /// (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    static Frame fromZ(Vec3 n) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x},
                {b, sign + n.y * n.y * a, -n.y},
                n};
    }

    Vec3 localFromWorld(Vec3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    Vec3 worldFromLocal(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
};

}  // namespace etendue
