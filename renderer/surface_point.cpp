#include "renderer/surface_point.h"

#include "renderer/intersector.h"
#include "renderer/lanes.h"

namespace etendue {

namespace {

/// A Transform of lanes: the same sums.
struct LanesTransform {
    explicit LanesTransform(const Transform& t)
        : x(loadLanes(t.x)),
          y(loadLanes(t.y)),
          z(loadLanes(t.z)),
          translation(loadLanes(t.translation)) {}

    DoubleLanes vector(DoubleLanes v) const { return x * v[0] + y * v[1] + z * v[2]; }
    DoubleLanes point(DoubleLanes p) const { return vector(p) + translation; }
    DoubleLanes normal(DoubleLanes n) const {
        return cross(y, z) * n[0] + cross(z, x) * n[1] + cross(x, y) * n[2];
    }
    bool isMirroring() const {
        const DoubleLanes parts = x * cross(y, z);
        return parts[0] + parts[1] + parts[2] < 0.0;
    }
    /// Of a vector whose components are at most those of `magnitude`, at most how large these are.
    DoubleLanes largestVector(DoubleLanes magnitude) const {
        return abs(x) * magnitude[0] + abs(y) * magnitude[1] + abs(z) * magnitude[2];
    }

    DoubleLanes x, y, z, translation;
};

/// What float rounding inside the intersector can move the triangle's plane by: it works on vertex
/// differences relative to the ray's origin, each rounded at the magnitude of the coordinates, and
/// a rounding in one axis tilts the plane into the others, so that the bound is the same for all.
/// docs/precision.md.
Vec3 positionErrorOf(DoubleLanes magnitude) {
    constexpr double roundings = 4.0;
    constexpr double epsilon = 0x1p-24;
    const auto error = static_cast<float>(maxComponent(vecOf(magnitude)) * roundings * epsilon);
    return {error, error, error};
}

/// In an instance the ray's origin is also carried through the rounded inverse transform.
DoubleLanes magnitudeInInstance(DoubleLanes magnitude, const LanesTransform& worldFromMesh,
                                const Transform& meshFromWorld) {
    const DoubleLanes offset = abs(worldFromMesh.translation);
    const DoubleLanes inMesh = LanesTransform(meshFromWorld).largestVector(magnitude + offset);
    return worldFromMesh.largestVector(inMesh) + offset;
}

}  // namespace

SurfacePoint::SurfacePoint(const Mesh& mesh, const Instance& instance, const RayHit& hit) {
    const auto& index = mesh.triangles[hit.triangle];
    const bool isInWorldSpace = instance.isInWorldSpace;
    const auto cornerAt = [&](std::size_t i) {
        return toDouble(loadLanes(mesh.positions[index[i]]));
    };
    DoubleLanes corner0 = cornerAt(0), corner1 = cornerAt(1), corner2 = cornerAt(2);
    if (!isInWorldSpace) {
        const LanesTransform worldFromMesh(instance.worldFromMesh);
        corner0 = worldFromMesh.point(corner0);
        corner1 = worldFromMesh.point(corner1);
        corner2 = worldFromMesh.point(corner2);
    }
    const double b1 = hit.b1, b2 = hit.b2, b0 = 1.0 - b1 - b2;
    const auto b0Float = static_cast<float>(b0);
    const DoubleLanes place = corner0 * b0 + corner1 * b1 + corner2 * b2;
    DoubleLanes normal = cross(corner1 - corner0, corner2 - corner0);
    DoubleLanes magnitude = max(max(abs(place), abs(corner0)), max(abs(corner1), abs(corner2)));
    if (!isInWorldSpace) {
        const LanesTransform worldFromMesh(instance.worldFromMesh);
        // A mirror turns the winding around; the front side stays the front side.
        if (worldFromMesh.isMirroring()) normal = -normal;
        magnitude = magnitudeInInstance(magnitude, worldFromMesh, instance.meshFromWorld);
    }
    position = vecOf(toFloat(place));
    positionError = positionErrorOf(magnitude);
    geometricNormal = vecOf(toFloat(normalize(normal)));
    Vec3 shadingNormal = geometricNormal;
    if (!mesh.normals.empty()) {
        Vec3 n = vecOf(loadLanes(mesh.normals[index[0]]) * b0Float +
                       loadLanes(mesh.normals[index[1]]) * hit.b1 +
                       loadLanes(mesh.normals[index[2]]) * hit.b2);
        // An instance may scale by any factor: unit in double before it is a float again.
        if (!isInWorldSpace && lengthSquared(n) > 0.0f)
            n = vecOf(toFloat(
                normalize(LanesTransform(instance.worldFromMesh).normal(toDouble(lanesOf(n))))));
        // Opposite vertex normals may cancel; then the plane's own normal is the only one left.
        if (lengthSquared(n) > 0.0f)
            shadingNormal = normalize(dot(n, geometricNormal) < 0 ? -n : n);
    }
    shading = Frame::fromZ(shadingNormal);
    if (!mesh.textureCoordinates.empty())
        uv = mesh.textureCoordinates[index[0]] * b0Float +
             mesh.textureCoordinates[index[1]] * hit.b1 +
             mesh.textureCoordinates[index[2]] * hit.b2;
    material = instance.materials[mesh.materialOfTriangle[hit.triangle]];
    if (!instance.lightOfTriangle.empty()) light = instance.lightOfTriangle[hit.triangle];
}

}  // namespace etendue
