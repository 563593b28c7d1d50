#include "renderer/surface_point.h"

#include "renderer/intersector.h"

namespace etendue {

namespace {

Vec3d absVector(const Transform& t, Vec3d v) {
    return abs(t.x) * std::abs(v.x) + abs(t.y) * std::abs(v.y) + abs(t.z) * std::abs(v.z);
}

/// What float rounding inside the intersector can move the triangle's plane by: it works on vertex
/// differences relative to the ray's origin, each rounded at the magnitude of the coordinates, and
/// a rounding in one axis tilts the plane into the others, so that the bound is the same for all;
/// in an instance the origin is also carried through the rounded inverse transform.
/// docs/precision.md.
Vec3 positionErrorOf(const std::array<Vec3d, 3>& corner, Vec3d position, const Instance& instance) {
    constexpr double roundings = 4.0;
    constexpr double epsilon = 0x1p-24;
    Vec3d magnitude = abs(position);
    for (const Vec3d& c : corner) magnitude = max(magnitude, abs(c));
    if (!instance.isInWorldSpace) {
        const Transform& t = instance.worldFromMesh;
        magnitude =
            absVector(t, absVector(instance.meshFromWorld, magnitude + abs(t.translation))) +
            abs(t.translation);
    }
    const auto error = static_cast<float>(maxComponent(magnitude) * roundings * epsilon);
    return {error, error, error};
}

}  // namespace

SurfacePoint::SurfacePoint(const Mesh& mesh, const Instance& instance, const RayHit& hit) {
    const auto& index = mesh.triangles[hit.triangle];
    const bool isInWorldSpace = instance.isInWorldSpace;
    const Transform& t = instance.worldFromMesh;
    std::array<Vec3d, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) {
        corner[i] = toDouble(mesh.positions[index[i]]);
        if (!isInWorldSpace) corner[i] = t.point(corner[i]);
    }
    const double b1 = hit.b1, b2 = hit.b2, b0 = 1.0 - b1 - b2;
    const Vec3d place = corner[0] * b0 + corner[1] * b1 + corner[2] * b2;
    Vec3d normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    // A mirror turns the winding around; the front side stays the front side.
    const bool isMirrored = !isInWorldSpace && t.determinant() < 0.0;
    if (isMirrored) normal = -normal;

    position = toFloat(place);
    positionError = positionErrorOf(corner, place, instance);
    geometricNormal = toFloat(normalize(normal));
    Vec3 shadingNormal = geometricNormal;
    if (!mesh.normals.empty()) {
        Vec3 n = mesh.normals[index[0]] * static_cast<float>(b0) + mesh.normals[index[1]] * hit.b1 +
                 mesh.normals[index[2]] * hit.b2;
        // An instance may scale by any factor: unit in double before it is a float again.
        if (!isInWorldSpace && lengthSquared(n) > 0.0f)
            n = toFloat(normalize(t.normal(toDouble(n))));
        // Opposite vertex normals may cancel; then the plane's own normal is the only one left.
        if (lengthSquared(n) > 0.0f)
            shadingNormal = normalize(dot(n, geometricNormal) < 0 ? -n : n);
    }
    shading = Frame::fromZ(shadingNormal);
    if (!mesh.textureCoordinates.empty())
        uv = mesh.textureCoordinates[index[0]] * static_cast<float>(b0) +
             mesh.textureCoordinates[index[1]] * hit.b1 +
             mesh.textureCoordinates[index[2]] * hit.b2;
    material = instance.materials[mesh.materialOfTriangle[hit.triangle]];
    if (!instance.lightOfTriangle.empty()) light = instance.lightOfTriangle[hit.triangle];
}

}  // namespace etendue
