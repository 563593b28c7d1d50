#include "tools/path_shape.h"

namespace etendue {

bool PathShape::isMirror(int i) const {
    const auto scattersOn = [](const std::vector<PathVertex>& walk, int vertex) {
        return walk[static_cast<std::size_t>(vertex)].density.isConnectable;
    };
    if (i < technique_.t - 1) return !scattersOn(path_.cameraPath.vertices, i);
    // The last vertices of both walks are joined; where s = 0 that of the camera's is x_k.
    const int fromLight = edges() - i;
    if (i == technique_.t - 1 || fromLight == technique_.s - 1) return false;
    return !scattersOn(path_.lightPaths.front().vertices, fromLight);
}

bool PathShape::isMirrorsAlone() const {
    for (int i = 1; i < edges(); ++i)
        if (!isMirror(i)) return false;
    return true;
}

bool PathShape::isFoundByLens() const {
    return technique_.t == 1 || path_.cameraPath.vertices.front().density.isConnectable;
}

std::optional<PathShape::LightEnd> PathShape::light() const {
    if (technique_.s == 0) {
        const std::vector<PathVertex>& walk = path_.cameraPath.vertices;
        const auto end = static_cast<std::size_t>(technique_.t - 1);
        return LightEnd{false, end < walk.size() ? walk[end].point.light : -1};
    }
    if (technique_.s == 1 && technique_.t >= 2) return {};
    const LightSubpath& walk = path_.lightPaths.front();
    const bool isInfinite = walk.vertices.front().kind == PathVertex::Kind::infinite;
    return LightEnd{walk.isDirac, isInfinite && !walk.isDirac ? -1 : walk.light};
}

}  // namespace etendue
