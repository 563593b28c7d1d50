#include <cmath>
#include <limits>

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
    path[0].isConnectable = path[t - 1].isConnectable = true;
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

LaneFlags reachableLanes(const View& view, const CameraSample& start, const CameraSubpath& path) {
    LaneFlags isReachable{};
    const bool isEscape = path.vertices.size() < 2;
    if (isEscape && !path.escape) return isReachable;
    // A mirror that shines is connected as a light.
    if (!isEscape && !canConnect(path.vertices[1]) && path.vertices[1].point.light < 0)
        return isReachable;
    const Camera& camera = view.camera;
    const Wavelengths& wavelengths = start.color.wavelengths;
    if (start.origins) {
        const float distance = isEscape
                                   ? std::numeric_limits<float>::infinity()
                                   : length(path.vertices[1].point.position - start.ray->origin);
        for (std::size_t lane = 0; lane < isReachable.size(); ++lane)
            if (const auto& origin = (*start.origins)[lane])
                isReachable[lane] = camera.findsAgain(*origin, distance, wavelengths, lane);
        return isReachable;
    }
    const std::optional<CameraConnection> connection =
        isEscape
            ? camera.connectToInfinity(path.escape->direction, start.apertureUniform, wavelengths)
            : camera.connect(path.vertices[1].point.position, start.apertureUniform, wavelengths);
    constexpr auto tolerance = static_cast<float>(Camera::sameFilmTolerance);
    isReachable[0] = connection && std::abs(connection->film.x - start.film.x) < tolerance &&
                     std::abs(connection->film.y - start.film.y) < tolerance;
    return isReachable;
}

float lightOriginDensity(const LightSubpath& light, std::size_t s, const PathVertex& y,
                         float pdfSolidAngle) {
    if (s == 2 && light.isDirac) return 0.0f;
    return densityAt(light.vertices[s - 2], y, pdfSolidAngle);
}

}  // namespace etendue
