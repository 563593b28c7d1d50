#include <cmath>

#include "renderer/bidirectional_sample.h"

namespace etendue {

PathWeight weightOf(BidirectionalSample& sample, std::span<const PathVertex> camera,
                    std::span<const PathVertex> light, const JoinDensities& join) {
    std::vector<VertexDensity>& path = sample.memory.path;
    path.clear();
    for (const PathVertex& v : camera) path.push_back(v.density);
    for (std::size_t i = light.size(); i-- > 0;) path.push_back(light[i].density);
    const std::size_t t = camera.size(), s = light.size();
    // Both ends take part with their continuous lobes, whatever the walks did there.
    path[t - 1].fromLight = join.cameraEnd;
    if (t >= 2) path[t - 1].isConnectable = true;
    if (t >= 3) path[t - 2].fromLight = join.beforeCameraEnd;
    if (s >= 1) {
        path[t].fromCamera = join.lightEnd;
        path[t].isConnectable = true;
    }
    if (s >= 2) path[t + 1].fromCamera = join.beforeLightEnd;
    const CameraSettings& frame = sample.view.camera.settings();
    const double lightPaths = 1.0 * sample.settings.lightPaths * frame.width * frame.height;
    return balanceWeight(path, {static_cast<int>(s), static_cast<int>(t)},
                         {sample.techniques, lightPaths});
}

bool isReachable(const View& view, const CameraSample& start, const CameraSubpath& path) {
    // Far below the distance of two roots, far above the rounding of the vertex.
    constexpr float tolerance = 0.1f;  // pixels
    const Wavelengths& wavelengths = start.color.wavelengths;
    std::optional<CameraConnection> connection;
    if (path.vertices.size() >= 2) {
        const PathVertex& first = path.vertices[1];
        // A mirror that shines is connected as a light.
        if (!canConnect(first) && first.point.light < 0) return false;
        connection = view.camera.connect(first.point.position, start.apertureUniform, wavelengths);
    } else if (path.escape) {
        connection = view.camera.connectToInfinity(path.escape->direction, start.apertureUniform,
                                                   wavelengths);
    }
    return connection && std::abs(connection->film.x - start.film.x) < tolerance &&
           std::abs(connection->film.y - start.film.y) < tolerance;
}

float lightOriginDensity(const LightSubpath& light, std::size_t s, const PathVertex& y,
                         float pdfSolidAngle) {
    if (s == 2 && light.isDirac) return 0.0f;
    return densityAt(light.vertices[s - 2], y, pdfSolidAngle);
}

}  // namespace etendue
